"""``fit``: a recorded walk becomes a problem, a table, measured curves, and a figure in J/m."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from ergowalk.problem.files import read_problem
from made_up_walk import csv_text, mot_text, recording, trc_text, walker

KNOWN = walker(duration=3.0)
WHOLE = recording(KNOWN, unit="mm")
GATK = Path(__file__).parents[1] / "measured" / "gatk_2d" / "rawdata.txt"


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    """A TRC and a MOT file of one walk."""
    (tmp_path / "walk.trc").write_text(trc_text(WHOLE))
    (tmp_path / "grf.mot").write_text(mot_text(WHOLE))
    return ["walk.trc", "grf.mot"]


def test_a_walk_becomes_a_problem_that_can_be_read(files: list[str], run: Any) -> None:
    answer = run("fit", *files, "--mass", 73.18, "-o", "mine")
    assert answer.status == 0
    assert answer.err == ""
    assert sorted(p.name for p in Path("mine").iterdir()) == [
        "corridors.csv",
        "measured.nc",
        "problem.toml",
    ]
    problem = read_problem("mine/problem.toml")
    assert problem.name == "walk"
    assert problem.stride_time_s == pytest.approx(1.14, abs=2e-3)
    assert problem.body.total_mass == pytest.approx(73.18, abs=1e-3)
    assert problem.body.leg(0).thigh_length == pytest.approx(0.47, abs=1e-3)
    low, high = problem.rhythm.bounds("toe_off")
    assert low < 0.62 < high
    assert set(problem.angle_corridors()) == {"hip", "knee", "ankle"}


def test_the_command_says_what_the_walk_spends(files: list[str], run: Any) -> None:
    answer = run("fit", *files, "--mass", 73.18, "-o", "mine")
    rows = dict(line.split("  ", 1) for line in answer.out.splitlines() if line[0] != " ")
    assert "J/m (hip" in rows["this walk spends"]
    assert "no toe marker, so without the metatarsal joint" in rows["this walk spends"]
    assert "low-pass 6 Hz" in rows["markers"]
    assert "at least 5 deg" in rows["corridors"]
    assert "R_y <=" in rows["limits"]


def test_json_has_the_same_figures(files: list[str], run: Any) -> None:
    found = json.loads(run("fit", *files, "--mass", 73.18, "-o", "mine", "--json").out)
    assert found["strides"] == found["strides_with_forces"] == 3
    stored = xr.load_dataset("mine/measured.nc")
    assert found["energy_per_metre"]["mean"] == pytest.approx(stored.energy_per_metre)
    assert sum(found["energy_by_joint"].values()) == pytest.approx(stored.energy_per_metre)
    assert found["rhythm"] == json.loads(stored.rhythm)


def test_measured_curves_are_compared_and_reported_as_measured(files: list[str], run: Any) -> None:
    run("fit", *files, "--mass", 73.18, "-o", "mine")
    compared = run("compare", "mine/measured.nc")
    assert compared.status == 0
    assert "J/m, measured" in compared.out
    assert "NOT ACCEPTABLE" not in compared.out
    assert "between people" not in compared.out
    reported = run("report", "mine/measured.nc")
    assert reported.status == 0, reported.err
    page = Path("mine/report.html").read_text("utf-8")
    assert "a person is no nine-link model" in page
    assert "Not acceptable:" not in page


def test_a_peak_above_the_cap_raises_it(tmp_path: Path, run: Any) -> None:
    (tmp_path / "hard.csv").write_text(csv_text(KNOWN))
    run("fit", "hard.csv", "--mass", 55, "-o", "mine")
    cap = read_problem("mine/problem.toml").limits.vertical_reaction_body_weights
    assert cap == 1.5  # 1.10 of 73.18 kg carried by 55 kg, up to the next 0.05


def test_with_solve_the_cheapest_walk_stands_beside_it(
    files: list[str], run: Any, solver: Any
) -> None:
    solver.attributes = {"solver_status": "converged"}
    answer = run("fit", *files, "--mass", 73.18, "-o", "mine", "--solve", "--quiet")
    assert answer.status == 0, answer.err
    assert "this walk spends" in answer.out
    assert "71.79 J/m in these corridors, accepted by the audit: converged" in answer.out
    assert (Path("mine") / "solved" / "gait.nc").exists()
    assert solver.calls[0].body == read_problem("mine/problem.toml").body


def test_with_solve_and_no_acceptable_walk_the_status_is_1_and_says_what_to_widen(
    files: list[str], run: Any, solver: Any
) -> None:
    solver.attributes = {"acceptable": 0, "solver_status": "not converged"}
    answer = run("fit", *files, "--mass", 73.18, "-o", "mine", "--solve", "--quiet")
    assert answer.status == 1
    assert "NOT ACCEPTABLE: not converged; a model with both hips" in answer.out
    assert "--sd-floor" in answer.out


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        (("none.trc",), "none.trc: cannot be read"),
        (("walk.trc", "--mass", -3), "mass_kg = -3.0: should be greater than 0"),
        (("walk.trc",), "has no force plates to weigh the person by; give --mass in kg"),
        (("walk.trc", "--mass", 70, "--cutoff", 0.1), "cutoff_hz = 0.1"),
        (("walk.trc", "--mass", 70, "--units", "m"), "which is no leg's"),
        (("grf.mot",), "no file has markers"),
        (("walk.trc", "grf.mot", "--flip-forces"), "the plate is upside down"),
        (("walk.trc", "--mass", 70, "--static", "none.trc"), "none.trc: cannot be read"),
    ],
)
def test_what_cannot_be_measured_is_one_line(
    files: list[str], run: Any, arguments: tuple[object, ...], match: str
) -> None:
    answer = run("fit", *arguments, "-o", "mine")
    assert answer.status == 2
    assert answer.out == ""
    assert match in answer.err
    assert answer.err.startswith("ergowalk: ")
    assert answer.err.count("\n") == 1
    assert not Path("mine").exists()


def test_somebody_elses_problem_file_is_not_replaced(files: list[str], run: Any) -> None:
    Path("mine").mkdir()
    Path("mine/problem.toml").write_text("precious")
    answer = run("fit", *files, "--mass", 73.18, "-o", "mine")
    assert answer.status == 2
    assert "would be replaced" in answer.err
    assert Path("mine/problem.toml").read_text() == "precious"


def test_what_fit_writes_solve_takes_and_the_audit_accepts(run: Any) -> None:
    """A real person on a real treadmill, nothing edited by hand; a real solve (25 s)."""
    answer = run("fit", GATK, "--mass", 67.2, "-o", "mine", "--solve", "--quiet", "--json")
    found = json.loads(answer.out)
    assert answer.status == 0, found["cheapest"]
    assert found["energy_per_metre"]["mean"] == pytest.approx(135.7, abs=1.0)
    assert found["cheapest"]["energy_per_metre"] < found["energy_per_metre"]["mean"] / 2
