"""Exterior penalty (19): blocks of constraints weighed into the objective, ever heavier.

Minimise Q_1 = Q + sum_l lambda_l G_l, raise the weights lambda_l of those blocks whose measure
G_l is still above its tolerance, and go on from there until all are below.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import InputError
from ergowalk.solvers.blocks import BlockedFunction, by_name
from ergowalk.solvers.descent import finite_vector
from ergowalk.solvers.penalty_answer import Monitor, PenaltyMinimum, PenaltyPoint, PenaltyTrace
from ergowalk.solvers.rosenbrock import Rosenbrock

Array = NDArray[np.float64]


class Answer(Protocol):
    """What the penalty reads of the answer of an inner method."""

    @property
    def x(self) -> Array:
        """Where it stopped."""

    @property
    def converged(self) -> bool:
        """Whether of its own accord."""


class InnerMethod(Protocol):
    """An unconstrained method; it must let exceptions of function and monitor through."""

    def minimise(
        self,
        function: Callable[[Array], float],
        start: Array,
        steps: float | Array | None = None,
        monitor: Callable[[Any], object] | None = None,
    ) -> Answer:
        """Minimise from start; the monitor is given an object with ``x`` after each stage."""


@dataclass(frozen=True, kw_only=True)
class ExteriorPenalty:
    """The outer loop of problem (19).

    With ``power`` 1 the penalty is exact, eq. (19) to the letter: weights above the multipliers
    will do, but Q_1 has a kink along every constraint, and there rotating directions come to rest
    before the minimum. Fresh directions each round, smaller steps and light weights that grow
    slowly help; squares of the measures (``power`` 2) do more. Measured:

    - eight problems of Hock and Schittkowski, tolerance 1e-5, growth 10: errors of the objective
      of up to 4.4 with power 1, 2.5e-5 with power 2;
    - a quadratic of 60 variables with a corridor at 200 instants, 32 000 to 130 000 evaluations,
      excess over the minimum: 7 % to 20 % with power 1, weights of 100 and growth 10; 2.6 % with
      weights of 1 and growth 1.5, not quite accepted; 1.4 % with power 2, weights and growth 10.

    There it pays to be content with little in each round (``progress_tolerance`` of the inner
    method 1e-3 to 1e-4), and to let a second, closer search begin with the answer's weights.
    Weights too light for Q_1 to have a minimum send the search to infinity: start heavier.

    Attributes
    ----------
    inner : object with ``minimise``
        It starts afresh each round: with new weights the directions of the last round, turned
        along its kinks, are worth nothing. What function and monitor raise must pass through.
    weights : float or mapping from block to float
        lambda of the first round, positive.
    growth : float or mapping from block to float
        Factor by which the weight of a block above its tolerance grows, above 1.
    power : float from 1 to 2
        Q_1 = Q + sum_l lambda_l G_l^power; tolerances are for G_l itself.
    shrink : float
        Factor on the starting steps from round to round: the minimum moves less and less.
    smallest_steps : float
        Where that ends, as a part of the steps of the first round.
    max_rounds, max_evaluations : int
    max_seconds : float, optional
        CPU seconds of the process.
    """

    inner: InnerMethod = field(default_factory=Rosenbrock)
    weights: float | Mapping[str, float] = 1.0
    growth: float | Mapping[str, float] = 10.0
    power: float = 1
    shrink: float = 0.5
    smallest_steps: float = 1e-2
    max_rounds: int = 20
    max_evaluations: int = 1_000_000
    max_seconds: float | None = None

    def __post_init__(self) -> None:
        for name, least, most in _RANGES:
            value = getattr(self, name)
            if value is not None and not least <= value <= most:
                rule = f"must lie between {least:g} and {most:g}"
                raise InputError(rule, "give such a number", field=name, value=value)

    def minimise(
        self,
        function: BlockedFunction,
        start: Array,
        steps: float | Array = 0.1,
        monitor: Monitor | None = None,
    ) -> PenaltyMinimum:
        """Minimise from ``start``; failing to satisfy the constraints is an answer.

        Parameters
        ----------
        function : BlockedFunction
        start : (n,) array
        steps : float or (n,) array
            Starting steps of the first round.
        monitor : callable, optional
            Given each recorded :class:`PenaltyPoint`.

        Raises
        ------
        InputError
            If start cannot be used, or weights or what ``function`` returns do not fit its blocks.
        Exception
            Whatever function, monitor and inner method raise, KeyboardInterrupt too.
        """
        x = finite_vector(start)
        return _Loop(self, function, monitor).minimise(x, np.asarray(steps, dtype=float))


_RANGES = (
    ("power", 1, 2),
    ("shrink", 1e-6, 1.0),
    ("smallest_steps", 1e-12, 1.0),
    ("max_rounds", 1, math.inf),
    ("max_evaluations", 1, math.inf),
    ("max_seconds", 0.0, math.inf),
)


class _Spent(Exception):
    """Ends the inner method when a limit of the whole is reached."""


class _Loop:
    """State of one run: weights, counts, the best point of the round, recorded points."""

    def __init__(
        self, options: ExteriorPenalty, function: BlockedFunction, monitor: Monitor | None
    ) -> None:
        names = function.names
        self.options, self.function, self.monitor = options, function, monitor
        self.weights = by_name(options.weights, names, "weights", 0.0)
        self.growth = by_name(options.growth, names, "growth", 1.0)
        self.evaluations, self.rounds = 0, 0
        self.began = time.process_time()
        self.points: list[PenaltyPoint] = []

    @property
    def seconds(self) -> float:
        return time.process_time() - self.began

    def minimise(self, start: Array, steps: Array) -> PenaltyMinimum:
        options, answer, settled = self.options, None, False
        self._begin(start)
        scale, done = 1.0, False
        while not done:
            self.rounds += 1
            converged, limit = self._round(steps * scale)
            end = self._record(self.best_x, ends_round=True)
            over = ~(end.measures <= self.function.tolerances)
            accepted = math.isfinite(end.penalised) and not over.any()
            if accepted and (answer is None or end.objective <= answer.objective):
                answer, settled = end, converged
            if not limit and self.rounds >= options.max_rounds:
                limit = "ran out of rounds"
            done = bool(limit) or (accepted and converged)
            self.weights = np.where(over, self.weights * self.growth, self.weights)
            scale = max(scale * options.shrink, options.smallest_steps)
        return self._answer(end if answer is None else answer, answer is not None, settled, limit)

    def _begin(self, start: Array) -> None:
        """The first evaluation; refuses measures that do not fit the blocks."""
        objective, measures = self.function.evaluate(start)
        measures = np.array(measures, dtype=float)
        if measures.shape != (len(self.function.names),) or np.any(measures < 0.0):
            raise InputError(
                f"must be {len(self.function.names)} numbers that are not negative",
                "return one measure of violation for each block",
                field="measures",
                value=measures,
            )
        self.evaluations = 1
        self.best_x, self.best = start, (float(objective), measures)

    def _round(self, steps: Array) -> tuple[bool, str]:
        """One inner minimisation: whether it converged, and which limit stopped it, if any."""
        value = self._sum(*self.best)
        self.best_value = value if math.isfinite(value) else math.inf
        try:
            found = self.options.inner.minimise(
                self._penalised,
                self.best_x,
                steps=steps,
                monitor=lambda stage: self._record(stage.x, ends_round=False),
            )
        except _Spent as spent:
            return False, str(spent)
        return found.converged, ""

    def _penalised(self, x: Array) -> float:
        """Q_1 at x; keeps x if it is the best of the round."""
        options = self.options
        if self.evaluations >= options.max_evaluations:
            raise _Spent("ran out of evaluations")
        if options.max_seconds is not None and self.seconds > options.max_seconds:
            raise _Spent("ran out of CPU seconds")
        self.evaluations += 1
        objective, measures = self.function.evaluate(x)
        value = self._sum(objective, measures)
        if -math.inf < value < self.best_value:
            self.best_value, self.best_x = value, np.array(x)
            self.best = float(objective), np.array(measures)
        return value

    def _sum(self, objective: float, measures: Array) -> float:
        """Q_1, eq. (19)."""
        if self.options.power != 1:
            measures = measures**self.options.power
        return float(objective + self.weights @ measures)

    def _record(self, x: Array, ends_round: bool) -> PenaltyPoint:
        """Notes x, which mostly is the best point of the round, its values known."""
        known = np.array_equal(x, self.best_x)
        objective, measures = self.best if known else self.function.evaluate(x)
        point = PenaltyPoint(
            round=self.rounds,
            ends_round=ends_round,
            evaluations=self.evaluations,
            seconds=self.seconds,
            x=np.array(x),
            penalised=self._sum(objective, measures),
            objective=float(objective),
            measures=np.array(measures),
            weights=self.weights,
        )
        self.points.append(point)
        if self.monitor is not None:
            self.monitor(point)
        return point

    def _answer(
        self, at: PenaltyPoint, accepted: bool, settled: bool, limit: str
    ) -> PenaltyMinimum:
        names = self.function.names
        return PenaltyMinimum(
            x=at.x,
            objective=at.objective,
            measures=dict(zip(names, at.measures.tolist(), strict=True)),
            weights=dict(zip(names, at.weights.tolist(), strict=True)),
            accepted=accepted,
            converged=accepted and settled,
            message=self._sentence(at, accepted, settled, limit),
            evaluations=self.evaluations,
            rounds=self.rounds,
            solve_time=self.seconds,
            trace=PenaltyTrace.of(names, self.points),
        )

    def _sentence(self, at: PenaltyPoint, accepted: bool, settled: bool, limit: str) -> str:
        if accepted:
            return f"{'converged' if settled else limit}: every measure is within its tolerance"
        if not math.isfinite(at.penalised):
            return f"{limit}: the function has no finite value near the start"
        worst = (
            f"{name} ({measure:.2g} > {tolerance:.2g})"
            for name, measure, tolerance in zip(
                self.function.names, at.measures, self.function.tolerances, strict=True
            )
            if not measure <= tolerance
        )
        return f"{limit}: above its tolerance is " + ", ".join(worst)
