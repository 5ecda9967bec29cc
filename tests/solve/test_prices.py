"""Prices from the multipliers are what finding the gait again would cost."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from ergowalk.errors import GaitFileError
from ergowalk.problem import GaitProblem
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving.memory import recall, recall_for
from ergowalk.solving.prices import Prices, changed, given_numbers, prices
from ergowalk.solving.stages import Effort, OrderSearch, StageResult, Start


@dataclass(frozen=True)
class Priced:
    gait: Solution
    search: OrderSearch
    result: StageResult
    found: Prices

    def slope(self, name: str) -> float:
        (price,) = (p for p in self.found.numbers if p.name == name)
        return price.slope

    def again(self, problem: GaitProblem) -> float:
        """Least objective [J/m] of another problem on the same mesh."""
        search = OrderSearch(
            problem, self.search.orders, self.search.walker.smoothing, Effort(), None
        )
        before = self.result
        solver = Ipopt(tolerance=1e-8, strategy="monotone", barrier_start=1e-7, push=1e-5)
        start = Start.at(before.trajectory)
        mesh = before.collocation.mesh
        after = search._run("again", search.phased, mesh, start, solver, before)
        assert after.minimum.converged
        least: float = energy_per_metre(
            after.minimum.objective * problem.body.total_mass, problem.step_length_m
        )
        return least


@pytest.fixture(scope="module")
def priced(paper_gait_file: Path) -> Priced:
    gait = Solution.load(paper_gait_file)
    return Priced(gait, *recall(gait), prices(gait))


def test_a_stored_gait_remembers_its_point(priced: Priced) -> None:
    """The curves that the stored point stands for are those of the file, and it is a solution."""
    programme, x = priced.result.collocation.programme, priced.result.minimum.x
    cost, rows = programme.evaluate(x)
    assert cost == pytest.approx(priced.result.minimum.objective, rel=1e-9)
    assert max(programme.violations(x, rows).values()) < 1e-6
    trunk = priced.gait.dataset["trunk_angle"].to_numpy()
    assert priced.result.trajectory.phases[0].values[0, 0] == pytest.approx(trunk[0], abs=1e-12)


@pytest.mark.parametrize(
    ("name", "step"),
    [("step_length_m", 5e-4), ("limits.vertical_reaction_body_weights", 2e-3)],
)
def test_a_price_is_the_derivative_of_the_least_objective(
    priced: Priced, name: str, step: float
) -> None:
    value = dict(given_numbers(priced.gait.problem))[name]
    low, high = (priced.again(changed(priced.gait.problem, name, value + h)) for h in (-step, step))
    assert priced.slope(name) == pytest.approx((high - low) / (2 * step), rel=0.01)


def test_what_only_restricts_never_costs_less(priced: Priced) -> None:
    for name in (
        "corridors.width_sd",
        "limits.vertical_reaction_body_weights",
        "limits.friction_coefficient",
        "limits.moment_rate_nm_per_kg_s.hip",
        "limits.moment_rate_nm_per_kg_s.knee",
        "limits.moment_rate_nm_per_kg_s.ankle",
    ):
        assert priced.slope(name) < 1e-3


def test_corridor_edges_add_up_to_the_price_of_the_width(priced: Priced) -> None:
    """Wider by a share of itself: every edge moves by its own standard deviation."""
    corridors, problem = priced.found.corridors, priced.gait.problem
    total = 0.0
    for joint, corridor in problem.angle_corridors().items():
        degrees = np.degrees(corridor.sd(corridors.fraction))
        both = corridors.lower[joint] + corridors.upper[joint]
        total += float(np.sum(both * degrees * corridors.width) * 100)
    assert total == pytest.approx(-priced.slope("corridors.width_sd"), rel=0.03)


def test_the_stride_of_a_leg_is_covered_once(priced: Priced) -> None:
    corridors = priced.found.corridors
    assert np.sum(corridors.width) == pytest.approx(1.0)
    assert np.all(np.diff(corridors.fraction) > 0)
    for joint in corridors.lower:
        assert np.all(corridors.lower[joint] >= 0)
        assert np.all(corridors.upper[joint] >= 0)


def test_the_dearest_comes_first(priced: Priced) -> None:
    sizes = [abs(price.elasticity) for price in priced.found.numbers]
    assert sizes == sorted(sizes, reverse=True)
    names = {price.name for price in priced.found.numbers}
    assert {"step_length_m", "stride_time_s", "body.trunk_mass_kg"} <= names


def test_a_gait_without_multipliers_is_refused(priced: Priced) -> None:
    bare = Solution(priced.gait.dataset.drop_vars("nlp_row_multiplier"))
    with pytest.raises(GaitFileError, match="keeps no multipliers; solve it by collocation"):
        prices(bare)


def test_multipliers_of_another_problem_are_refused(priced: Priced) -> None:
    data = priced.gait.dataset
    fewer = data.isel(nlp_rows=slice(0, 100))
    with pytest.raises(GaitFileError, match="= 100: the multipliers do not belong"):
        prices(Solution(fewer))


def test_a_stage_is_recalled_for_a_problem_with_the_same_rows_only(priced: Priced) -> None:
    problem, orders = priced.gait.problem, priced.search.orders
    smoothing = priced.search.walker.smoothing

    def recalled(other: GaitProblem, points: int = 3) -> StageResult | None:
        return recall_for(
            priced.gait, OrderSearch(other, orders, smoothing, Effort(), None), points
        )

    moved = recalled(problem.replace(step_length_m=0.77))
    assert moved is not None
    assert moved.collocation.signature == priced.result.collocation.signature
    assert np.array_equal(moved.minimum.x, priced.result.minimum.x)
    assert recalled(problem, points=2) is None
    without = problem.limits.replace(friction_coefficient="off")
    assert recalled(problem.replace(limits=without)) is None
