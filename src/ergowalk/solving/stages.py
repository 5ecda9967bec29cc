"""The stages of a collocation solve: human mean curves, coarse mesh, free rhythm, fine mesh."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem import GaitProblem
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
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.layout import Mesh
from ergowalk.transcription.mesh import walking_mesh
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.phases import PhasedProblem
from ergowalk.transcription.residuals import Residuals, mesh_residuals
from ergowalk.transcription.walker import Smoothing, Walker
from ergowalk.transcription.walking import kinematic_problem, walking_problem

COARSE_POINTS, FINE_POINTS = 2, 3
"""Gauss points per element while searching, and for the reported gait."""

LARGE_ERROR = 5.0
"""Error of a mesh from which the solver starts further from the bounds."""


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
        """Elements of the half stride."""
        return self.collocation.elements

    @property
    def points(self) -> int:
        """Gauss points of each element."""
        return self.collocation.scheme.m


@dataclass(frozen=True)
class Start:
    """Where a stage begins: curves, and boundary instants [s]."""

    guess: Guess
    times: Mapping[str, float]

    @classmethod
    def at(cls, curves: Trajectory) -> Start:
        """At the end of another stage."""
        return cls(curves.as_guess(), curves.times)


class OrderSearch:
    """All stages for one phase order of one problem."""

    def __init__(
        self,
        problem: GaitProblem,
        order: PhaseOrder,
        smoothing: Smoothing,
        effort: Effort,
        report: Report | None,
        store: KernelStore | None = None,
    ) -> None:
        self.problem, self.order, self.effort, self.report = problem, order, effort, report
        began = time.process_time()
        self.walker = Walker(problem, smoothing)
        self.phased = walking_problem(problem, order, smoothing)
        self.store = KernelStore() if store is None else store
        effort.build_time += time.process_time() - began

    def fit(self) -> Trajectory:
        """The motion nearest to the human means that stands on the ground, rhythm as printed."""
        times = starting_times(self.problem, starting_rhythm(self.problem, self.order))
        phased = with_times(kinematic_problem(self.problem, self.order), times)
        start = Start(human_guess(self.walker, self.order, times), times)
        return self._run("fit to human means", phased, self._mesh(times, 0.4), 2, start).trajectory

    def fixed_rhythm(
        self, fit: Trajectory, level: float, perturbation: Perturbation | None = None
    ) -> StageResult:
        """First dynamics: from the fit, disturbed if asked for, rhythm held."""
        guess = loaded_guess(self.walker, self.order, fit)
        if perturbation is not None:
            guess = perturbation.curves(fit, guess, self.order, self.problem.stride_time_s)
        start = Start(guess, fit.times)
        phased, mesh = with_times(self.phased, fit.times), self._mesh(fit.times, level)
        solver = Ipopt(tolerance=1e-4)
        return self._run("rhythm held", phased, mesh, COARSE_POINTS, start, solver)

    def started(self, start: Start, level: float) -> StageResult:
        """First dynamics from the curves of a solved gait, switching times free at once."""
        solver = Ipopt(tolerance=1e-4, strategy="monotone", barrier_start=1e-3, push=1e-4)
        mesh = self._mesh(start.times, level)
        return self._run("from a gait", self.phased, mesh, FINE_POINTS, start, solver)

    def free_rhythm(
        self, held: StageResult, perturbation: Perturbation | None = None
    ) -> StageResult:
        """All switching times as free as the problem lets them be, parabolic moments."""
        start, solver = Start.at(held.trajectory), Ipopt(tolerance=1e-5)
        if perturbation is not None and not self.problem.rhythm.fixed:
            rhythm = starting_rhythm(self.problem, self.order)
            moved = perturbation.rhythm(self.problem, self.order, rhythm)
            start = Start(start.guess, starting_times(self.problem, moved))
        mesh = held.collocation.mesh
        stage = "parabolic moments" if self.problem.rhythm.fixed else "rhythm free"
        return self._run(stage, self.phased, mesh, FINE_POINTS, start, solver)

    def refined(self, start: StageResult, mesh: Mesh, error: float) -> StageResult:
        """The same gait on a mesh in which elements have been cut.

        The multipliers come along and the solver starts where it stopped, the nearer to the
        bounds the smaller the ``error`` of the mesh before was (as a multiple of what is allowed).
        """
        barrier = 1e-5 if error > LARGE_ERROR else 1e-6
        solver = Ipopt(tolerance=1e-6, strategy="monotone", barrier_start=barrier, push=1e-4)
        return self._run(
            "finer mesh", self.phased, mesh, start.points, Start.at(start.trajectory), solver, start
        )

    def remeshed(self, start: StageResult, level: float, points: int) -> StageResult:
        """The same gait on the graded mesh of a level."""
        solver = Ipopt(tolerance=1e-6, strategy="monotone", barrier_start=1e-3, push=1e-4)
        curves = start.trajectory
        mesh, stage = self._mesh(curves.times, level), f"mesh level {level:g}"
        return self._run(stage, self.phased, mesh, points, Start.at(curves), solver)

    def residuals(self, result: StageResult) -> Residuals:
        """What the mesh leaves undone between its nodes."""
        return mesh_residuals(self.walker, self.order, result.trajectory)

    def _mesh(self, times: Mapping[str, float], level: float) -> Mesh:
        return walking_mesh(self.order, times, self.problem.stride_time_s, level)

    def _run(
        self,
        stage: str,
        phased: PhasedProblem,
        mesh: Mesh,
        points: int,
        start: Start,
        solver: Ipopt | None = None,
        before: StageResult | None = None,
    ) -> StageResult:
        began = time.process_time()
        collocation = Collocation(phased, mesh, points, self.store)
        programme = collocation.programme
        x = collocation.pack(start.guess, start.times)
        _ = programme.oracle
        self.effort.build_time += time.process_time() - began
        multipliers = None
        if before is not None:
            last = before.minimum
            multipliers = collocation.carry_multipliers(
                before.collocation, last.variable_multipliers, last.row_multipliers
            )
        monitor = self._monitor(stage, collocation.elements)
        minimum = (solver or Ipopt()).minimise(programme, x, monitor, multipliers)
        self.effort.add(minimum)
        return StageResult(
            collocation, collocation.unpack(minimum.x), minimum, self._energy(minimum.objective)
        )

    def _energy(self, objective: float) -> float:
        energy: float = energy_per_metre(objective * self.walker.mass, self.problem.step_length_m)
        return energy

    def _monitor(self, stage: str, elements: int):  # type: ignore[no-untyped-def]
        if self.report is None:
            return None
        report, words = self.report, f"{self.order}, {stage}, {elements} elements"

        def monitor(iteration: int, objective: float, violation: float) -> None:
            elapsed = time.monotonic() - self.effort.began
            report(Progress(words, iteration, self._energy(objective), violation, elapsed))

        return monitor


def with_times(phased: PhasedProblem, times: Mapping[str, float]) -> PhasedProblem:
    """The same problem with all boundary instants fixed."""
    return replace(phased, times={name: (float(t), float(t)) for name, t in times.items()})
