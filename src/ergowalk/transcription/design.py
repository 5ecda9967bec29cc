"""Free numbers of body and devices as unknowns that all phases share."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ergowalk.errors import InputError, ProblemError
from ergowalk.problem import GaitProblem
from ergowalk.problem.design import free_values, with_symbols
from ergowalk.transcription.phases import Instant, Link, Terms, Unknown

if TYPE_CHECKING:
    from ergowalk.transcription.walker import Walker

FOOT_TRIANGLE = ("heel_to_ankle_m", "ankle_to_metatarsal_m", "heel_to_metatarsal_m")
"""What the angle of a flat foot follows from."""

ROOM = 0.1
"""Least scale of an unknown as a share of its largest value: where its bounds leave no room."""

SLACK = 1e-9
"""What stands for a device's number that is held at zero where its unknowns are laid out."""

Cost = Callable[[Mapping[str, Any]], Any]


def design_unknowns(problem: GaitProblem) -> Iterator[Unknown]:
    """One unknown for each free number, by its path.

    Bounds alone set the scale, so that a gait found is the optimum of the same programme as the
    gait that the search began with.
    """
    for free in problem.design.free:
        largest = max(abs(free.lowest), abs(free.highest))
        scale = max(free.highest - free.lowest, ROOM * largest) or 1.0
        yield Unknown(free.path, free.lowest, free.highest, scale)


def designed(walker: Walker, shared: Mapping[str, Any]) -> Walker:
    """The walker with these values of the free numbers: all of them numbers, or expressions.

    Raises
    ------
    ProblemError
        For numbers that make no walker, though each corner of their bounds does.
    """
    problem = walker.asked
    if not problem.design:
        return walker

    def with_problem(found: GaitProblem) -> Walker:
        return type(walker)(found, walker.smoothing, walker.unequal)

    values = {path: shared[path] for path in problem.design.paths}
    if not all(isinstance(value, float) for value in values.values()):
        return with_problem(with_symbols(problem, values))
    inside = {free.path: free.inside(values[free.path]) for free in problem.design.free}
    try:
        return with_problem(problem.with_design(inside))
    except InputError as error:
        raise ProblemError(
            f"the search ended where no walker can be: {error.rule}",
            "narrow the bounds",
            field="design",
            value=inside,
        ) from None


def structural(problem: GaitProblem) -> GaitProblem:
    """The problem whose devices say which unknowns there are: a free number is never zero."""
    values = free_values(problem) if problem.design else {}
    noughts = {
        free.path: free.middle or SLACK
        for free in problem.design.free
        if isinstance(value := values[free.path], float) and value == 0.0
    }
    return with_symbols(problem, noughts)


def reference_mass(problem: GaitProblem) -> float:
    """Mass [kg] that the objective is divided by: M, with free masses half way in their bounds.

    It must not depend on where a search begins, or stored multipliers would.
    """
    middles = {free.path: free.middle for free in problem.design.free}
    mass: float = with_symbols(problem, middles).body.total_mass
    return mass


def mass_factor(walker: Walker) -> Cost | None:
    """Mass over the reference mass, which work per kg is to be multiplied with; None if fixed."""
    if not _frees(walker.asked, "_mass_kg"):
        return None
    return lambda shared: walker.at(shared).mass / walker.reference_mass


def frees_toes(problem: GaitProblem) -> bool:
    """Whether the length of a toe link is free."""
    return _frees(problem, "toe_length_m")


def frees_foot_angle(problem: GaitProblem) -> bool:
    """Whether the angle of a flat foot is free."""
    return _frees(problem, *FOOT_TRIANGLE)


def flat_foot_links(walker: Walker, boundaries: Iterator[str]) -> Iterator[Link]:
    """(4) where the sole is flat and its angle no number: the leading foot has that angle."""

    def function(instant: Instant) -> Terms:
        terms, at = Terms(), walker.at(instant.shared)
        terms.equal("flat foot (4)", instant.coordinates["foot_1"].value - at.flat)
        return terms

    for boundary in boundaries:
        yield Link(f"flat_{boundary}", boundary, function)


def _frees(problem: GaitProblem, *endings: str) -> bool:
    """Whether a number of this field is free, for both legs or one."""
    names = (path.removesuffix(".1").removesuffix(".2") for path in problem.design.paths)
    return any(name.endswith(endings) for name in names)
