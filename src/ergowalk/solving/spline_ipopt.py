"""The spline programme by IPOPT with exact derivatives: few knots first, then those asked for."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.solvers.ipopt import Ipopt, Minimum
from ergowalk.solving.spline_answer import SplineAnswer, dense_curves, record
from ergowalk.transcription.spline.programme import SplineProgramme
from ergowalk.transcription.spline.rows import Asked
from ergowalk.transcription.spline.smooth import SmoothProgramme

Array = NDArray[np.float64]
Watch = Callable[[str, int, float, float], None]
"""Called with stage, iteration, E [J/m] at the samples, largest violation."""

FIRST_KNOTS, LADDER = 20, 1.5
"""Knots of the first stage, and by which factor they may grow from stage to stage."""

FROM_AFAR = Ipopt(
    tolerance=1e-5, strategy="monotone", barrier_start=1e-2, push=1e-3, max_iterations=800
)
FROM_NEAR = Ipopt(
    tolerance=1e-5, strategy="monotone", barrier_start=1e-3, push=1e-3, max_iterations=800
)
AGAIN = Ipopt(
    tolerance=1e-5, strategy="monotone", barrier_start=1e-4, push=1e-4, max_iterations=800
)
"""Starts: the human means; the gait on fewer knots; the gait with fewer samples."""


def ladder(knots: int) -> list[int]:
    """Knots of all stages.

    >>> ladder(12), ladder(30), ladder(80)
    ([12], [20, 30], [20, 30, 45, 68, 80])
    """
    found = [min(knots, FIRST_KNOTS)]
    while found[-1] < knots:
        found.append(min(knots, round(LADDER * found[-1] + 0.25)))
    return found


@dataclass
class Climb:
    """Stages so far: what they found, and what they have cost."""

    asked: Asked
    watch: Watch | None
    build_time: float
    iterations: int = 0
    solve_time: float = 0.0
    history: list[dict[str, Any]] = field(default_factory=list)

    def run(
        self, programme: SplineProgramme, start: Array, solver: Ipopt, **flags: bool
    ) -> tuple[Array, float, Minimum]:
        """From C of a programme: unknowns, dense E [J/m], the solver's answer."""
        began = time.process_time()
        smooth = SmoothProgramme(programme, self.asked)
        nlp, x = smooth.programme, smooth.pack(start)
        _ = nlp.oracle
        self.build_time += time.process_time() - began
        words = f"spline, {len(programme.curves.grid) - 1} knots, {programme.samples} samples each"

        def monitor(iteration: int, objective: float, violation: float) -> None:
            if self.watch is not None:
                self.watch(words, iteration, smooth.energy(objective), violation)

        minimum = solver.minimise(nlp, x, monitor)
        self.iterations += minimum.iterations
        self.build_time += minimum.build_time
        self.solve_time += minimum.solve_time
        unknowns = smooth.unpack(minimum.x)
        energy = dense_curves(programme, unknowns)[1]
        self.history.append(
            record(programme, energy, minimum.iterations, minimum.converged, **flags)
        )
        return unknowns, energy, minimum


def by_ipopt(
    programme: SplineProgramme, knots: int, asked: Asked, watch: Watch | None, build_time: float
) -> SplineAnswer:
    """From C = 0 of a programme on the first knots of the ladder to the optimum on ``knots``."""
    climb = Climb(asked, watch, build_time)
    steps = ladder(knots)
    start = programme.initial()
    last = None if asked is Asked.EVERYTHING else knots  # there the samples are doubled first
    unknowns, energy, minimum = climb.run(programme, start, FROM_AFAR, **_last(last, steps[0]))
    for count in steps[1:]:
        programme = programme.on_knots(unknowns, count)
        start = programme.initial()
        unknowns, energy, minimum = climb.run(programme, start, FROM_NEAR, **_last(last, count))
    if last is None:
        # what the audit asks for everywhere must hold between the samples too
        programme = programme.with_samples(2 * programme.samples)
        unknowns, energy, minimum = climb.run(programme, unknowns, AGAIN, final=True)
    settled, said = minimum.converged, f"{minimum.message}, E = {energy:.2f} J/m"
    if minimum.converged:
        finer = programme.with_samples(2 * programme.samples)
        _, confirmed, check = climb.run(finer, unknowns, AGAIN, finer=True)
        change = confirmed / energy - 1
        settled = check.converged
        said += f", {100 * change:+.2f} % with twice the samples"
        if not check.converged:
            said += f", where it did not converge ({check.message})"
    return SplineAnswer(
        programme,
        unknowns,
        climb.history,
        said,
        settled,
        iterations=climb.iterations,
        evaluations=climb.iterations,
        solve_time=climb.solve_time,
        build_time=climb.build_time,
    )


def _last(knots: int | None, count: int) -> dict[str, bool]:
    return {"final": True} if count == knots else {}
