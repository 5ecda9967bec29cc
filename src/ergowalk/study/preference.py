"""The walk a person would choose: at a given speed, the step length that costs least."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from ergowalk.errors import SweepError
from ergowalk.problem import GaitProblem
from ergowalk.solution import Solution
from ergowalk.solution.progress import Report

STEP, LONGEST_STEP = 0.03, 0.08
"""First and longest step of the search for a bracket, as parts of the step length."""

CLOSE_M = 0.002
"""The search is done this close to the minimum [m]: a bracket as narrow, or slopes that say so."""

MOST_GAITS = 15

HALVINGS = 3
"""How often a step is halved at whose end there is no acceptable gait."""

_INSIDE = 0.1
"""Part of a bracket at either end into which no trial falls: it must shrink."""


@dataclass(frozen=True)
class Criterion:
    """What a person is thought to minimise.

    Attributes
    ----------
    name : str
        With its unit.
    value : callable
        The criterion of a gait; the gait must be a minimiser of it.
    slope : callable
        Its derivative with respect to a number of the problem, named as in a problem file, at the
        gaits that minimise it.
    """

    name: str
    value: Callable[[Solution], float]
    slope: Callable[[Solution, str], float]


def _energy(gait: Solution) -> float:
    return gait.energy_per_metre


def _price(gait: Solution, name: str) -> float:
    from ergowalk.solving.prices import price_of

    return price_of(gait, name)


def _objective(gait: Solution) -> float:
    return gait.objective_per_metre


ENERGY = Criterion("E [J/m]", _energy, _price)
"""Energy per metre; its derivatives come from the multipliers of the gait."""

OBJECTIVE = Criterion("objective [J/m]", _objective, _price)
"""What the problem minimises, whatever that is; its derivatives come from the multipliers too."""


@dataclass(frozen=True)
class Trial:
    """A gait at the speed: its step length [m], its criterion, and how that changes per metre of
    step length at this speed."""

    step_length: float
    value: float
    slope: float
    gait: Solution = field(repr=False)


@dataclass(frozen=True)
class Preferred:
    """The preferred walk at a speed.

    Attributes
    ----------
    speed : float
        m/s.
    criterion : str
    gait : Solution
    bracket : (float, float)
        Step lengths [m] between which the minimum lies.
    found : bool
        Whether the search ended at a minimum, to within :data:`CLOSE_M`.
    status : str
        One sentence on how the search ended.
    trials : tuple of Trial
        All gaits in the order in which they were found.
    """

    speed: float
    criterion: str
    gait: Solution = field(repr=False)
    bracket: tuple[float, float]
    found: bool
    status: str
    trials: tuple[Trial, ...] = field(repr=False)

    @property
    def step_length(self) -> float:
        """Preferred step length [m]."""
        return self.gait.problem.step_length_m

    @property
    def stride_time(self) -> float:
        """Preferred stride time [s]."""
        return self.gait.problem.stride_time_s

    @property
    def cadence(self) -> float:
        """Preferred cadence [steps/min]."""
        return 120 / self.stride_time


Solve = Callable[[GaitProblem, Solution | None], Solution]


def preferred(
    problem: GaitProblem,
    speed: float,
    *,
    start: Solution | None = None,
    criterion: Criterion | None = None,
    solver: Solve | None = None,
    progress: Report | None = None,
) -> Preferred:
    """The step length that costs least at a walking speed, as a free number, not on a grid.

    At a speed v, T = 2 L / v and the slope of the criterion J along the step length is
    dJ/dL + (2/v) dJ/dT. Its root is bracketed by steps from the problem's own step length, or from
    that of ``start``, and then enclosed: each trial is the minimum of the cubic through values and
    slopes at both ends, kept away from the ends. Every gait is continued from the nearest one.

    Parameters
    ----------
    problem : GaitProblem
        Everything but step length and stride time is taken from it.
    speed : float
        m/s.
    start : Solution, optional
        A gait to begin with, of any speed.
    criterion : Criterion, optional
        What is minimised; by default :data:`ENERGY`, or :data:`OBJECTIVE` if the problem minimises
        something else. The gaits must minimise the same.
    solver : callable, optional
        Finds a gait of a problem from a start; :func:`ergowalk.solve` by default.
    progress : callable, optional
        Called once an iteration of the solver.

    Returns
    -------
    Preferred
        Also when no minimum is found: then ``found`` is False and ``status`` says why.

    Raises
    ------
    SweepError
        If the speed is not positive, or there is no acceptable gait to begin with.
    ProblemError
        If no body of the problem can step like that.
    """
    if not 0 < speed < math.inf:
        raise SweepError("must be positive", "give a speed in m/s", field="speed", value=speed)
    if criterion is None:
        criterion = ENERGY if problem.objective.is_eq10 else OBJECTIVE
    search = _Search(problem, speed, criterion, solver or _solver(progress))
    return search.run(start)


def _solver(progress: Report | None) -> Solve:
    from ergowalk.solving import solve

    def find(problem: GaitProblem, start: Solution | None) -> Solution:
        gait = solve(problem, start=start, progress=progress)
        if gait.acceptable or start is None:
            return gait
        return solve(problem, progress=progress)

    return find


class _Search:
    """One call of :func:`preferred`."""

    def __init__(
        self, problem: GaitProblem, speed: float, criterion: Criterion, solver: Solve
    ) -> None:
        self.problem, self.speed = problem, speed
        self.criterion, self.solver = criterion, solver
        self.trials: list[Trial] = []
        self.refused = 0

    def run(self, start: Solution | None) -> Preferred:
        given = start.problem if start is not None else self.problem
        first = self._try(given.step_length_m, start)
        if first is None:
            raise SweepError(
                "there is no acceptable gait to begin with at this speed",
                "begin with a gait of a similar speed (start)",
                field="step_length_m",
                value=given.step_length_m,
            )
        bracket = self._bracket(first)
        if bracket is None:
            return self._answer(False, "no acceptable gait where the cost still falls")
        return self._enclose(*bracket)

    def _try(self, length: float, start: Solution | None = None) -> Trial | None:
        """The gait of a step length; None if it is not acceptable."""
        time = 2 * length / self.speed
        problem = self.problem.replace(step_length_m=length, stride_time_s=time)
        if start is None and self.trials:
            start = min(self.trials, key=lambda t: abs(t.step_length - length)).gait
        gait = self.solver(problem, start)
        if not gait.acceptable:
            self.refused += 1
            return None
        by_length = self.criterion.slope(gait, "step_length_m")
        by_time = self.criterion.slope(gait, "stride_time_s")
        slope = by_length + 2 / self.speed * by_time
        self.trials.append(Trial(length, self.criterion.value(gait), slope, gait))
        return self.trials[-1]

    def _bracket(self, first: Trial) -> tuple[Trial, Trial] | None:
        """Two trials between which the slope changes its sign from falling to rising."""
        here, step, halved = first, STEP * first.step_length, 0
        while len(self.trials) + self.refused < MOST_GAITS:
            downhill = -math.copysign(1.0, here.slope)
            there = self._try(here.step_length + downhill * step)
            if there is None:
                if halved == HALVINGS:
                    return None
                step, halved = step / 2, halved + 1
                continue
            if there.slope * here.slope <= 0:
                return (here, there) if downhill > 0 else (there, here)
            step = min(self._secant(here, there), LONGEST_STEP * there.step_length)
            here = there
        return None

    def _secant(self, here: Trial, there: Trial) -> float:
        """A step a little beyond where the slope seems to vanish."""
        way, change = abs(there.step_length - here.step_length), there.slope - here.slope
        if abs(there.slope) < abs(here.slope):
            return 1.3 * way * abs(there.slope / change)
        return 2 * way

    def _enclose(self, low: Trial, high: Trial) -> Preferred:
        refused = 0
        while high.step_length - low.step_length > CLOSE_M:
            best = min(low, high, key=lambda t: abs(t.slope))
            if self._away(best, low, high) < CLOSE_M:
                words = f"the slopes place it within {CLOSE_M:g} m"
                return self._answer(True, words, best, (low, high))
            if len(self.trials) + self.refused >= MOST_GAITS or refused > HALVINGS:
                return self._answer(False, "too many gaits", best, (low, high))
            share = _minimum_of_cubic(low, high) if not refused else 0.5**refused / 2
            trial = self._try(low.step_length + share * (high.step_length - low.step_length))
            if trial is None:
                refused += 1
            elif trial.slope > 0:
                high, refused = trial, 0
            else:
                low, refused = trial, 0
        best = min(low, high, key=lambda t: abs(t.slope))
        return self._answer(
            True, f"between two gaits less than {CLOSE_M:g} m apart", best, (low, high)
        )

    @staticmethod
    def _away(best: Trial, low: Trial, high: Trial) -> float:
        """How far the minimum is from the better end if the slope changes evenly in between."""
        change = high.slope - low.slope
        way = high.step_length - low.step_length
        return abs(best.slope) * way / change if change > 0 else math.inf

    def _answer(
        self,
        found: bool,
        words: str,
        best: Trial | None = None,
        bracket: tuple[Trial, Trial] | None = None,
    ) -> Preferred:
        best = best or min(self.trials, key=lambda t: t.value)
        ends = bracket or (best, best)
        head = "minimum" if found else "no minimum"
        gaits = f"{len(self.trials)} gaits" + (f", {self.refused} refused" if self.refused else "")
        return Preferred(
            speed=self.speed,
            criterion=self.criterion.name,
            gait=best.gait,
            bracket=(ends[0].step_length, ends[1].step_length),
            found=found,
            status=f"{head}: {words} ({gaits})",
            trials=tuple(self.trials),
        )


def _minimum_of_cubic(low: Trial, high: Trial) -> float:
    """Where in a bracket the cubic through values and slopes at its ends has its minimum.

    Slopes are negative at the lower and positive at the upper end, so there is one; E of a mesh is
    rougher than its slopes, so where they contradict each other the slopes alone decide.
    """
    way = high.step_length - low.step_length
    a, b = low.slope * way, high.slope * way
    chord = high.value - low.value
    secant = a / (a - b) if a != b else 0.5
    curve = a + b - 2 * chord
    steep = 3 * chord - 2 * a - b
    roots = steep**2 - 3 * curve * a
    share = secant
    if roots >= 0 and (bottom := steep + math.sqrt(roots)) > 0:
        cubic = -a / bottom
        share = cubic if abs(cubic - secant) < 0.25 else secant
    return min(max(share, _INSIDE), 1 - _INSIDE)
