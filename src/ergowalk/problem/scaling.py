"""A problem for another person: the body, and a step and a stride time in proportion.

Walkers of different size move alike when their Froude numbers v^2 / (g l) are equal, l being the
height of the hip (Alexander & Jayes 1983). Lengths then go with l, and times with sqrt(l / g)
(Hof 1996).
"""

from __future__ import annotations

import math

from ergowalk.anthropometry import Person
from ergowalk.body import Body
from ergowalk.problem.gait_problem import GaitProblem

REFERENCE_HEIGHT_M = 1.75
"""Body height of the person whose step and stride time a preset states: neither the paper nor the
human tables give one. The paper's walker weighs 73.18 kg."""

DIGITS = 4
"""Decimals of step length [m] and stride time [s] of a scaled problem."""


def for_person(problem: GaitProblem, person: Person) -> GaitProblem:
    """The problem with the body of a person, at the same Froude number.

    Parameters
    ----------
    problem : GaitProblem
        Its step length and stride time are taken for those of a person of
        :data:`REFERENCE_HEIGHT_M`; its body gives gravity and nothing else.
    person : Person

    Raises
    ------
    ProblemError, BodyError
        If no such body or problem can exist.
    """
    reference = Person(height_m=REFERENCE_HEIGHT_M, mass_kg=person.mass_kg)
    scale = person.leg_length_m / reference.leg_length_m
    scaled: GaitProblem = problem.replace(
        name=f"{person.height_m:g} m, {person.mass_kg:g} kg",
        step_length_m=round(problem.step_length_m * scale, DIGITS),
        stride_time_s=round(problem.stride_time_s * math.sqrt(scale), DIGITS),
        body=Body(**person.parameters(), gravity_m_s2=problem.body.gravity_m_s2),
    )
    return scaled
