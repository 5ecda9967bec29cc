"""Gaits in which both halves of the stride are solved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ergowalk.problem.files import problem_to_toml
from ergowalk.problem.legs import Stride
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving import solve
from ergowalk.solving.memory import recall
from ergowalk.solving.prices import price_of
from ergowalk.solving.stages import Effort, OrderSearch, Start


@pytest.fixture(scope="module")
def mirrored(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


@pytest.fixture(scope="module")
def heavier(mirrored: Solution) -> Solution:
    """Half a kilogram more at the foot of leg 2."""
    problem = mirrored.problem
    body = problem.body.replace(foot_mass_kg=(1.24, 1.74))
    return solve(problem.replace(body=body), start=mirrored)


def test_equal_legs_walk_the_same_whether_mirrored_or_each(mirrored: Solution) -> None:
    each = mirrored.problem.replace(stride=Stride(legs="each"))
    both = solve(each, start=mirrored)
    assert both.acceptable, both.status
    assert both.energy_per_metre == pytest.approx(mirrored.energy_per_metre, rel=0.002)
    assert both.step_lengths == pytest.approx((0.76, 0.76), abs=1e-4)
    assert both.step_times == pytest.approx((0.57, 0.57), abs=1e-4)
    grid = np.linspace(0.0, 1.14, 401)
    for name in ("segment_angle", "joint_angle"):
        one, two = (
            np.stack([np.interp(grid, g.dataset["time"], column) for column in columns.T])
            for g in (mirrored, both)
            for columns in [g.dataset[name].to_numpy().reshape(g.dataset.sizes["time"], -1)]
        )
        rms = np.degrees(np.sqrt(np.mean((one - two) ** 2, axis=1)))
        assert rms.max() < 0.1, name


def test_a_heavier_foot_is_dearer_and_the_legs_differ(
    heavier: Solution, mirrored: Solution
) -> None:
    """The audit accepts it; step 2, of the heavier foot, is the longer one in this gait."""
    assert heavier.acceptable, heavier.status
    assert heavier.energy_per_metre > 1.01 * mirrored.energy_per_metre
    first, second = heavier.step_lengths
    assert first + second == pytest.approx(2 * 0.76, abs=1e-9)
    assert abs(first - second) > 1e-4
    one, two = heavier.energy_by_leg
    assert sum(one.values()) + sum(two.values()) == pytest.approx(heavier.energy_per_metre)
    assert one != pytest.approx(two, rel=0.01)


def test_a_gait_of_both_legs_is_stored_and_read_whole(heavier: Solution, tmp_path: Path) -> None:
    again = Solution.load(heavier.save(tmp_path / "gait.nc"))
    assert again.full_stride
    assert again.rhythms == heavier.rhythms
    assert again.step_lengths == heavier.step_lengths
    assert sum(again.step_times) == pytest.approx(1.14)
    assert problem_to_toml(again.problem) == problem_to_toml(heavier.problem)
    assert again.audit().accepted


def test_the_price_of_one_leg_is_that_of_gaits_solved_again(heavier: Solution) -> None:
    """Of the objective on the same mesh, by the mass of foot 2, against a central difference."""
    search, before = recall(heavier)
    solver = Ipopt(tolerance=1e-8, strategy="monotone", barrier_start=1e-7, push=1e-5)

    def least(mass: float) -> float:
        body = heavier.problem.body.replace(foot_mass_kg=(1.24, mass))
        problem = heavier.problem.replace(body=body)
        here = OrderSearch(problem, search.orders, search.walker.smoothing, Effort(), None)
        start = Start.at(before.trajectory)
        after = here.stage("again", before.collocation.mesh, start, solver, before)
        assert after.minimum.converged
        return after.energy_at_nodes

    slope = (least(1.745) - least(1.735)) / 0.01
    assert price_of(heavier, "body.foot_mass_kg.2") == pytest.approx(slope, rel=0.02)
