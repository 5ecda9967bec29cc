"""The stages of a collocation solve: human mean curves, coarse mesh, free rhythm, fine mesh."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem import GaitProblem
from ergowalk.problem.design import free_values
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution.progress import Progress, Report
from ergowalk.solvers.ipopt import Ipopt, Minimum
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Guess, Trajectory
from ergowalk.transcription.guess import (
    human_guess,
    loaded_guess,
    starting_rhythm,
    starting_times,
)
from ergowalk.transcription.halves import Orders, halves_of, mesh_of, times_twice
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.layout import Mesh
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.phases import PhasedProblem
from ergowalk.transcription.residuals import Residuals, mesh_residuals
from ergowalk.transcription.steps import STEP_1
from ergowalk.transcription.walker import Smoothing
from ergowalk.transcription.walking import kinematic_problem, walking_problem

POINTS = 3
"""Gauss points per element."""

SEARCH, COARSE = 0.2, 0.42
"""Mesh levels: while phase orders are compared, and of the mesh that is cut from then on."""

IMPULSIVE = 0.3
"""Mesh level of the first mesh of a problem without minimiser."""

SEARCH_BARRIER = 1e-4
"""Barrier at which the search changes stages: well below it the next one would only start on its
bounds, far above it the curves are not yet those of a gait."""

LARGE_ERROR = 5.0
"""Error of a mesh from which the solver starts further from the bounds."""


def orders_in_words(orders: Orders) -> str:
    """One order, or that of both halves."""
    return " and ".join(str(order) for order in orders)


@dataclass
class Effort:
    """What the stages have cost so far: iterations, CPU seconds of building and of solving."""

    iterations: int = 0
    build_time: float = 0.0
    solve_time: float = 0.0
    began: float = field(default_factory=time.monotonic)

    def add(self, minimum: Minimum) -> None:
        """Count one run of the solver."""
        self.iterations += minimum.iterations
        self.build_time += minimum.build_time
        self.solve_time += minimum.solve_time


@dataclass(frozen=True)
class StageResult:
    """The curves at the end of a stage."""

    collocation: Collocation
    trajectory: Trajectory
    minimum: Minimum
    energy_at_nodes: float

    @property
    def elements(self) -> int:
        """Elements of the halves that are solved."""
        return self.collocation.elements

    @property
    def points(self) -> int:
        """Gauss points of each element."""
        return self.collocation.scheme.m


@dataclass(frozen=True)
class Start:
    """Where a stage begins: curves, boundary instants [s], unknowns of no instant."""

    guess: Guess
    times: Mapping[str, float]
    shared: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def at(cls, curves: Trajectory, guess: Guess | None = None) -> Start:
        """At the end of another stage, or at curves that were made of it."""
        return cls(guess or curves.as_guess(), curves.times, curves.shared)

    @classmethod
    def twice(cls, curves: Trajectory, problem: GaitProblem) -> Start:
        """At a gait of legs that mirror each other, for both halves of a stride."""
        half, count = curves.as_guess(), len(curves.phases)
        times = times_twice(curves.times)
        return cls(lambda i, s: half(i % count, s), times, {STEP_1: problem.step_length_m})


class OrderSearch:
    """All stages for one phase order of one problem, or one order for each half of its stride."""

    def __init__(
        self,
        problem: GaitProblem,
        orders: Orders,
        smoothing: Smoothing,
        effort: Effort,
        report: Report | None,
        store: KernelStore | None = None,
    ) -> None:
        self.problem, self.orders, self.effort, self.report = problem, orders, effort, report
        began = time.process_time()
        self.halves = halves_of(problem, orders, smoothing)
        self.walker = self.halves[0].walker
        self.phased = walking_problem(problem, orders, smoothing)
        self.store = KernelStore() if store is None else store
        effort.build_time += time.process_time() - began

    @property
    def order(self) -> PhaseOrder:
        """Order of the phases of the first half."""
        return self.orders[0]

    @property
    def name(self) -> str:
        """The orders in words."""
        return orders_in_words(self.orders)

    @property
    def distance(self) -> float:
        """How far the halves that are solved lead [m]."""
        return len(self.halves) * self.problem.step_length_m

    def fit(self) -> Trajectory:
        """The motion nearest to the human means that stands on the ground, rhythm as printed."""
        times = starting_times(self.problem, starting_rhythm(self.problem, self.order))
        phased = with_times(self._held(kinematic_problem(self.problem, self.order)), times)
        start = Start(human_guess(self.walker, self.order, times), times)
        mesh = self._mesh(times, COARSE)
        return self._run("fit to human means", phased, mesh, start, points=2).trajectory

    def fixed_rhythm(
        self, fit: Trajectory, perturbation: Perturbation | None = None
    ) -> StageResult:
        """First dynamics: from the fit, disturbed if asked for, rhythm held.

        It ends with the barrier at :data:`SEARCH_BARRIER`: a gait, not yet the cheapest.
        """
        guess = loaded_guess(self.walker, self.order, fit)
        if perturbation is not None:
            guess = perturbation.curves(fit, guess, self.order, self.problem.stride_time_s)
        start = Start(guess, fit.times)
        phased = with_times(self._held(self.phased), fit.times)
        mesh = self._mesh(fit.times, SEARCH)
        solver = Ipopt(tolerance=1e-3, barrier_end=SEARCH_BARRIER)
        return self._run("rhythm held", phased, mesh, start, solver)

    def started(self, start: Start) -> StageResult:
        """First dynamics from the curves of a solved gait, switching times free at once."""
        mesh = self._mesh(start.times, COARSE)
        return self._run("from a gait", self.phased, mesh, start, _warm(1e-4, 1e-3))

    def continued(self, before: StageResult, begin: Start, barrier: float) -> StageResult:
        """From the point and the multipliers of a neighbour's gait, on its mesh.

        ``before`` stands in the unknowns of this search; ``begin`` says what else is known, and
        ``barrier`` how far from the bounds it starts.
        """
        start = replace(begin, guess=before.trajectory.as_guess())
        solver = _warm(1e-6, barrier)
        return self._solve("from a gait", before.collocation, start, solver, before)

    def free_rhythm(
        self, held: StageResult, perturbation: Perturbation | None = None
    ) -> StageResult:
        """All switching times as free as the problem lets them be."""
        start, mesh = Start.at(held.trajectory), held.collocation.mesh
        if perturbation is not None:
            rhythm = starting_rhythm(self.problem, self.order)
            moved = perturbation.rhythm(self.problem, self.order, rhythm)
            start = Start(start.guess, starting_times(self.problem, moved))
        solver = _warm(1e-4, SEARCH_BARRIER)
        return self._run("rhythm free", self.phased, mesh, start, solver, held)

    def refined(self, start: StageResult, mesh: Mesh, error: float) -> StageResult:
        """The same gait on a mesh in which elements have been cut.

        The multipliers come along and the solver starts where it stopped, the nearer to the
        bounds the smaller the ``error`` of the mesh before was (as a multiple of what is allowed).
        """
        barrier = 1e-5 if error > LARGE_ERROR else 1e-6
        at = Start.at(start.trajectory)
        return self._run("finer mesh", self.phased, mesh, at, _warm(1e-6, barrier), start)

    def remeshed(self, start: StageResult, level: float) -> StageResult:
        """The same gait on the graded mesh of a level, multipliers carried."""
        curves, solver = start.trajectory, _warm(1e-5, SEARCH_BARRIER)
        mesh, stage = self._mesh(curves.times, level), f"mesh level {level:g}"
        return self._run(stage, self.phased, mesh, Start.at(curves), solver, start)

    def stage(
        self,
        words: str,
        mesh: Mesh,
        start: Start,
        solver: Ipopt | None = None,
        before: StageResult | None = None,
        *,
        held: bool = False,
    ) -> StageResult:
        """A stage of a search, called so in words, as far as the barrier of the search.

        What is free of the design stands where the search begins if ``held``.
        """
        solver = solver or _warm(1e-4, SEARCH_BARRIER)
        phased = self._held(self.phased) if held else self.phased
        return self._run(words, phased, mesh, start, solver, before)

    def impulsive(self, start: StageResult, mesh: Mesh | None = None) -> StageResult:
        """The gait of a problem without minimiser; by default on the graded mesh of the search.

        Two Gauss points and moments that are lines: the sharper a peak may be, the longer the
        search for it takes.
        """
        at = Start.at(start.trajectory)
        before: StageResult | None = start
        if mesh is None:  # after the search, whose elements have more Gauss points
            mesh, before = self._mesh(at.times, IMPULSIVE), None
        solver = _warm(1e-6, 1e-3)
        return self._run("impulsive", self.phased, mesh, at, solver, before, points=2)

    def solved(self, result: StageResult) -> GaitProblem:
        """The problem that the gait of a stage answers, free numbers at their best."""
        given = {**result.trajectory.times, **result.trajectory.shared}
        return self.walker.at(given).asked

    def residuals(self, result: StageResult) -> Residuals:
        """What the mesh leaves undone between its nodes."""
        return mesh_residuals(self.halves, result.trajectory)

    def _held(self, phased: PhasedProblem) -> PhasedProblem:
        """The same with the free numbers of the design where the problem has them."""
        values = free_values(self.problem)
        shared = (
            replace(x, lower=values[x.name], upper=values[x.name]) if x.name in values else x
            for x in phased.shared
        )
        return replace(phased, shared=tuple(shared))

    def _mesh(self, times: Mapping[str, float], level: float) -> Mesh:
        return mesh_of(self.halves, times, self.problem.stride_time_s, level)

    def _run(
        self,
        stage: str,
        phased: PhasedProblem,
        mesh: Mesh,
        start: Start,
        solver: Ipopt | None = None,
        before: StageResult | None = None,
        points: int = POINTS,
    ) -> StageResult:
        began = time.process_time()
        collocation = Collocation(phased, mesh, points, self.store)
        self.effort.build_time += time.process_time() - began
        return self._solve(stage, collocation, start, solver or Ipopt(), before)

    def _solve(
        self,
        stage: str,
        collocation: Collocation,
        start: Start,
        solver: Ipopt,
        before: StageResult | None,
    ) -> StageResult:
        began = time.process_time()
        programme = collocation.programme
        shared = {**free_values(self.problem), **start.shared}
        x = collocation.pack(start.guess, start.times, shared)
        _ = programme.oracle
        self.effort.build_time += time.process_time() - began
        multipliers = None
        if before is not None:
            last = before.minimum
            multipliers = collocation.carry_multipliers(
                before.collocation, last.variable_multipliers, last.row_multipliers
            )
        monitor = self._monitor(stage, collocation.elements)
        minimum = solver.minimise(programme, x, monitor, multipliers)
        self.effort.add(minimum)
        return StageResult(
            collocation, collocation.unpack(minimum.x), minimum, self._energy(minimum.objective)
        )

    def _energy(self, objective: float) -> float:
        work = objective * self.walker.reference_mass
        energy: float = energy_per_metre(work, self.distance)
        return energy

    def _monitor(self, stage: str, elements: int):  # type: ignore[no-untyped-def]
        if self.report is None:
            return None
        report, words = self.report, f"{self.name}, {stage}, {elements} elements"

        def monitor(iteration: int, objective: float, violation: float) -> None:
            elapsed = time.monotonic() - self.effort.began
            report(Progress(words, iteration, self._energy(objective), violation, elapsed))

        return monitor


def _warm(tolerance: float, barrier: float) -> Ipopt:
    """A solver that starts close to the solution and keeps its barrier falling from ``barrier``."""
    return Ipopt(tolerance=tolerance, strategy="monotone", barrier_start=barrier, push=1e-4)


def with_times(phased: PhasedProblem, times: Mapping[str, float]) -> PhasedProblem:
    """The same problem with all boundary instants fixed."""
    return replace(phased, times={name: (float(t), float(t)) for name, t in times.items()})
