"""Free numbers of a problem file: what may be free, and one line for what may not."""

from __future__ import annotations

import re
from typing import Any

import pytest

from ergowalk.errors import InputError, ProblemError
from ergowalk.problem import Design, GaitProblem, preset
from ergowalk.problem.design import (
    free_values,
    held_at,
    with_bound,
    with_symbols,
)
from ergowalk.problem.files import problem_from_toml, problem_to_toml

STIFFNESS, SHANK = "devices.ankle.stiffness_nm_per_rad", "body.shank_length_m"
EXO = preset("ankle-exoskeleton")
FREE = EXO.replace(design={STIFFNESS: (50.0, 600.0), SHANK: (0.50, 0.56)})


def test_a_problem_with_free_numbers_survives_its_file() -> None:
    text = problem_to_toml(FREE)
    assert f'"{STIFFNESS}" = [50.0, 600.0]' in text
    again = problem_from_toml(text)
    assert again == FREE
    assert problem_to_toml(again) == text


def test_without_free_numbers_a_file_says_nothing_of_them() -> None:
    assert "[design]" not in problem_to_toml(EXO)
    assert "free" not in EXO.conditions()


def test_paths_may_be_written_as_nested_tables() -> None:
    text = problem_to_toml(EXO) + f"\n[design]\n{STIFFNESS} = [50, 600]\n{SHANK} = [0.50, 0.56]\n"
    assert problem_from_toml(text) == FREE


def test_a_design_replaces_fields_and_keeps_the_bounds() -> None:
    found = FREE.with_design({STIFFNESS: 300.0, SHANK: 0.55})
    assert found.devices.ankle is not None
    assert found.devices.ankle.stiffness_nm_per_rad == 300.0
    assert found.body.shank_length_m == 0.55
    assert found.design == FREE.design
    assert free_values(found) == {STIFFNESS: 300.0, SHANK: 0.55}


def test_held_numbers_have_no_room() -> None:
    held = held_at(FREE, {STIFFNESS: 300.0, SHANK: 0.55})
    assert free_values(held) == {STIFFNESS: 300.0, SHANK: 0.55}
    assert all(free.lowest == free.highest for free in held.design.free)


def test_a_bound_that_moves_past_a_number_takes_it_along() -> None:
    moved = with_bound(FREE, f"design.{STIFFNESS}.low", 200.0)
    assert free_values(moved)[STIFFNESS] == 200.0
    assert moved.design.free[0].lowest == 200.0


def test_one_of_a_pair_of_numbers_may_be_free() -> None:
    body = EXO.body.replace(foot_mass_kg=(1.24, 1.24))
    problem = EXO.replace(body=body, design={"body.foot_mass_kg.2": (1.24, 1.24)})
    changed = with_symbols(problem, {"body.foot_mass_kg.2": 2.24})
    assert changed.body.foot_mass_kg == (1.24, 2.24)


@pytest.mark.parametrize(
    ("design", "words"),
    [
        (
            {"devices.ankle.stifness_nm_per_rad": [1, 2]},
            r"no such number .* nearest are " + STIFFNESS,
        ),
        ({"devices.knee.stiffness_nm_per_rad": [1, 2]}, "no such number"),
        ({"body.gravity_m_s2": [9.0, 10.0]}, "no such number of its body or its devices"),
        ({"step_length_m": [0.7, 0.8]}, "no such number of its body or its devices"),
        ({"devices.ankle.kind": [1, 2]}, "no such number"),
        ({STIFFNESS: [600.0, 50.0]}, r"\[600.0, 50.0\]: the lowest value comes first"),
        ({STIFFNESS: 180.0}, "= 180.0: should be a pair of numbers; give the lowest"),
        ({STIFFNESS: [50.0]}, "should be a pair of numbers"),
        ({STIFFNESS: ["a", "b"]}, "should be a pair of numbers"),
        ({STIFFNESS: [50.0, float("inf")]}, "should be a pair of numbers"),
        ({STIFFNESS: [200.0, 600.0]}, "own value, 180, which lies outside; move devices"),
        ({"devices.ankle.damping_nms_per_rad": [0.0, 5.0]}, "'spring' has no damping; narrow"),
        ({"body.heel_to_metatarsal_m": [0.02, 0.3]}, "the foot triangle cannot close"),
        ({"body.shank_inertia_kgm2": [1e-4, 0.2]}, "mass matrix is not positive definite"),
        ({"body.shank_length_m": [0.05, 0.6], "body.thigh_length_m": [0.05, 0.6]}, "with body"),
        (3, "should be a table"),
    ],
)
def test_what_cannot_be_free_is_told_in_one_line(design: Any, words: str) -> None:
    with pytest.raises(InputError, match=words) as told:
        EXO.replace(step_length_m=1.1, design=design)
    assert "\n" not in str(told.value)
    assert str(told.value).startswith("design")


def test_a_pair_is_told_to_be_one() -> None:
    body = EXO.body.replace(foot_mass_kg=(1.24, 1.24))
    with pytest.raises(
        ProblemError, match=r"is a pair.*body.foot_mass_kg.1 or body.foot_mass_kg.2"
    ):
        EXO.replace(body=body, design={"body.foot_mass_kg": (1.0, 2.0)})


def test_a_damper_that_moves_the_swinging_foot_may_not_vanish() -> None:
    ankle = EXO.devices.ankle
    assert ankle is not None
    foot = ankle.replace(kind="parallel", own_moment=False, damping_nms_per_rad=5.0)
    devices = EXO.devices.replace(ankle=foot)
    path = "devices.ankle.damping_nms_per_rad"
    with pytest.raises(ProblemError, match="must be above 0: .*swinging foot"):
        EXO.replace(devices=devices, design={path: (0.0, 10.0)})
    assert EXO.replace(devices=devices, design={path: (0.1, 10.0)}).design


def test_many_free_numbers_are_checked_in_time() -> None:
    """Corners grow as powers of two: of many numbers each bound is looked at by itself."""
    body = {name: getattr(EXO.body, name) for name in type(EXO.body).model_fields}
    bounds = {
        f"body.{name}": (value, 1.01 * value)
        for name, value in body.items()
        if name.endswith(("_length_m", "inertia_kgm2")) or name.startswith("heel")
    }
    many = Design(
        **{**bounds, STIFFNESS: (100.0, 200.0), "devices.ankle.rest_angle_deg": (-1.0, 1.0)}
    )
    assert len(many.free) > 8
    problem: GaitProblem = EXO.replace(design=many)
    assert re.search("free: .*heel_to_ankle_m", problem.conditions())
