"""Many starts: what is refused, and how gaits are told apart."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ergowalk.errors import ProblemError
from ergowalk.problem import preset
from ergowalk.solution import Solution
from ergowalk.solving.starts import catalogued, solve_from_starts

PROBLEM = preset("berbyuk2002-rhythm")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"starts": 0}, "starts = 0: must lie between 1 and 10000; give a whole number"),
        ({"starts": 2, "seed": -1}, "seed = -1: must lie between 0"),
        ({"starts": 2, "workers": 0}, "workers = 0: must lie between 1"),
    ],
)
def test_numbers_that_make_no_sense_are_refused(given: dict[str, int], words: str) -> None:
    with pytest.raises(ProblemError, match=words):
        solve_from_starts(PROBLEM, **given)


@pytest.fixture(scope="module")
def gait(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


def varied(gait: Solution, energy: float, bend_deg: float = 0.0, acceptable: int = 1) -> Solution:
    """The gait with another E and its joint angles bent."""
    angle = gait.dataset["joint_angle"] + np.radians(bend_deg)
    data = gait.dataset.assign(joint_angle=angle)
    return Solution(data.assign_attrs(energy_per_metre=energy, acceptable=acceptable))


def test_gaits_are_one_optimum_when_their_curves_are(gait: Solution) -> None:
    gaits = [
        varied(gait, 57.0),
        varied(gait, 56.0, bend_deg=3.0),
        varied(gait, 57.1, bend_deg=0.5),
        varied(gait, 50.0, acceptable=0),
        varied(gait, 57.2),
    ]
    found = catalogued(gaits, seed=7)
    assert (found.starts, found.seed, found.accepted) == (5, 7, 4)
    assert [optimum.energy_per_metre for optimum in found.optima] == [56.0, 57.0]
    assert [optimum.hits for optimum in found.optima] == [1, 3]
    assert [optimum.best_start for optimum in found.optima] == [1, 0]
    assert found.optima[0].distance_deg == 0.0
    assert found.optima[1].distance_deg == pytest.approx(3.0)


def test_equal_energies_of_different_curves_are_two_optima(gait: Solution) -> None:
    found = catalogued([varied(gait, 57.0), varied(gait, 57.0, bend_deg=2.0)])
    assert [optimum.hits for optimum in found.optima] == [1, 1]


def test_nothing_accepted_is_an_empty_catalogue(gait: Solution) -> None:
    found = catalogued([varied(gait, 57.0, acceptable=0)])
    assert found.optima == ()
    assert json.loads(found.as_json())["accepted"] == 0
