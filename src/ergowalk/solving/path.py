"""A family of gaits along one number of the problem, each found from the one before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ergowalk.problem import GaitProblem
from ergowalk.solution import Solution
from ergowalk.solution.progress import Report
from ergowalk.solving.collocation import solve_collocation
from ergowalk.solving.prices import changed, given_number, price_of
from ergowalk.transcription.walker import Smoothing

HALVINGS = 3
"""How often a step is halved whose corrector does not end in an acceptable gait."""


@dataclass(frozen=True)
class Waypoint:
    """One gait of a path.

    Attributes
    ----------
    value : float
        The number that is changed, in the problem's unit.
    solution : Solution
    predicted : float
        E [J/m] that the price of the number at the gait before let expect.
    steps : int
        Solves that the way from the gait before took: 1 unless the step had to be divided.
    """

    value: float
    solution: Solution
    predicted: float
    steps: int


def follow(
    start: Solution,
    name: str,
    values: Sequence[float],
    *,
    progress: Report | None = None,
    smoothing: Smoothing | None = None,
) -> tuple[Waypoint, ...]:
    """The cheapest gaits while one number of the problem runs through some values.

    Predictor: the point, the multipliers and the mesh of the gait before, and its E plus its
    price of the number times the step. Corrector: the collocation continued from there, its mesh
    refined where that became too coarse, checked and audited like any other. Where the corrector
    does not end in an acceptable gait, the way is divided in halves.

    (The point extrapolated along the last step was tried as a predictor too: it saves no
    iteration, for it is the change of the active bounds that takes them.)

    Parameters
    ----------
    start : Solution
        A gait by collocation.
    name : str
        Path of the number in the problem file: ``step_length_m``, ``corridors.width_sd``,
        ``limits.vertical_reaction_body_weights``, ``body.trunk_mass_kg``, ...
    values : sequence of float
        In the order in which they are walked.

    Raises
    ------
    GaitFileError
        If the start keeps no multipliers.
    ProblemError
        If the problem has no such number, or excludes one of the values.
    """
    last = given_number(start.problem, name)
    problems = [changed(start.problem, name, float(value)) for value in values]
    walked: list[Waypoint] = []
    here = start
    for value, problem in zip(values, problems, strict=True):
        predicted = here.energy_per_metre + price_of(here, name) * (value - last)
        here, steps = _step(here, name, last, problem, float(value), HALVINGS, progress, smoothing)
        walked.append(Waypoint(float(value), here, predicted, steps))
        last = float(value)
    return tuple(walked)


def _step(
    here: Solution,
    name: str,
    last: float,
    problem: GaitProblem,
    value: float,
    halvings: int,
    progress: Report | None,
    smoothing: Smoothing | None,
) -> tuple[Solution, int]:
    """From one value to another, and how many solves that took."""
    there = solve_collocation(problem, smoothing, here, progress)
    if there.acceptable or halvings == 0:
        return there, 1
    middle = (last + value) / 2
    between = changed(problem, name, middle)
    half, first = _step(here, name, last, between, middle, halvings - 1, progress, smoothing)
    if not half.acceptable:
        return there, 1 + first
    end, second = _step(half, name, middle, problem, value, halvings - 1, progress, smoothing)
    return end, 1 + first + second
