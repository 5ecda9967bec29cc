"""The paper's nonlinear programme (18), (19): energy and measures of the spline data.

The unknowns C are added to initial values z-bar of the data (16); everything else follows in
closed form. Integrals are composite Gauss quadrature between all knots, exact derivatives are
taken through all of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ergowalk.errors import ProblemError
from ergowalk.gait.loads import Sharing
from ergowalk.gait.rhythm import Contact, Rhythm
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Point, Rotation
from ergowalk.problem import GaitProblem
from ergowalk.problem.objective import energy_per_metre
from ergowalk.transcription.spline.curves import Curves
from ergowalk.transcription.spline.sampling import Grid, Sampler, split
from ergowalk.transcription.spline.semi_inverse import MEASURES, Instant

Array = NDArray[np.float64]

GAUSS_POINTS = 4
"""Instants of each knot interval at which integrands are sampled, unless more are asked for."""

LEAST_SPAN = 0.05
"""Least distance [m] between the resting heel and the resting toe tip in double support: the
load is shared by the moment about one of them."""

TOLERANCES = (1e-4, 2e-3, 2e-3, 2e-3, 1e-4, 0.5, 2e-3)
"""When a measure of :data:`MEASURES` counts as zero, divided by T [m, rad, N].

The mean over the stride of both legs together: 0.1 mm of impossible geometry and of feet below
the ground and 0.1 degrees outside a corridor, the audit's tolerances at the worst instant; 0.5 N
of pull, under a thousandth of the body's weight; and 2 mm of the centre of pressure.
"""


@dataclass(frozen=True)
class MotionPiece:
    """A smooth piece of the half stride: instants [s], contacts, motion, sharing of the load.

    Arrays (n,), both ends included; the fields of ``ergowalk.solution.stride.Piece``.
    """

    time: Array
    contacts: tuple[Contact, Contact]
    motion: BodyMotion
    sharing: Sharing


class SplineProgramme:
    """Energy E (10) and measures G of (19) as functions of the unknowns C of (18).

    Parameters
    ----------
    problem : GaitProblem
    rhythm : Rhythm
        Held.
    intervals : int
        Knot intervals of the half stride; phase changes are knots.
    rho : float
        Freedom of the knots in (13) [s^3]: the misfit's weight is 1 / rho. With h between knots,
        rho / h^3 is a pure number; at 0.01 the curve takes half of a zigzag of the data. For any
        rho the data reach the same curves, so rho changes the way to the optimum and not the
        optimum.
    extras : sequence of str
        Data that (18) holds and that are to be unknowns as well, of
        :data:`~ergowalk.transcription.spline.curves.EXTRAS`.
    start : (data,) array, optional
        z-bar: initial values of all data, as :attr:`start` of another programme on the same
        knots; dependent ones are ignored. Without it they are fitted to the human means.
    samples : int
        Gauss points of each knot interval.

    Raises
    ------
    ProblemError
        If there are too few knots, or in double support heel and toe tip rest in one place.
    """

    def __init__(
        self,
        problem: GaitProblem,
        rhythm: Rhythm,
        intervals: int = 12,
        rho: float = 1e-6,
        extras: Sequence[str] = (),
        start: Array | None = None,
        samples: int = GAUSS_POINTS,
    ) -> None:
        _check_span(problem)
        self.problem, self.rhythm, self.rho, self.samples = problem, rhythm, rho, samples
        self.curves = Curves(problem, rhythm, intervals, rho)
        self.sampler = Sampler(problem, self.curves)
        self.extras = tuple(extras)
        unknowns = self.curves.unknowns(self.extras)
        self.names, self.places = tuple(unknowns), np.array(list(unknowns.values()))
        if start is None:
            from ergowalk.transcription.spline.start import fitted

            start = fitted(self)
        self.start: Array = np.asarray(start, dtype=float)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(self.names)

    # --- values ---------------------------------------------------------------------------

    def initial(self) -> Array:
        """C = 0: a motion near the human means that the geometry allows."""
        return np.zeros(self.size)

    def value(self, unknowns: ArrayLike) -> tuple[float, Array]:
        """E of (10) [J/m] and the measures G_0 ... G_6 (7,), see :data:`MEASURES`."""
        out = self._values(np.asarray(unknowns, dtype=float)).full().ravel()
        return float(out[0]), out[1:]

    def penalised(self, unknowns: ArrayLike, weights: ArrayLike) -> tuple[float, Array]:
        """Q_1 = E + sum of weights (7,) times G of (19), and its gradient."""
        value, gradient = self._gradient(np.asarray(unknowns, float), np.asarray(weights, float))
        return float(value), gradient.full().ravel()

    def jacobian(self, unknowns: ArrayLike) -> Array:
        """Derivatives of E, G_0 ... G_6: (8, size)."""
        return np.asarray(self._jacobian(np.asarray(unknowns, dtype=float)).full())

    def tolerances(self) -> Array:
        """When each measure counts as zero (7,), see :data:`TOLERANCES`."""
        return np.array(TOLERANCES) * self.problem.stride_time_s

    def data(self, unknowns: ArrayLike) -> Array:
        """All data z of all splines, the dependent ones included."""
        return np.asarray(self.settled(np.asarray(unknowns, dtype=float))[0].full().ravel())

    def unknowns_of(self, data: ArrayLike) -> Array:
        """C for given data: the inverse of :meth:`data`."""
        return np.asarray(np.asarray(data, dtype=float)[self.places] - self.start[self.places])

    def on_knots(
        self, unknowns: ArrayLike, intervals: int, extras: Sequence[str] | None = None
    ) -> SplineProgramme:
        """The programme on other knots, z-bar being nearly the same walk."""
        from ergowalk.transcription.spline.start import carried_over

        kept = self.extras if extras is None else extras
        fine = Curves(self.problem, self.rhythm, intervals, self.rho)
        start = carried_over(self.data(unknowns), self.curves, fine)
        return SplineProgramme(
            self.problem, self.rhythm, intervals, self.rho, kept, start, self.samples
        )

    def with_samples(self, samples: int) -> SplineProgramme:
        """The same functions of the same unknowns from another number of samples."""
        intervals = len(self.curves.grid) - 1
        return SplineProgramme(
            self.problem, self.rhythm, intervals, self.rho, self.extras, self.start, samples
        )

    def pieces(self, unknowns: ArrayLike, longest: float | None = None) -> list[MotionPiece]:
        """The half stride on a dense grid, a piece for each knot interval.

        ``longest`` [s] is the longest step, by default T/800; nine instants or more a piece.
        """
        longest = self.problem.stride_time_s / 800 if longest is None else longest
        parts = [split(knots, longest, 9) for _, knots in self.sampler.intervals()]
        grids = [
            Grid(phase, np.concatenate(p), np.zeros(sum(map(len, p))))
            for phase, p in zip(self.curves.phases, parts, strict=True)
        ]
        symbol = ca.MX.sym("C", self.size)
        data, _ = self.settled(symbol)
        shared = self.sampler.shared(data)
        found = [
            self.sampler.mapped(instant, grid, lambda at: at.state, data, shared)
            for instant, grid in zip(self.sampler.instants, grids, strict=True)
        ]
        states = ca.Function("states", [symbol], found)(np.asarray(unknowns, dtype=float))
        return [
            _piece(grid, slice(a, b), state.full())
            for grid, p, state in zip(grids, parts, states, strict=True)
            for a, b in pairwise(np.cumsum([0, *map(len, p)]))
        ]

    # --- CasADi functions -----------------------------------------------------------------

    @cached_property
    def settled(self) -> ca.Function:
        """C -> all data, what was missing at heel contact and toe-off [m]."""
        return self.sampler.settled(ca.SX.sym("C", self.size), self.places, self.start)

    @cached_property
    def _values(self) -> ca.Function:
        unknowns = ca.MX.sym("C", self.size)
        return ca.Function("values", [unknowns], [self._total(unknowns)])

    @cached_property
    def _gradient(self) -> ca.Function:
        unknowns, weights = ca.MX.sym("C", self.size), ca.MX.sym("w", len(MEASURES))
        penalised = ca.dot(ca.vertcat(1.0, weights), self._total(unknowns))
        outputs = [penalised, ca.gradient(penalised, unknowns)]
        return ca.Function("gradient", [unknowns, weights], outputs)

    @cached_property
    def _jacobian(self) -> ca.Function:
        unknowns = ca.MX.sym("C", self.size)
        return ca.Function("jacobian", [unknowns], [ca.jacobian(self._total(unknowns), unknowns)])

    def _total(self, unknowns: ca.MX) -> ca.MX:
        """E and G in one column."""
        data, missing = self.settled(unknowns)
        shared = self.sampler.shared(data)
        total: ca.MX = ca.MX.zeros(1 + len(MEASURES))
        grids = self.sampler.gauss(self.samples)
        for instant, grid in zip(self.sampler.instants, grids, strict=True):
            samples = self.sampler.mapped(instant, grid, _integrands, data, shared)
            total = total + samples @ ca.DM(grid.weights)
        energy = energy_per_metre(total[0], self.problem.step_length_m)
        there = missing * self.problem.stride_time_s
        return ca.vertcat(energy, 2 * total[1] + there, 2 * total[2:])


def _integrands(instant: Instant) -> list[ca.SX]:
    return [sum(ca.fabs(power) for power in instant.powers), *instant.measures]


def _piece(grid: Grid, part: slice, state: Array) -> MotionPiece:
    """The inverse of :attr:`~.semi_inverse.Instant.state`."""
    s = state[:, part]
    x = s[:33].reshape(3, 11, -1)
    turns = [Rotation(*x[:, j]) for j in range(2, 11)]
    hip = Point((x[0, 0], x[0, 1]), (x[1, 0], x[1, 1]), (x[2, 0], x[2, 1]))
    motion = BodyMotion(hip, turns[0], (LegMotion(*turns[1:5]), LegMotion(*turns[5:9])))
    return MotionPiece(grid.times[part], grid.phase.legs, motion, Sharing(*s[33:]))


def _check_span(problem: GaitProblem) -> None:
    leg = problem.body.leg(0)
    span = problem.step_length_m - leg.heel_to_metatarsal - leg.toe_length
    if abs(span) < LEAST_SPAN:
        raise ProblemError(
            f"puts the heel of one foot within {LEAST_SPAN} m of the other's toe tip, so double "
            "support cannot share the load",
            "change the step length or the foot",
            field="step_length_m",
            value=problem.step_length_m,
        )
