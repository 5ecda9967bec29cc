"""``ergowalk solve --method spline``: choices, files, the paper's statements beside the gait."""

from __future__ import annotations

import importlib
import json
from dataclasses import replace
from pathlib import Path

import pytest

from ergowalk.cli.paper import beside_paper
from ergowalk.comparison import compare, human_of
from ergowalk.problem import preset
from ergowalk.solution import Solution
from ergowalk.solving import SplineOptions

SPLINE = {
    "method": "spline",
    "solver": "rosenbrock",
    "knots": 12,
    "rho": 1e-6,
    "asked": "paper",
    "step_length": 0.76,
    "stride_time": 1.14,
}


@pytest.mark.parametrize(
    ("arguments", "choices"),
    [
        ([], {"method": "collocation", "solver": "ipopt"}),
        (
            ["--method", "spline"],
            {"method": "spline", "solver": "ipopt", "spline": SplineOptions()},
        ),
        (
            ["--method=spline", "--solver=rosenbrock", "--knots=20", "--rho=0", "--asked=paper"],
            {
                "method": "spline",
                "solver": "rosenbrock",
                "spline": SplineOptions(knots=20, rho=0.0, asked="paper"),
            },
        ),
    ],
)
def test_choices_reach_the_solver(run, solver, arguments, choices):
    assert run("solve", "--no-figures", *arguments).status == 0
    assert solver.choices == [choices]


def test_a_start_reaches_the_solver(run, solver, stored, gait):
    stored["old.nc"] = gait
    assert run("solve", "--no-figures", "--start", "old.nc", "-o", "out").status == 0
    (choices,) = solver.choices
    assert choices["start"] is gait


def test_the_table_says_what_e_depends_on(run, solver):
    solver.attributes = SPLINE
    lines = run("solve", "--no-figures").out.splitlines()
    rows = {label: text.strip() for label, text in (line.split("  ", 1) for line in lines)}
    assert rows["method"] == (
        "spline, rosenbrock, 12 knots, rho 1e-06 s^3, the paper's constraints"
    )
    assert rows["paper"] == (
        "E 71.8 J/m (printed 127 J/m); tau^h 0.078 T (printed 0.1 T); tau^m 0.233 T (printed "
        "0.23 T); tau^t 0.5 T (printed 0.5 T); tau^s 0.618 T (printed 0.58 T)"
    )


def test_the_report_sets_the_gait_beside_the_paper(run, solver):
    solver.attributes = SPLINE
    assert run("solve", "--no-figures", "-o", "out").status == 0
    report = Path("out/report.md").read_text("utf-8")
    section = report.split("## Beside the paper")[1].split("## Figures")[0]
    rows = [line.split(" | ") for line in section.splitlines() if line.startswith("| ")]
    assert [row[0].strip("| ") for row in rows[2:7]] == ["E", "tau^h", "tau^m", "tau^t", "tau^s"]
    energy, rhythm = rows[2], {row[0].strip("| "): row[3].strip(" |") for row in rows[3:7]}
    assert energy[1:3] == ["71.8 J/m", "127 J/m"]
    assert "l_h, knots and corridors are not given" in energy[3]
    assert rhythm["tau^t"] == ""
    assert rhythm["tau^s"] == "the problem bounds it otherwise"
    assert len(rows) == 2 + 5 + 8
    assert all("of the stride within 1 SD" in row[1] for row in rows[7:])
    for missing in ("l_h = |HM|", "rho and the number of knots", "width of the corridors"):
        assert missing in section


def test_json_has_the_same_statements(run, solver):
    solver.attributes = SPLINE
    found = json.loads(run("solve", "--no-figures", "--json", "-o", "out").out)["paper"]
    assert found[0]["what"] == "E"
    assert found[0]["printed"] == "127 J/m"
    assert len(found) == 5 + 8


def test_a_gait_that_the_paper_says_nothing_of_has_no_such_section(run, solver, gait):
    answer = run("solve", "--no-figures", "-o", "out")
    assert "\npaper " not in answer.out
    assert "Beside the paper" not in Path("out/report.md").read_text("utf-8")
    found = compare(gait.dataset, human_of(gait.dataset))
    assert beside_paper(gait.dataset.assign_attrs(SPLINE), found) is not None
    longer = gait.dataset.assign_attrs({**SPLINE, "step_length": 0.8})
    assert beside_paper(longer, found) is None


def test_a_real_solve_writes_everything_and_is_marked(run, monkeypatch):
    """Rosenbrock's method with few knots and few evaluations, everything else as it is."""
    home = importlib.import_module("ergowalk.solving")
    real = home.solve

    def hurried(problem, *, spline, **choices):
        return real(problem, spline=replace(spline, max_evaluations=300), **choices)

    monkeypatch.setattr(home, "solve", hurried)
    command = "solve --preset berbyuk2002-rhythm --method spline --solver rosenbrock --knots 4"
    answer = run(*command.split(), "--rho", "1e-5", "-o", "out")
    assert answer.status == 1
    assert "penalty, coarse" in answer.err
    assert "NOT ACCEPTABLE: ran out of evaluations: above its tolerance is" in answer.out
    written = {path.suffix for path in Path("out").iterdir()}
    assert {".nc", ".toml", ".md", ".png", ".svg"} <= written
    stored = Solution.load("out/gait.nc")
    assert stored.dataset.sizes["measure"] == 7
    assert stored.dataset.sizes["trace_point"] > 1
    assert stored.dataset.attrs["rho"] == 1e-5
    assert stored.problem.replace(folder=None) == preset("berbyuk2002-rhythm")
    assert not stored.acceptable
    assert not stored.audit().accepted
    assert run("compare", "out/gait.nc").status == 0
