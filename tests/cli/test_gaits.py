"""``ergowalk audit`` and ``ergowalk compare`` on stored gaits."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import ergowalk
from ergowalk.comparison import compare
from ergowalk.problem import Corridors
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution

SLOW_TABLE = Path(ergowalk.__file__).parent / "data/winter1991/slow.csv"


def test_an_accepted_gait_is_status_0_with_its_table(run, stored, gait, audit_report):
    stored["gait.nc"] = gait
    answer = run("audit", "gait.nc")
    assert (answer.status, answer.err) == (0, "")
    assert answer.out == f"gait.nc: the solver found an optimum\n{audit_report().table()}\n"


def test_a_gait_that_fails_is_status_1(run, stored, gait, auditor, audit_report):
    auditor.answer = audit_report(accepted=False)
    stored["gait.nc"] = gait
    answer = run("audit", "gait.nc")
    assert answer.status == 1
    assert "1 of 2 lines fail" in answer.out


def test_an_audit_as_json_is_the_same_table(run, stored, gait, audit_report):
    stored["gait.nc"] = gait
    found = json.loads(run("audit", "gait.nc", "--json").out)
    assert found == {"file": "gait.nc", **audit_report().as_dict()}


@pytest.mark.parametrize("command", ["audit", "compare"])
def test_a_stored_problem_names_its_table_from_the_folder_of_the_gait(
    run, stored, gait, auditor, command, tmp_path
):
    (tmp_path / "result").mkdir()
    (tmp_path / "result/mine.csv").write_bytes(SLOW_TABLE.read_bytes())
    problem = gait.problem.replace(corridors=Corridors(source="mine.csv"))
    stored["gait.nc"] = Solution(gait.dataset.assign_attrs(problem=problem_to_toml(problem)))
    answer = run(command, "result/gait.nc")
    assert (answer.status, answer.err) == (0, "")
    if command == "audit":
        assert auditor.folders == [tmp_path / "result"]
    else:
        assert "leg 1 against mine.csv" in answer.out


def test_a_lost_table_is_told_with_the_gait_that_needs_it(run, stored, gait):
    problem = gait.problem.replace(corridors=Corridors(source="lost.csv"))
    stored["gait.nc"] = Solution(gait.dataset.assign_attrs(problem=problem_to_toml(problem)))
    answer = run("compare", "gait.nc")
    assert answer.status == 2
    assert answer.err.startswith("ergowalk: gait.nc: corridors.source = 'lost.csv': cannot be read")


@pytest.mark.parametrize("command", ["audit", "compare"])
def test_a_gait_without_verdict_and_status_can_be_looked_at(run, stored, gait, command):
    for name in ("acceptable", "solver_status"):
        del gait.dataset.attrs[name]
    stored["gait.nc"] = gait
    assert run(command, "gait.nc").status == 0


def test_each_gait_is_compared_with_the_data_of_its_problem(run, stored, gait):
    stored["gait.nc"] = gait
    answer = run("compare", "gait.nc")
    limits = gait.problem.limits.sentence()
    table = compare(gait.dataset, gait.problem.human()).table()
    assert (answer.status, answer.err) == (0, "")
    assert answer.out == f"gait.nc: E = 71.79 J/m with {limits}\n{table}\n"


def test_a_gait_that_is_not_acceptable_is_compared_and_marked(run, stored, gait):
    gait.dataset.attrs["acceptable"] = 0
    stored["gait.nc"] = gait
    answer = run("compare", "gait.nc")
    assert answer.status == 0
    assert answer.out.startswith("gait.nc (NOT ACCEPTABLE): E = 71.79 J/m")


def test_several_gaits_are_one_json_object(run, stored, gait):
    stored["a.nc"] = stored["b.nc"] = gait
    found = json.loads(run("compare", "a.nc", "b.nc", "--json").out)["gaits"]
    assert [entry["file"] for entry in found] == ["a.nc", "b.nc"]
    assert found[0]["acceptable"] is True
    assert found[1]["signals"]["knee_angle"]["inside_1sd"] == pytest.approx(1.0)


def test_one_bad_file_among_several_prints_nothing(run, stored, gait):
    stored["a.nc"] = gait
    answer = run("compare", "a.nc", "b.nc")
    assert (answer.status, answer.out) == (2, "")
    assert answer.err == "ergowalk: b.nc: not a gait; give another\n"
