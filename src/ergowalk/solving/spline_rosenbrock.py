"""Rosenbrock's method on the exterior penalty (19): the paper's own way to the optimum.

Q_1 = E + sum_l lambda_l (G_l / tolerance_l)^2. Printed is the first power; its kinks along every
constraint stop rotating directions too early, see
:class:`~ergowalk.solvers.penalty.ExteriorPenalty`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ergowalk.solvers.blocks import BlockedFunction
from ergowalk.solvers.penalty import ExteriorPenalty
from ergowalk.solvers.penalty_answer import PenaltyMinimum, PenaltyPoint
from ergowalk.solvers.rosenbrock import Rosenbrock
from ergowalk.solving.spline_answer import SplineAnswer, dense_curves, record
from ergowalk.transcription.spline.programme import SplineProgramme
from ergowalk.transcription.spline.semi_inverse import MEASURES

Array = NDArray[np.float64]
Weights = float | Mapping[str, float]
Watch = Callable[[str, int, float, float], None]
"""Called with stage, number of the recorded point, E [J/m], largest measure over its tolerance."""

POWER = 2.0
"""Power of the measures in Q_1."""

FIRST_WEIGHT, GROWTH = 0.1, 3.0
"""lambda of the first round [J/m]: a measure at its tolerance costs a thousandth of E."""


@dataclass(frozen=True)
class Pass:
    """One search: how little of a stage is enough, starting steps, growth of the weights."""

    name: str
    progress_tolerance: float
    step: float
    growth: float


COARSE = Pass("penalty, coarse", 1e-3, 5e-3, GROWTH)
CLOSE = Pass("penalty, close", 1e-4, 2e-3, 2.0)
"""Rounds that are content with little find weights; closer searches begin with them. Directions
collapse along the penalties' walls, and fresh ones go on: the closer search is repeated while it
brings something."""

CLOSE_SAMPLES = 8
"""Samples of a knot interval in closer searches. With the 4 of the coarse one the integral of
absolute powers is 1 % off, and its corners at every sample hold the directions up."""

LEAST_GAIN, MOST_PASSES = 0.002, 8
"""Share of E that a closer search must bring to be repeated, and how often it may be."""

CHECK = Pass("penalty, twice the samples", 1e-4, 1e-3, 2.0)


@dataclass
class Tally:
    """Evaluations and recorded points of all passes so far."""

    watch: Watch | None
    limit: int
    points: list[PenaltyPoint] = field(default_factory=list)
    evaluations: int = 0
    rounds: int = 0
    seconds: float = 0.0

    def run(
        self,
        programme: SplineProgramme,
        start: Array,
        weights: Weights,
        by: Pass,
        keep: bool = True,
    ) -> PenaltyMinimum:
        """One pass from ``start``; ``keep`` says whether its points belong to the trace."""
        tolerances = programme.tolerances()

        def evaluate(x: Array) -> tuple[float, Array]:
            energy, measures = programme.value(x)
            return energy, measures / tolerances

        function = BlockedFunction(MEASURES, evaluate, np.ones(len(MEASURES)))
        number = 0

        def monitor(point: PenaltyPoint) -> None:
            nonlocal number
            number += 1
            if keep:
                self.points.append(
                    replace(
                        point,
                        evaluations=self.evaluations + point.evaluations,
                        round=self.rounds + point.round,
                    )
                )
            if self.watch is not None:
                self.watch(by.name, number, point.objective, float(max(point.measures)))

        penalty = ExteriorPenalty(
            inner=Rosenbrock(
                progress_tolerance=by.progress_tolerance, max_evaluations=self.limit + 1
            ),
            weights=weights,
            growth=by.growth,
            power=POWER,
            max_evaluations=max(1, self.limit - self.evaluations),
        )
        found = penalty.minimise(function, start, by.step, monitor)
        self.evaluations += found.evaluations
        self.rounds += found.rounds
        self.seconds += found.solve_time
        return found


def by_rosenbrock(
    programme: SplineProgramme, max_evaluations: int, watch: Watch | None, build_time: float
) -> SplineAnswer:
    """From C = 0 to the least Q_1, then once more with twice the samples."""
    tally = Tally(watch, max_evaluations)
    found = tally.run(programme, programme.initial(), FIRST_WEIGHT, COARSE)
    for _ in range(MOST_PASSES):
        before = found
        if not before.converged or tally.evaluations >= max_evaluations:
            break
        closer = programme.with_samples(max(CLOSE_SAMPLES, programme.samples))
        found = tally.run(closer, before.x, before.weights, CLOSE)
        if not found.accepted:  # stopped on the way, outside
            found = before
            break
        programme = closer
        if found.objective > (1 - LEAST_GAIN) * before.objective:
            break
    _end_with(tally.points, found)
    count, effort = len(tally.points), tally.evaluations
    energy = dense_curves(programme, found.x)[1]
    history = [record(programme, energy, effort, found.converged, final=True)]
    said = f"{found.message}, E = {energy:.2f} J/m after {effort} evaluations"
    settled = found.converged
    if settled:
        finer = programme.with_samples(2 * programme.samples)
        check = tally.run(finer, found.x, found.weights, CHECK, keep=False)
        confirmed = dense_curves(finer, check.x)[1]
        history.append(record(finer, confirmed, check.evaluations, check.converged, finer=True))
        change = confirmed / energy - 1
        settled = check.converged
        ended = "" if check.converged else f", where it stopped ({check.message})"
        said += f", {100 * change:+.2f} % when continued with twice the samples{ended}"
    return SplineAnswer(
        programme,
        found.x,
        history,
        said,
        settled,
        iterations=count,
        evaluations=tally.evaluations,
        solve_time=tally.seconds,
        build_time=build_time,
        trace=tuple(tally.points),
    )


def _end_with(points: list[PenaltyPoint], found: PenaltyMinimum) -> None:
    """The trace ends with the answer: the best accepted round need not be the last."""
    last = points[-1]
    if not np.array_equal(last.x, found.x):
        end = next(p for p in reversed(points) if np.array_equal(p.x, found.x))
        points.append(replace(end, evaluations=last.evaluations, round=last.round))
