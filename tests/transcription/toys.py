"""Small phased problems that know nothing of walking, with known answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.solvers.ipopt import Ipopt, Minimum
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Samples, Trajectory
from ergowalk.transcription.phases import (
    Coordinate,
    Instant,
    InstantFunction,
    Join,
    Link,
    PhasedProblem,
    PhaseModel,
    Terms,
    Unknown,
)

Array = NDArray[np.float64]

TIGHT = Ipopt(tolerance=1e-11, constraint_tolerance=1e-12)


def nothing(_: Instant) -> Terms:
    """No terms."""
    return Terms()


def phase(
    name: str,
    inside: InstantFunction,
    *,
    coordinates: Sequence[Coordinate | str] = ("x",),
    controls: Sequence[Unknown | str] = (),
    algebraics: Sequence[Unknown] = (),
    start: str = "start",
    end: str = "end",
    path: InstantFunction = nothing,
    at_ends: InstantFunction = nothing,
    path_everywhere: bool = False,
    absolute_scale: float = 1.0,
) -> PhaseModel:
    """A phase; names stand for coordinates and controls without bounds."""
    return PhaseModel(
        name,
        start,
        end,
        tuple(c if isinstance(c, Coordinate) else Coordinate(c) for c in coordinates),
        tuple(u if isinstance(u, Unknown) else Unknown(u) for u in controls),
        tuple(algebraics),
        absolute_scale,
        inside,
        path,
        at_ends,
        path_everywhere=path_everywhere,
    )


def chain(
    *phases: PhaseModel,
    times: Mapping[str, tuple[float, float]],
    fixed: Mapping[tuple[str, str, str], float] | None = None,
    exchange: Mapping[str, str] | None = None,
    links: Sequence[Link] = (),
    rates: Mapping[str, float] | None = None,
    rate_cost: Mapping[str, float] | None = None,
    time_rows: Sequence[tuple[str, Mapping[str, float], float, float]] = (),
) -> PhasedProblem:
    """A phased problem with nothing but what is given."""
    given = {"control_rates": rates or {}, "control_rate_cost": rate_cost or {}}
    return PhasedProblem(
        tuple(replace(phase, **given) for phase in phases),
        times,
        tuple(time_rows),
        (Join(phases[-1].end, phases[0].start, exchange or {}),),
        fixed or {},
        tuple(links),
    )


def at_rest(edge: str, place: float, name: str = "x") -> dict[tuple[str, str, str], float]:
    """A coordinate at rest somewhere at a boundary."""
    return {(edge, name, "value"): place, (edge, name, "rate"): 0.0}


@dataclass(frozen=True)
class Answer:
    """A toy solved on a mesh."""

    collocation: Collocation
    minimum: Minimum
    curves: Trajectory


def solved(
    problem: PhasedProblem,
    elements: int | Sequence[int],
    m: int,
    times: Mapping[str, float] | None = None,
    solver: Ipopt = TIGHT,
) -> Answer:
    """The answer on equal elements, from zero curves and the middle of the bounds of time."""
    counts = [elements] * len(problem.phases) if isinstance(elements, int) else elements
    mesh = tuple(np.linspace(0.0, 1.0, n + 1) for n in counts)
    collocation = Collocation(problem, mesh, m)
    start = {n: (low + high) / 2 for n, (low, high) in problem.times.items()} | dict(times or {})
    x = collocation.pack(still(problem), start)
    minimum = solver.minimise(collocation.programme, x)
    assert minimum.converged, minimum.message
    return Answer(collocation, minimum, collocation.unpack(minimum.x))


def still(problem: PhasedProblem) -> Any:
    """A guess in which everything is zero."""

    def guess(i: int, fractions: Array) -> Samples:
        zero = np.zeros_like(fractions)
        model = problem.phases[i]
        names = [[c.name for c in model.coordinates]] * 3
        names += [[u.name for u in model.controls], [z.name for z in model.algebraics]]
        return Samples(*(dict.fromkeys(kind, zero) for kind in names))

    return guess


def dense(curves: Trajectory, kind: str, name: str, i: int = 0, count: int = 7) -> Array:
    """A curve of phase i inside all its elements: (elements, count)."""
    piece, s = curves.phases[i], np.linspace(0.0, 1.0, count)
    return np.stack([getattr(piece.in_element(k, s), kind)[name] for k in range(piece.elements)])


def instants(curves: Trajectory, i: int = 0, count: int = 7) -> Array:
    """Instants of :func:`dense`."""
    piece, s = curves.phases[i], np.linspace(0.0, 1.0, count)
    width = np.diff(piece.fractions)[:, None]
    return np.asarray(piece.start + piece.duration * (piece.fractions[:-1, None] + width * s))
