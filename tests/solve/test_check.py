"""When a gait takes over what a finer mesh changed in its neighbour."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import pytest
import xarray as xr

from ergowalk.problem import GaitProblem, Objective, preset
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.solving.candidate import Candidate
from ergowalk.solving.check import NEIGHBOUR, MeshCheck
from ergowalk.solving.collocation import check_of


def checked(gait: Solution, *, acceptable: bool = True, **finer: float) -> Solution:
    """The gait on 60 elements, checked on 75, where E was 0.3 % lower."""
    energy = gait.energy_per_metre
    history = [
        {"elements": 50, "energy_per_metre": 1.02 * energy},
        {"elements": 60, "energy_per_metre": energy, "final": True},
        {"elements": 75, "energy_per_metre": 0.997 * energy, "finer": True} | finer,
    ]
    attributes = {"mesh_history": json.dumps(history), "acceptable": int(acceptable)}
    return Solution(gait.dataset.assign_attrs(attributes))


@pytest.fixture(scope="module")
def gait() -> Solution:
    """A gait of which nothing but its record is known."""
    meshes = json.dumps([{"elements": 60, "energy_per_metre": 48.0, "final": True}])
    record = {"energy_per_metre": 48.0, "acceptable": 1, "mesh_history": meshes}
    return Solution(xr.Dataset(attrs=record))


def test_a_check_is_what_the_finer_mesh_changed(gait: Solution) -> None:
    check = MeshCheck.of(checked(gait))
    assert check is not None
    assert check.change == pytest.approx(-0.003, rel=1e-9)
    assert (check.energy, check.finer) == (gait.energy_per_metre, 75)
    assert check.record(50.0)["energy_per_metre"] == pytest.approx(49.85, rel=1e-12)
    assert "E = 50.00 J/m on 60 elements; the check, -0.30 % on 75" in check.words(50.0, 60)


def test_a_check_holds_near_by_and_on_meshes_coarser_than_its_own(gait: Solution) -> None:
    check = MeshCheck.of(checked(gait))
    assert check is not None
    energy = gait.energy_per_metre
    for share, elements, holds in (
        (0.9 * NEIGHBOUR, 60, True),
        (-0.9 * NEIGHBOUR, 74, True),
        (1.1 * NEIGHBOUR, 60, False),
        (-1.1 * NEIGHBOUR, 60, False),
        (0.0, 75, False),
    ):
        assert check.holds_for(energy * (1 + share), elements) is holds


def test_a_check_taken_over_twice_still_belongs_to_the_gait_that_was_checked(
    gait: Solution,
) -> None:
    """Otherwise a long path would carry it anywhere in steps that are each small enough."""
    energy = gait.energy_per_metre
    check = MeshCheck.of(checked(gait, carried_from=0.9 * energy))
    assert check is not None
    assert check.energy == 0.9 * energy
    assert check.holds_for(1.02 * energy, 60)
    assert not check.holds_for(1.04 * energy, 60)


def test_a_gait_that_is_not_acceptable_or_was_not_checked_has_no_check(gait: Solution) -> None:
    assert MeshCheck.of(checked(gait, acceptable=False)) is None
    assert MeshCheck.of(gait) is None


def continued(problem: GaitProblem, continued: bool = True) -> Any:
    """A stage that continued another, as far as its check needs it."""
    return Candidate(SimpleNamespace(problem=problem), SimpleNamespace(), continued)  # type: ignore[arg-type]


def test_a_check_is_taken_over_for_the_same_objective_on_the_same_mesh_alone(
    gait: Solution,
) -> None:
    problem = preset("berbyuk2002")
    start = checked(gait)
    start = Solution(start.dataset.assign_attrs(problem=problem_to_toml(problem)))
    longer = problem.replace(step_length_m=0.77)
    assert check_of(start, continued(longer)) == MeshCheck.of(start)
    assert check_of(start, continued(longer, False)) is None
    squared = problem.replace(objective=Objective(moment_rate_squared_s3_per_m2=1e-3))
    assert check_of(start, continued(squared)) is None
    impulsive = preset("berbyuk2002-printed")
    assert check_of(start, continued(impulsive)) is None
