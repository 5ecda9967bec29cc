"""``ergowalk design``, and what ``ergowalk solve`` says of numbers that it found."""

from __future__ import annotations

import importlib
import json
import re
from pathlib import Path

import pytest

from ergowalk.problem import preset
from ergowalk.problem.design import held_at
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.solving import CommonDesign
from ergowalk.solving.common_design import OperatingPoint
from ergowalk.solving.design_prices import Found

from .conftest import human_dataset

PATH = "devices.ankle.stiffness_nm_per_rad"
FILE = f"""
name = "ankle"
preset = "ankle-exoskeleton"
[design]
"{PATH}" = [50.0, 600.0]
[[point]]
step_length_m = 0.76
stride_time_s = 1.14
weight = 3.0
[[point]]
step_length_m = 0.70
stride_time_s = 1.20
"""


@pytest.fixture
def designer(monkeypatch, auditor) -> list[tuple]:
    """The search replaced by one that knows the answer: 600 N m/rad, the highest allowed."""
    calls: list[tuple] = []

    def design(problems, weights=None, *, progress=None):
        calls.append((problems, weights))
        points = []
        for problem, weight in zip(problems, (0.75, 0.25), strict=True):
            held = held_at(problem, {PATH: 600.0})
            own = json.dumps([vars(Found(PATH, 580.0, 50.0, 600.0, 0.0, 0.0))])
            alone = Solution(human_dataset(problem).assign_attrs(design=own))
            points.append(OperatingPoint(weight, alone, Solution(human_dataset(held))))
        found = (Found(PATH, 600.0, 50.0, 600.0, 0.0, -0.0123),)
        return CommonDesign(found, tuple(points), True, "converged: 2 gaits with one design")

    monkeypatch.setattr(importlib.import_module("ergowalk.solving"), "design", design)
    return calls


def test_a_design_writes_a_gait_for_each_point_and_says_what_was_found(run, designer):
    Path("d.toml").write_text(FILE)
    answer = run("design", "d.toml", "-o", "out", "--quiet")
    assert answer.status == 0
    ((problems, weights),) = designer
    assert [p.step_length_m for p in problems] == [0.76, 0.70]
    assert weights == (3.0, 1.0)
    assert sorted(p.name for p in Path("out").iterdir()) == ["point-1.nc", "point-2.nc"]
    assert f"{PATH} = 600, free from 50 to 600 (the highest allowed, -0.0123 J/m per" in answer.out
    assert "status  acceptable: converged: 2 gaits with one design" in answer.out
    told = json.loads(run("design", "d.toml", "-o", "out", "--json").out)
    assert told["design"][0]["high_price"] == -0.0123
    assert [p["weight"] for p in told["points"]] == [0.75, 0.25]
    assert told["points"][0]["alone"] == {PATH: 580.0}


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[design]", "[desing]", "desing.*unknown key|unknown key.*desing|design: nothing is free"),
        ("[50.0, 600.0]", "[600.0, 50.0]", "the lowest value comes first"),
        ("0.70", "-0.70", r"point.*step_length_m = -0.7: should be greater than 0"),
        ("weight = 3.0", "weight = 'a'", "weight = 'a': should be a valid number"),
        (
            "0.70\nstride_time_s = 1.20",
            "0.76\nstride_time_s = 1.14",
            "stands twice; add its weight",
        ),
        ('"ankle-exoskeleton"', '"none"', "preset = 'none': no such preset"),
        ("[[point]]", "[[points]]", "points: unknown key; did you mean 'point'"),
        ("preset =", "problem = 'p.toml'\npreset =", "contradicts preset; give one of them"),
        ("[design]", "base = 3\n[design]", "base: unknown key"),
        ("[design]", "[design", "not valid TOML"),
    ],
)
def test_a_design_file_that_makes_no_sense_is_told_in_one_line(run, designer, old, new, words):
    Path("d.toml").write_text(FILE.replace(old, new))
    answer = run("design", "d.toml", "-o", "out")
    assert (answer.status, answer.out) == (2, "")
    (line,) = answer.err.splitlines()
    assert line.startswith("ergowalk: d.toml: ")
    assert re.search(words, line), line
    assert not Path("out").exists()


def test_a_missing_design_file_is_told(run, designer):
    answer = run("design", "none.toml")
    assert answer.status == 2
    assert "none.toml: cannot be read (No such file" in answer.err


def test_solve_stores_and_tells_what_it_found(run, solver):
    """The file asks, the result answers: its problem has the numbers that were found."""
    asked = preset("ankle-exoskeleton").replace(design={PATH: (50.0, 600.0)})
    Path("p.toml").write_text(problem_to_toml(asked))
    answered = asked.with_design({PATH: 432.0})
    found = vars(Found(PATH, 432.0, 50.0, 600.0, 0.0, 0.0))
    solver.attributes = {"problem": problem_to_toml(answered), "design": json.dumps([found])}
    answer = run("solve", "p.toml", "--no-figures", "-o", "out")
    assert [problem_to_toml(p) for p in solver.calls] == [problem_to_toml(asked)]
    assert Path("out/problem.toml").read_text("utf-8") == problem_to_toml(answered)
    assert (
        f"design             {PATH} = 432, free from 50 to 600 (no bound is active)" in answer.out
    )
    told = json.loads(run("solve", "p.toml", "--no-figures", "-o", "out", "--json").out)
    assert told["design"] == [found]
