"""A search that finds no feasible gait says which constraints press against each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from ergowalk.solving.verdict import conflict, moved


@dataclass
class Part:
    """Whatever attributes a test wants to be there."""

    labels: tuple[str, ...] = ()
    violation: float = 0.0
    message: str = "no point satisfies all constraints near where it looked"
    row_multipliers: Any = None
    programme: Any = None
    collocation: Any = None
    minimum: Any = None


def ended(violation: float, **multipliers: float) -> Any:
    """A stage that ended with a violation and a multiplier for each row."""
    labels = tuple(name.replace("_", " ") for name in multipliers)
    programme = Part(labels=labels)
    minimum = Part(violation=violation, row_multipliers=np.array(list(multipliers.values())))
    return Part(collocation=Part(programme=programme), minimum=minimum)


def test_constraints_are_named_by_how_hard_they_press() -> None:
    stage = ended(0.2, continuity=900.0, lock=-17.0, friction=2.0, clearance=400.0)
    assert conflict(stage) == "; in conflict: clearance, lock, friction"


def test_corridors_of_both_legs_are_one_constraint() -> None:
    stage = ended(0.2, lock=17.0)
    stage.collocation.programme.labels = ("lock", "corridor hip 1 (6)", "corridor hip 2 (6)")
    stage.minimum.row_multipliers = np.array([17.0, -9.0, 10.0])
    assert conflict(stage) == "; in conflict: corridor hip (6), lock"


def test_of_many_the_strongest_are_named() -> None:
    stage = ended(1.0, **{name: 10.0 - i for i, name in enumerate("abcdefg")})
    assert conflict(stage) == "; in conflict: a, b, c, d, e and others"


def test_a_search_that_only_ran_out_of_iterations_is_in_no_conflict() -> None:
    assert conflict(ended(1e-6, lock=5.0)) == ""
    stage = ended(0.2, lock=5.0)
    stage.minimum.message = "ran out of iterations"
    assert conflict(stage) == ""


def test_meshes_differ_by_e_and_by_the_objective() -> None:
    before = {"energy_per_metre": 50.0}
    assert moved(before, {"energy_per_metre": 49.0}) == pytest.approx(0.02)
    before["objective_per_metre"] = 10.0
    check = {"energy_per_metre": 50.0, "objective_per_metre": 10.3}
    assert moved(before, check) == pytest.approx(0.03)
