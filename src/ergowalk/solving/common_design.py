"""One design for several operating points: the least weighted mean of what their gaits cost."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ergowalk.errors import ProblemError
from ergowalk.problem import GaitProblem
from ergowalk.problem.design import held_at
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Progress, Solution
from ergowalk.solution.progress import Report
from ergowalk.solvers.ipopt import Ipopt, Minimum
from ergowalk.solving.collocation import solve_collocation
from ergowalk.solving.design_prices import Found, found_number
from ergowalk.solving.joint import Joint, Part, joined
from ergowalk.solving.memory import recall
from ergowalk.solving.multipliers import with_fixed
from ergowalk.transcription.walker import Smoothing

SOLVERS = (
    Ipopt(tolerance=1e-6, strategy="monotone", barrier_start=1e-6, push=1e-4),
    Ipopt(tolerance=1e-6),
)
"""How the common search is tried: close to the gaits that it begins with, then anyhow."""


@dataclass(frozen=True)
class OperatingPoint:
    """One of the points.

    Attributes
    ----------
    weight : float
        Its share in the mean; all shares add up to 1.
    alone : Solution
        The gait whose design suits this point alone.
    common : Solution
        The gait with the common design; ``alone`` where none was found.
    """

    weight: float
    alone: Solution
    common: Solution


@dataclass(frozen=True)
class CommonDesign:
    """A design for several operating points, and their gaits.

    Attributes
    ----------
    found : tuple of Found
        The free numbers, their bounds, and what these cost the mean [J/m per unit].
    points : tuple of OperatingPoint
    converged : bool
        Whether the common search converged.
    status : str
        One sentence on how it ended.
    """

    found: tuple[Found, ...]
    points: tuple[OperatingPoint, ...]
    converged: bool
    status: str

    @property
    def values(self) -> dict[str, float]:
        """The free numbers by path."""
        return {found.path: found.value for found in self.found}

    @property
    def energy_per_metre(self) -> float:
        """Weighted mean of E [J/m] of the gaits with the common design."""
        return sum(p.weight * p.common.energy_per_metre for p in self.points)

    @property
    def objective_per_metre(self) -> float:
        """Weighted mean of what was minimised [J/m]: E unless the problems say otherwise."""
        return sum(p.weight * p.common.objective_per_metre for p in self.points)

    @property
    def acceptable(self) -> bool:
        """Whether the search converged and every gait with the common design is acceptable."""
        return self.converged and all(p.common.acceptable for p in self.points)


def design(
    problems: Sequence[GaitProblem],
    weights: Sequence[float] | None = None,
    *,
    starts: Sequence[Solution] | None = None,
    progress: Report | None = None,
    smoothing: Smoothing | None = None,
) -> CommonDesign:
    """The design that makes the weighted mean of the objectives of several problems least.

    Each problem is first solved by itself, its design free. Then all of them are one programme
    whose design is common, each gait on its own mesh, begun at the gaits found. At last each gait
    is found again with that design held, its mesh refined where it must be, and audited.

    Parameters
    ----------
    problems : sequence of GaitProblem
        Operating points, with the same ``design``; they may differ in anything else.
    weights : sequence of float, optional
        Positive; equal if left out.
    starts : sequence of Solution, optional
        A gait for each problem to begin with.
    progress : callable, optional
        Called once an iteration.
    smoothing : Smoothing, optional
        Other small costs than the usual ones.

    Returns
    -------
    CommonDesign
        Also where no acceptable design was found; ``status`` says why.

    Raises
    ------
    ProblemError
        For no problem, nothing free, designs that differ, or weights that are not positive.
    """
    shares = _shares(problems, weights)
    _check_designs(problems)
    alone: list[Solution] = []
    for k, problem in enumerate(problems):
        start = starts[k] if starts is not None else None
        gait = solve_collocation(problem, smoothing, start, _named(progress, k, len(problems)))
        alone.append(gait)
        if not gait.acceptable:
            status = f"point {k + 1} has no acceptable gait of its own: {gait.status}"
            points = [OperatingPoint(s, g, g) for s, g in zip(shares, alone, strict=False)]
            return CommonDesign((), tuple(points), False, status)
    found, minimum = _common(alone, shares, progress)
    values = {number.path: number.value for number in found}
    points = []
    for k, (problem, gait) in enumerate(zip(problems, alone, strict=True)):
        said = _named(progress, k, len(problems))
        points.append(
            OperatingPoint(shares[k], gait, _held(problem, values, gait, smoothing, said))
        )
    failed = [k + 1 for k, point in enumerate(points) if not point.common.acceptable]
    status = f"{minimum.message}: {len(problems)} gaits with one design"
    if failed:
        status += f"; no acceptable gait with it at point {', '.join(map(str, failed))}"
    return CommonDesign(found, tuple(points), minimum.converged, status)


def _common(
    gaits: Sequence[Solution], shares: Sequence[float], progress: Report | None
) -> tuple[tuple[Found, ...], Minimum]:
    """The common design of gaits that each have their own."""
    stages = [recall(gait) for gait in gaits]
    parts = []
    for (search, stage), share in zip(stages, shares, strict=True):
        mass, length = search.walker.reference_mass, search.distance
        layout = stage.collocation.layout
        parts.append(
            Part(
                stage.collocation.programme,
                stage.minimum,
                share * float(energy_per_metre(mass, length)),
                np.array([layout.shared[path] for path in search.problem.design.paths]),
            )
        )
    mean = sum(part.weight for part in parts)  # work per kg, as each of them by itself has it
    whole = joined([replace(part, weight=part.weight / mean) for part in parts])
    minimum = _minimised(whole, mean, progress)
    search, stage = stages[0]
    scale = stage.collocation.layout.scale[parts[0].common]
    found = (
        found_number(
            free,
            float(free.inside(minimum.x[i] * scale[i])),
            float(minimum.variable_multipliers[i]),
            float(scale[i]),
            mean,
        )
        for i, free in enumerate(search.problem.design.free)
    )
    return tuple(found), minimum


def _minimised(whole: Joint, unit: float, progress: Report | None) -> Minimum:
    """The minimum of the joint programme, or how the last try ended."""
    began = time.monotonic()

    def monitor(iteration: int, objective: float, violation: float) -> None:
        if progress is not None:
            elapsed = time.monotonic() - began
            progress(Progress("one design", iteration, objective * unit, violation, elapsed))

    first, *others = SOLVERS
    minimum = first.minimise(whole.programme, whole.start, monitor, whole.multipliers)
    for solver in others:
        if minimum.converged:
            break
        minimum = solver.minimise(whole.programme, whole.start, monitor)
    return with_fixed(whole.programme, minimum)


def _held(
    problem: GaitProblem,
    values: dict[str, float],
    gait: Solution,
    smoothing: Smoothing | None,
    progress: Report | None,
) -> Solution:
    """The gait with a design held, found from one with another design."""
    held = held_at(problem, values)
    found = solve_collocation(held, smoothing, gait, progress)
    return found if found.acceptable else solve_collocation(held, smoothing, None, progress)


def _named(progress: Report | None, k: int, count: int) -> Report | None:
    """The same report, each stage led by the number of its point."""
    if progress is None:
        return None
    report = progress
    return lambda state: report(replace(state, stage=f"point {k + 1} of {count}: {state.stage}"))


def _shares(problems: Sequence[GaitProblem], weights: Sequence[float] | None) -> list[float]:
    """Weights that add up to 1."""
    if not problems:
        raise ProblemError("names no operating point", "give one problem or more", field="problems")
    given = [1.0] * len(problems) if weights is None else [float(w) for w in weights]
    if len(given) != len(problems) or not all(0 < w < math.inf for w in given):
        raise ProblemError(
            "must be positive, one for each problem",
            "give as many weights as problems",
            field="weights",
            value=given,
        )
    return [w / sum(given) for w in given]


def _check_designs(problems: Sequence[GaitProblem]) -> None:
    first = problems[0].design
    if not first:
        raise ProblemError(
            "nothing is free",
            'give bounds, as "devices.ankle.stiffness_nm_per_rad" = [50.0, 600.0]',
            field="design",
        )
    for problem in problems[1:]:
        if problem.design != first:
            raise ProblemError(
                "differs between the operating points",
                "give each the same paths and bounds",
                field="design",
                value=problem.design.sentence(),
            )
