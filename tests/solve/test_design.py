"""Free numbers are found at their best, and their multipliers say what bounds cost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from ergowalk.errors import ProblemError
from ergowalk.problem import Device, Devices, GaitProblem
from ergowalk.problem.design import Design, held_at, with_bound
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving import design, solve
from ergowalk.solving.design_prices import Found, found_design
from ergowalk.solving.memory import recall
from ergowalk.solving.multipliers import with_fixed_multipliers
from ergowalk.solving.prices import _Optimum
from ergowalk.solving.stages import Effort, OrderSearch, StageResult, Start

PATH = "devices.hip.stiffness_below_nm_per_rad"
SUIT = Devices(hip=Device(kind="spring", stiffness_below_nm_per_rad=50.0))
WIDE = (0.0, 1000.0)


@dataclass(frozen=True)
class Stage:
    """A problem solved on the mesh of the paper's gait."""

    search: OrderSearch
    result: StageResult

    @property
    def least(self) -> float:
        """The least objective [J/m]."""
        assert self.result.minimum.converged
        return self.result.energy_at_nodes

    @property
    def found(self) -> Found:
        """Its free number."""
        minimum = with_fixed_multipliers(self.result)
        (found,) = found_design(self.search, self.result, minimum)
        return found

    def again(self, problem: GaitProblem) -> Stage:
        """Another problem on the same mesh, with the multipliers of this one where they fit."""
        smoothing, order = self.search.walker.smoothing, self.search.order
        search = OrderSearch(problem, order, smoothing, Effort(), None)
        at, mesh = self.result.trajectory, self.result.collocation.mesh
        start = replace(Start.at(at), shared={})  # where the problem has it
        alike = len(search.phased.shared) == len(self.search.phased.shared)
        barrier = 1e-6 if alike else 1e-4
        solver = Ipopt(1e-8, strategy="monotone", barrier_start=barrier, push=1e-5)
        before = self.result if alike else None
        return Stage(search, search._run("again", search.phased, mesh, start, solver, before))


@pytest.fixture(scope="module")
def bare(paper_gait_file: Path) -> Stage:
    return Stage(*recall(Solution.load(paper_gait_file)))


@pytest.fixture(scope="module")
def free(bare: Stage) -> Stage:
    """The stiffness of an elastic hip exosuit as a free number."""
    return bare.again(bare.search.problem.replace(devices=SUIT, design={PATH: WIDE}))


def test_the_best_stiffness_is_better_than_others(free: Stage) -> None:
    assert WIDE[0] < free.found.value < WIDE[1]
    assert free.found.low_price == free.found.high_price == 0.0
    for factor in (0.9, 1.1):
        other = free.again(held_at(free.search.problem, {PATH: factor * free.found.value}))
        assert other.least > free.least


def test_a_bound_costs_what_finding_the_gait_again_would(free: Stage) -> None:
    high = 0.7 * free.found.value
    moved = [
        free.again(with_bound(free.search.problem, f"design.{PATH}.high", factor * high))
        for factor in (0.98, 1.0, 1.02)
    ]
    less, here, more = moved
    assert here.found.value == pytest.approx(high, rel=1e-5)
    assert here.found.low_price == 0.0
    difference = (more.least - less.least) / (0.04 * high)
    assert here.found.high_price == pytest.approx(difference, rel=0.02)
    assert here.found.high_price < 0


def test_bounds_without_room_make_the_problem_without_free_numbers(free: Stage) -> None:
    """The same least objective, and the multiplier of the number held is its price."""
    value = 0.7 * free.found.value
    held = free.again(held_at(free.search.problem, {PATH: value}))
    given = held.search.problem.replace(design=Design())
    fixed = held.again(given)
    assert fixed.least == pytest.approx(held.least, rel=1e-6)
    slope = _Optimum(fixed.search, fixed.result).slope(PATH, value)
    assert held.found.high_price == pytest.approx(slope, rel=1e-3)


def test_designs_that_do_not_go_together_are_told_in_one_line(bare: Stage) -> None:
    problem = bare.search.problem.replace(devices=SUIT, design={PATH: WIDE})
    other = problem.replace(design={PATH: (0.0, 500.0)})
    for problems, weights, words in (
        ([], None, "names no operating point"),
        ([problem.replace(design={})], None, "design: nothing is free; give bounds"),
        ([problem, other], None, "differs between the operating points"),
        ([problem], [1.0, 2.0], "weights = .*: must be positive, one for each problem"),
        ([problem], [0.0], "weights = .*: must be positive"),
    ):
        with pytest.raises(ProblemError, match=words) as told:
            design(problems, weights)
        assert "\n" not in str(told.value)


def test_splines_do_not_know_free_numbers(bare: Stage) -> None:
    problem = bare.search.problem.replace(design={"body.foot_mass_kg": (1.0, 2.0)})
    with pytest.raises(ProblemError, match="design = .*method 'spline' holds body and devices"):
        solve(problem, method="spline")
