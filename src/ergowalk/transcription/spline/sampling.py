"""From the data of all splines to the walker at many instants, as one mapped function per phase."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.rhythm import Phase
from ergowalk.problem import DoubleSupport, GaitProblem
from ergowalk.transcription.spline.closure import settle_all
from ergowalk.transcription.spline.curves import Curves
from ergowalk.transcription.spline.jets import Jet
from ergowalk.transcription.spline.semi_inverse import SHARED, Instant

Array = NDArray[np.float64]
Outputs = Callable[[Instant], Sequence[Any]]
"""What is wanted of an instant."""

NEGLIGIBLE = 1e-14
"""Share of the largest entry of a row below which an entry is rounding."""


@dataclass(frozen=True)
class Grid:
    """Instants of one phase [s], with quadrature weights [s]."""

    phase: Phase
    times: Array
    weights: Array


class Sampler:
    """The walker of a problem on given splines, at whatever instants are asked for."""

    def __init__(self, problem: GaitProblem, curves: Curves) -> None:
        self.problem, self.curves = problem, curves
        toe_off = curves.times["other_toe_off"]
        self.instants = tuple(Instant(problem, phase, toe_off) for phase in curves.phases)

    def intervals(self) -> list[tuple[Phase, Array]]:
        """Each phase with its knots [s]."""
        times, grid = self.curves.times, self.curves.grid
        found = []
        for phase in self.curves.phases:
            a, b = times[phase.start], times[phase.end]
            found.append((phase, grid[(grid >= a) & (grid <= b)]))
        return found

    def gauss(self, points: int) -> tuple[Grid, ...]:
        """Composite Gauss quadrature: ``points`` instants in each knot interval."""
        node, weight = np.polynomial.legendre.leggauss(points)
        found = []
        for phase, knots in self.intervals():
            h = np.diff(knots)[:, None]
            times = (knots[:-1, None] + h * (node + 1) / 2).ravel()
            found.append(Grid(phase, times, (h * weight / 2).ravel()))
        return tuple(found)

    def mapped(
        self, instant: Instant, grid: Grid, outputs: Outputs, data: ca.MX, shared: ca.MX
    ) -> ca.MX:
        """What is wanted at all instants of a grid: (n_out, len(times))."""
        expression = ca.cse(ca.vertcat(*(ca.SX(e) for e in outputs(instant))))
        inputs = [instant.variables, instant.known, instant.shared]
        function = ca.Function("instant", inputs, [expression])
        n = len(grid.times)
        matrix, offset = self.locals(instant, grid.times)
        values = ca.reshape(ca.sparsify(ca.DM(matrix)) @ data + offset, -1, n)
        found: ca.MX = function.map(n)(values, self.known(grid.times), ca.repmat(shared, 1, n))
        return found

    def locals(self, instant: Instant, times: Array) -> tuple[Array, Array]:
        """Matrix (n_v len(times), data) and offset that give :attr:`Instant.variables`."""
        rows, offset = [], []
        for f in instant.functions:
            later = times + f.half_strides_later * self.curves.half
            for d in range(3):
                rows.append(self.curves.rows(f.name, later, d))
                offset.append(self.curves.offset(f.name, later, d))
        matrix = np.stack(rows, axis=1).reshape(-1, self.curves.size)
        return without_rounding(matrix), np.stack(offset, axis=1).ravel()

    def known(self, times: Array) -> Array:
        """What :attr:`Instant.known` needs at these instants (17, n)."""
        stride, toe_off = self.problem.stride_time_s, self.curves.times["other_toe_off"]
        corridors = self.problem.angle_corridors()
        bounds = [
            getattr(corridor, side)(times / stride + shift)
            for side in ("lower", "upper")
            for shift in (0.0, 0.5)
            for corridor in corridors.values()
        ]
        mean = corridors["ankle"].mean
        human = [mean(times / stride + 0.5, d) / stride**d for d in range(3)]
        flat = self.curves.times["heel_end"]
        since_flat = (toe_off - times) / (toe_off - flat) if toe_off > flat else 0 * times
        return np.stack([*bounds, *human, 1 - times / toe_off, since_flat])

    def shared(self, data: ca.MX) -> ca.MX:
        """:data:`~.semi_inverse.SHARED` from all data: what double support starts from (12); zero
        what this problem has no use for."""
        phases, times = self.curves.phases, self.curves.times

        def carried(i: int, name: str, given: ca.MX) -> ca.MX:
            grid = Grid(phases[i], np.array([times[name]]), np.zeros(1))
            return self.mapped(self.instants[i], grid, lambda at: at.carried, data, given)

        start = carried(-1, "half_stride", ca.MX.zeros(len(SHARED)))
        linear = self.problem.double_support is DoubleSupport.LINEAR
        pressure = start[1] if linear else ca.MX(0)
        given = ca.vertcat(start[0], pressure, 0.0)
        if not phases[1].double_support:
            return given
        return ca.vertcat(start[0], pressure, carried(0, "heel_end", given)[2])

    @cached_property
    def shared_values(self) -> ca.Function:
        """All data -> :data:`~.semi_inverse.SHARED`."""
        data = ca.MX.sym("z", self.curves.size)
        return ca.Function("shared", [data], [self.shared(data)])

    def settled(self, unknowns: ca.SX, places: NDArray[np.intp], start: Array) -> ca.Function:
        """C -> all data, what was missing at heel contact and toe-off [m]."""
        data: list[Any] = list(start)
        for i, place in enumerate(places):
            data[place] = start[place] + unknowns[i]
        missing = settle_all(self.problem, self.curves, _Settling(self.curves, data))
        return ca.Function("data", [unknowns], ca.cse([ca.vertcat(*data), ca.SX(missing)]))

    def settlements(self) -> tuple[ca.SX, list[tuple[int, Any]]]:
        """All data as symbols; places of the dependent ones with expressions that must vanish."""
        symbols = ca.SX.sym("z", self.curves.size)
        ledger = _Recording(self.curves, symbols)
        settle_all(self.problem, self.curves, ledger)
        return symbols, ledger.found


class _Settling:
    """A ledger that fills in the data as they are determined."""

    def __init__(self, curves: Curves, data: Any) -> None:
        self.curves, self.data = curves, data

    @property
    def psi(self) -> Any:
        return self.data[self.curves.psi]

    def at(self, name: str, time: float) -> Jet:
        parts = []
        for d in range(2):
            row = without_rounding(self.curves.rows(name, [time], d))[0]
            value = float(self.curves.offset(name, [time], d)[0])
            parts.append(value + sum(row[i] * self.data[int(i)] for i in np.flatnonzero(row)))
        return Jet(*parts)

    def settle(self, name: str, datum: int, value: Any) -> None:
        self.data[self.curves.place(name, datum)] = value


class _Recording(_Settling):
    """A ledger whose data stay symbols: what the constraints settle becomes a row."""

    def __init__(self, curves: Curves, data: ca.SX) -> None:
        super().__init__(curves, data)
        self.found: list[tuple[int, Any]] = []

    def settle(self, name: str, datum: int, value: Any) -> None:
        place = self.curves.place(name, datum)
        self.found.append((place, self.data[place] - value))


def split(knots: Array, longest: float, least: int) -> list[Array]:
    """Equally spaced instants of each knot interval, both ends included."""
    return [
        np.linspace(a, b, max(least, int(np.ceil((b - a) / longest)) + 1))
        for a, b in pairwise(knots)
    ]


def without_rounding(matrix: Array) -> Array:
    """The matrix with entries that are rounding set to zero."""
    largest = np.abs(matrix).max(axis=1, keepdims=True)
    return np.where(np.abs(matrix) < NEGLIGIBLE * largest, 0.0, matrix)
