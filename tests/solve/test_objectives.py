"""Other objectives than (10), in the programme: what it minimises is what the curves cost."""

from __future__ import annotations

from pathlib import Path

import pytest

from ergowalk.errors import ProblemError
from ergowalk.problem import GaitProblem, JointBounds, Objective, preset
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Solution
from ergowalk.solution.objective import objective_terms
from ergowalk.solving import solve
from ergowalk.solving.memory import recall
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.walker import Smoothing
from ergowalk.transcription.walking import walking_problem

FIXED: GaitProblem = preset("berbyuk2002-rhythm")
NOTHING_ELSE = Smoothing(0.0, 0.0, 0.0)

FINE = 5e-3
"""Relative: how far the nodes of a reported mesh may be from the dense curves."""


@pytest.fixture(scope="module")
def gait(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


def programme_value(gait: Solution, objective: Objective) -> float:
    """What the programme of another objective makes of a solved gait [J/m]."""
    _, result = recall(gait)
    problem = FIXED.replace(objective=objective)
    (order,) = problem.rhythm.orders()
    phased = walking_problem(problem, (order,), NOTHING_ELSE)
    collocation = Collocation(phased, result.collocation.mesh, result.points)
    value, _ = collocation.programme.evaluate(result.minimum.x)
    return float(energy_per_metre(value * problem.body.total_mass, problem.step_length_m))


MIXED = Objective(
    absolute_work=0.3,
    muscle_work=0.2,
    regenerative_work=0.5,
    moment_squared_s_per_m2=0.2,
    moment_rate_squared_s3_per_m2=2e-4,
)


def test_the_programme_charges_what_the_dense_curves_cost(gait: Solution) -> None:
    """Up to the quadrature of |power| and to moments that are parabolas in an element."""
    problem = FIXED.replace(objective=MIXED)
    terms = objective_terms(gait.dataset, problem)
    assert min(terms.values()) > 0.02 * sum(terms.values())  # each counts
    assert programme_value(gait, MIXED) == pytest.approx(sum(terms.values()), rel=FINE)


def test_positive_work_is_half_of_e_for_the_programme_too(gait: Solution) -> None:
    half = programme_value(gait, Objective(absolute_work=0.0, positive_work=1.0))
    assert half == pytest.approx(programme_value(gait, Objective()) / 2, rel=1e-3)


def test_squared_moments_alone_need_no_slacks(gait: Solution) -> None:
    """Slacks that cost nothing would be lost to the solver."""
    squares = Objective(absolute_work=0.0, moment_squared_s_per_m2=1.0)
    problem = FIXED.replace(
        objective=squares, limits=FIXED.limits.replace(moment_rate_nm_per_kg_s=JointBounds())
    )
    assert problem.well_posed
    search, result = recall(gait)
    phased = walking_problem(problem, search.orders)
    collocation = Collocation(phased, result.collocation.mesh, result.points)
    assert "power slacks" in result.collocation.programme.labels
    assert "power slacks" not in collocation.programme.labels


def test_the_papers_method_minimises_eq10_alone() -> None:
    problem = FIXED.replace(objective=Objective(muscle_work=1.0))
    with pytest.raises(ProblemError, match=r"objective = 'E \+ muscle .* \(10\) alone"):
        solve(problem, method="spline")
