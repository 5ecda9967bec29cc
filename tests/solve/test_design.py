"""Free numbers are found at their best, and their multipliers say what bounds cost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from ergowalk.errors import ProblemError
from ergowalk.problem import Device, Devices, GaitProblem, preset
from ergowalk.problem.design import Design, held_at, with_bound
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving import design, solve
from ergowalk.solving.design_prices import Found, found_design
from ergowalk.solving.memory import recall
from ergowalk.solving.multipliers import with_fixed_multipliers
from ergowalk.solving.prices import _Optimum
from ergowalk.solving.stages import Effort, OrderSearch, StageResult, Start
from ergowalk.solving.start import StartingGait
from ergowalk.transcription.walker import Smoothing

PRINTED = preset("berbyuk2002-rhythm")
PATH = "devices.hip.stiffness_below_nm_per_rad"
SUIT = Devices(hip=Device(kind="spring", stiffness_below_nm_per_rad=120.0))
WIDE = (30.0, 300.0)
HIGH = f"design.{PATH}.high"


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
        """Another problem on the same mesh, begun here, with the multipliers."""
        smoothing, orders = self.search.walker.smoothing, self.search.orders
        search = OrderSearch(problem, orders, smoothing, Effort(), None)
        start = replace(Start.at(self.result.trajectory), shared={})  # where the problem has it
        return Stage(search, solved(search, self.result, start, 1e-6, self.result))


def solved(
    search: OrderSearch, at: StageResult, start: Start, barrier: float, before: StageResult | None
) -> StageResult:
    solver = Ipopt(1e-8, strategy="monotone", barrier_start=barrier, push=1e-5)
    return search._run("again", search.phased, at.collocation.mesh, start, solver, before)


@pytest.fixture(scope="module")
def paper(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


@pytest.fixture(scope="module")
def free(paper: Solution) -> Stage:
    """The stiffness of an elastic hip exosuit as a free number."""
    _, stage = recall(paper)
    problem = paper.problem.replace(devices=SUIT, design={PATH: WIDE})
    search = OrderSearch(problem, (paper.rhythm.order,), Smoothing(), Effort(), None)
    begun = StartingGait(paper)
    start = Start(begun.guess(problem, search.halves), stage.trajectory.times)
    return Stage(search, solved(search, stage, start, 1e-3, None))


@pytest.fixture(scope="module")
def bounded(free: Stage) -> Stage:
    """The same where the best stiffness is not allowed."""
    return free.again(with_bound(free.search.problem, HIGH, 0.9 * free.found.value))


def test_the_best_stiffness_is_better_than_others(free: Stage, bounded: Stage) -> None:
    assert WIDE[0] < free.found.value < WIDE[1]
    assert free.found.low_price == free.found.high_price == 0.0
    stiffer = free.again(held_at(free.search.problem, {PATH: 1.1 * free.found.value}))
    assert stiffer.least > free.least
    assert bounded.least > free.least


def test_a_bound_costs_what_finding_the_gait_again_would(free: Stage, bounded: Stage) -> None:
    """The mean of the prices at two bounds is the slope between the two optima."""
    high = bounded.found.high
    assert bounded.found.value == pytest.approx(high, rel=1e-5)
    assert bounded.found.low_price == 0.0
    tighter = bounded.again(with_bound(bounded.search.problem, HIGH, 0.98 * high))
    slope = (bounded.least - tighter.least) / (0.02 * high)
    price = (bounded.found.high_price + tighter.found.high_price) / 2
    assert price == pytest.approx(slope, rel=0.02)
    assert price < 0


def test_a_number_held_is_a_number_given(bounded: Stage) -> None:
    """Bounds without room make the problem without free numbers, at the price of that number."""
    value = bounded.found.high
    held = bounded.again(held_at(bounded.search.problem, {PATH: value}))
    fixed = bounded.again(held.search.problem.replace(design=Design()))
    assert fixed.least == pytest.approx(held.least, rel=1e-7)
    slope = _Optimum(fixed.search, fixed.result).slope(PATH, value)
    assert held.found.high_price == pytest.approx(slope, rel=1e-3)


def test_designs_that_do_not_go_together_are_told_in_one_line() -> None:
    problem = PRINTED.replace(devices=SUIT, design={PATH: WIDE})
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


def test_splines_do_not_know_free_numbers() -> None:
    problem = PRINTED.replace(design={"body.foot_mass_kg": (1.0, 2.0)})
    with pytest.raises(ProblemError, match="design = .*method 'spline' holds body and devices"):
        solve(problem, method="spline")
