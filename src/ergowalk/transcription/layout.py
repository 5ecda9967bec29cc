"""Where each unknown of a phased problem stands in the vector of the nonlinear programme."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ergowalk.transcription.phases import INF, PhasedProblem, PhaseModel

Array = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Mesh = tuple[Array, ...]
"""For each phase the element boundaries as fractions of the phase, from 0 to 1."""


@dataclass
class _Register:
    """Variables in the order in which they are made."""

    lower: list[float] = field(default_factory=list)
    upper: list[float] = field(default_factory=list)
    scale: list[float] = field(default_factory=list)

    def add(self, lower: float, upper: float, scale: float) -> int:
        self.lower.append(lower / scale)
        self.upper.append(upper / scale)
        self.scale.append(scale)
        return len(self.scale) - 1

    def tighten(self, index: int, lower: float, upper: float) -> None:
        scale = self.scale[index]
        self.lower[index] = max(self.lower[index], lower / scale)
        self.upper[index] = min(self.upper[index], upper / scale)


@dataclass(frozen=True)
class PhaseIndices:
    """Indices of one phase's unknowns.

    ``values``, ``rates`` (n_e + 1, n_q) and ``controls`` (n_e + 1, n_u) at mesh points;
    ``bulges`` (n_e, n_u): how far a control stands off its chord in the middle of an element;
    ``accelerations`` (n_e, m, n_q), ``algebraics`` (n_e, m, n_z), ``plus`` and ``minus``
    (n_e, m, n_abs) at Gauss points; ``times`` the two boundary instants; ``shared`` (n_s,) what
    belongs to no instant of the phase.
    """

    times: tuple[int, int]
    shared: IndexArray
    values: IndexArray
    rates: IndexArray
    controls: IndexArray
    bulges: IndexArray
    accelerations: IndexArray
    algebraics: IndexArray
    plus: IndexArray
    minus: IndexArray


@dataclass(frozen=True)
class Layout:
    """Indices, bounds and scales of all unknowns: physical value = scale * variable."""

    times: Mapping[str, int]
    shared: Mapping[str, int]
    phases: tuple[PhaseIndices, ...]
    boundary: Mapping[tuple[str, str, str], int]
    lower: Array
    upper: Array
    scale: Array

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.scale)


def lay_out(problem: PhasedProblem, mesh: Mesh, m: int, absolutes: tuple[int, ...]) -> Layout:
    """Give every unknown its place.

    Unknowns at a phase boundary belong to both phases, and those at joined boundaries are the
    same: continuity and periodicity need no equations. Variables of one element stand together,
    which keeps the factorisation banded.

    Parameters
    ----------
    absolutes
        Number of absolute values in each phase.
    """
    register = _Register()
    times = {name: register.add(low, high, 1.0) for name, (low, high) in problem.times.items()}
    shared = {x.name: register.add(x.lower, x.upper, x.scale) for x in problem.shared}
    common = shared | times
    boundary: dict[tuple[str, str, str], int] = {}
    phases, joined = [], _joined(problem)
    for phase, fractions, n_abs in zip(problem.phases, mesh, absolutes, strict=True):
        n_e = len(fractions) - 1
        points, gauss, bulges = [], [], []
        for k in range(n_e + 1):
            edge = phase.start if k == 0 else phase.end if k == n_e else None
            points.append(_point(register, joined, phase, edge, boundary))
            if k < n_e:
                # two Gauss points cannot hold a parabola: between them it would do as it likes
                room = INF if m > 2 else 0.0
                bulges.append([register.add(-room, room, u.scale) for u in phase.controls])
                gauss.append([_gauss_point(register, phase, n_abs) for _ in range(m)])
        values, rates, controls = (
            np.array([p[i] for p in points], dtype=np.int64) for i in range(3)
        )
        accelerations, algebraics, plus, minus = (
            np.array([[g[i] for g in row] for row in gauss], dtype=np.int64) for i in range(4)
        )
        phases.append(
            PhaseIndices(
                times=(times[phase.start], times[phase.end]),
                shared=np.array([common[x.name] for x in phase.shared], dtype=np.int64),
                values=values,
                rates=rates,
                controls=controls,
                bulges=np.array(bulges, dtype=np.int64).reshape(n_e, -1),
                accelerations=accelerations,
                algebraics=algebraics,
                plus=plus,
                minus=minus,
            )
        )
    for (edge, name, kind), number in problem.fixed.items():
        register.tighten(boundary[edge, name, kind], number, number)
    return Layout(
        times,
        shared,
        tuple(phases),
        boundary,
        np.array(register.lower),
        np.array(register.upper),
        np.array(register.scale),
    )


def _joined(problem: PhasedProblem) -> dict[tuple[str, str], tuple[str, str]]:
    """(boundary, name) -> the same unknown at the boundary that it is joined with."""
    found = {}
    for join in problem.joins:
        for at_end, at_start in join.names.items():
            found[join.end, at_end] = join.start, at_start
            found[join.start, at_start] = join.end, at_end
    return found


def _point(
    register: _Register,
    joined: Mapping[tuple[str, str], tuple[str, str]],
    phase: PhaseModel,
    edge: str | None,
    boundary: dict[tuple[str, str, str], int],
) -> tuple[list[int], list[int], list[int]]:
    def place(name: str, kind: str, lower: float, upper: float, scale: float) -> int:
        if edge is None:
            return register.add(lower, upper, scale)
        key = (edge, name, kind)
        if key not in boundary:
            same = (*joined.get((edge, name), ("", "")), kind)
            if same in boundary:
                boundary[key] = boundary[same]
            else:
                boundary[key] = register.add(-INF, INF, scale)
        register.tighten(boundary[key], lower, upper)
        return boundary[key]

    values = [place(c.name, "value", c.lower, c.upper, 1.0) for c in phase.coordinates]
    rates = [place(c.name, "rate", -INF, INF, c.rate_scale) for c in phase.coordinates]
    controls = [place(u.name, "control", u.lower, u.upper, u.scale) for u in phase.controls]
    return values, rates, controls


def _gauss_point(
    register: _Register, phase: PhaseModel, n_abs: int
) -> tuple[list[int], list[int], list[int], list[int]]:
    def free(scale: float) -> int:
        return register.add(-INF, INF, scale)

    return (
        [free(c.acceleration_scale) for c in phase.coordinates],
        [register.add(z.lower, z.upper, z.scale) for z in phase.algebraics],
        [register.add(0.0, INF, phase.absolute_scale) for _ in range(n_abs)],
        [register.add(0.0, INF, phase.absolute_scale) for _ in range(n_abs)],
    )
