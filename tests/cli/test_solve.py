"""``ergowalk solve``: what it writes, prints and returns, whatever the solver says."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path

import pytest
import xarray as xr

import ergowalk
from ergowalk.errors import GaitFileError, ProblemError
from ergowalk.gait.rhythm import Rhythm
from ergowalk.problem import PRESETS, preset
from ergowalk.problem.files import problem_to_toml, read_problem

MINIMAL = "name = 'mine'\nstep_length_m = 0.7\nstride_time_s = 1.1\n"
SLOW_TABLE = Path(ergowalk.__file__).parent / "data/winter1991/slow.csv"


def entries(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_without_a_problem_the_case_of_the_paper_is_solved(run, solver, tmp_path):
    answer = run("solve", "--no-figures")
    assert answer.status == 0
    assert solver.calls == [preset("berbyuk2002")]
    assert entries(tmp_path / "ergowalk-berbyuk2002") == ["gait.nc", "problem.toml", "report.md"]


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_is_solved_by_name(run, solver, name):
    assert run("solve", "--preset", name, "--no-figures", "-o", "out").status == 0
    assert solver.calls == [preset(name)]


def test_the_problem_beside_the_gait_has_all_defaults_filled_in(run, solver, tmp_path):
    Path("p.toml").write_text(MINIMAL)
    assert run("solve", "p.toml", "--no-figures").status == 0
    folder = tmp_path / "ergowalk-mine"
    text = (folder / "problem.toml").read_text("utf-8")
    assert text == problem_to_toml(read_problem("p.toml"))
    with xr.open_dataset(folder / "gait.nc") as dataset:
        assert dataset.attrs["problem"] == text


def test_energy_never_stands_without_its_limits(run, solver):
    limits = preset("berbyuk2002").limits.sentence()
    answer = run("solve", "--no-figures", "-o", "out")
    assert f"71.79 J/m with {limits}" in answer.out
    escaped = limits.replace("|", "\\|")
    assert f"71.79 J/m with {escaped}" in Path("out/report.md").read_text("utf-8")
    found = json.loads(run("solve", "--no-figures", "-o", "out", "--json").out)
    assert (found["energy_per_metre"], found["limits"]) == (71.79, limits)


def test_the_table_says_what_was_found(run, solver):
    lines = run("solve", "--no-figures").out.splitlines()
    rows = {label: text.strip() for label, text in (line.split("  ", 1) for line in lines)}
    assert rows["problem"] == "berbyuk2002: step 0.76 m, stride 1.14 s, 1.33 m/s"
    assert rows["cost of transport"] == "0.1000 (E / M g)"
    assert rows["energy share"] == "hip 40%, knee 30%, ankle 20%, metatarsal 10%"
    assert rows["rhythm"] == (
        "foot flat 7.8 %, heel-off 23.3 %, toe tip 50.0 %, toe-off 61.8 % of the stride (free)"
    )
    assert rows["phase order"] == "flat-first (the better of both)"
    assert rows["peak R_y"] == "1.250 body weights"
    assert rows["method"] == "collocation"
    assert rows["effort"] == "123 iterations, 9.2 CPU s, 0.5 s to set up"
    assert rows["audit"] == "accepted, all 2 residuals within their tolerances"
    assert rows["status"] == "acceptable: the solver found an optimum"
    assert rows["files"] == "ergowalk-berbyuk2002: gait.nc, problem.toml, report.md"


@pytest.mark.parametrize(
    ("rhythm", "said"),
    [
        ("", "(free)"),
        ("heel_end = 0.1", "(free: heel-off, toe-off)"),
        ("heel_end = 0.1\nheel_off = 0.23\ntoe_off = [0.58, 0.58]", "(fixed)"),
    ],
)
def test_the_table_says_what_of_the_rhythm_was_free(run, solver, rhythm, said):
    Path("p.toml").write_text(f"{MINIMAL}[rhythm]\n{rhythm}")
    assert f"of the stride {said}\n" in run("solve", "p.toml", "--no-figures").out


@pytest.mark.parametrize(
    ("rhythm", "said"),
    [
        ("order = 'flat-first'", "flat-first (as asked)"),
        ("heel_end = 0.05\ntoe_off = 0.6", "flat-first (the only one possible)"),
    ],
)
def test_the_table_says_why_the_phases_have_their_order(run, solver, rhythm, said):
    Path("p.toml").write_text(f"{MINIMAL}[rhythm]\n{rhythm}")
    assert said in run("solve", "p.toml", "--no-figures").out


def test_json_is_one_object_with_the_same_content(run, solver, audit_report, powers):
    answer = run("solve", "--no-figures", "--json", "-o", "out")
    found = json.loads(answer.out)
    assert found["name"] == "berbyuk2002"
    assert found["acceptable"] is True
    assert found["energy_share"] == pytest.approx({j: p / 100 for j, p in powers.items()})
    assert found["rhythm"] == Rhythm(0.078, 0.233, 0.618).as_dict()
    assert found["rhythm_fixed"] == ["toe_tip_start"]
    assert found["phase_order"] == "flat-first"
    assert found["iterations"] == 123
    assert found["audit"] == audit_report().as_dict()
    assert found["comparison"]["signals"]["hip_angle"]["rms_sd"] == pytest.approx(0, abs=1e-6)
    assert found["folder"] == "out"
    assert found["files"] == ["gait.nc", "problem.toml", "report.md"]


def test_a_failed_audit_is_status_1_and_said_everywhere(run, solver, auditor, audit_report):
    auditor.answer = audit_report(accepted=False)
    answer = run("solve", "--no-figures", "-o", "out")
    assert answer.status == 1
    assert "audit              FAILED, 1 of 2 residuals\n" in answer.out
    assert "  centre of pressure: 3.25, at most 2 mm (t = 0.1 s, leg 1)\n" in answer.out
    assert "NOT ACCEPTABLE: the solver found an optimum" in answer.out
    assert "NOT ACCEPTABLE" in Path("out/report.md").read_text("utf-8")


def test_not_converged_is_status_1_with_everything_written(run, solver):
    solver.attributes = {"acceptable": 0, "solver_status": "no minimum within 3000 iterations"}
    answer = run("solve", "--no-figures", "-o", "out", "--json")
    assert answer.status == 1
    assert json.loads(answer.out)["acceptable"] is False
    assert entries(Path("out")) == ["gait.nc", "problem.toml", "report.md"]
    assert "NOT ACCEPTABLE: no minimum within 3000 iterations" in Path("out/report.md").read_text()


def test_curves_that_bear_no_audit_are_still_written(run, solver, auditor):
    error = GaitFileError("must be finite", "solve again", field="energy_per_metre")
    solver.attributes = {"acceptable": 0, "energy_per_metre": float("nan")}
    auditor.answer = error
    answer = run("solve", "--no-figures", "-o", "out")
    assert answer.status == 1
    assert "audit              not possible: energy_per_metre: must be finite" in answer.out
    assert entries(Path("out")) == ["gait.nc", "problem.toml", "report.md"]
    found = json.loads(run("solve", "--no-figures", "-o", "out", "--json").out)
    assert found["energy_per_metre"] is None
    assert found["audit"] is None


def test_the_report_holds_audit_comparison_and_figures(run, solver, monkeypatch, audit_report):
    def write_figures(dataset, folder, human):
        assert human.name == "winter-natural"
        paths = [folder / name for name in ("fig03.png", "fig03.svg", "overview.png")]
        for path in paths:
            path.write_text("")
        return paths

    monkeypatch.setattr("ergowalk.plots.write_figures", write_figures)
    answer = run("solve", "-o", "out")
    assert answer.status == 0
    report = Path("out/report.md").read_text("utf-8")
    assert audit_report().table() in report
    assert "leg 1 against winter-natural" in report
    assert "- fig03: [png](fig03.png), [svg](fig03.svg)\n- overview: [png](overview.png)" in report
    assert "\n![overview](overview.png)\n" in report
    assert "problem.toml, report.md, 2 figures" in answer.out.replace("\n", " ")


def test_figures_that_cannot_be_drawn_do_not_lose_the_gait(run, solver, monkeypatch):
    def write_figures(dataset, folder, human):
        raise GaitFileError("must be finite", "solve again", field="joint_angle")

    monkeypatch.setattr("ergowalk.plots.write_figures", write_figures)
    solver.attributes = {"acceptable": 0}
    answer = run("solve", "-o", "out")
    assert answer.status == 1
    assert "ergowalk: no figures: joint_angle: must be finite; solve again\n" in answer.err
    assert entries(Path("out")) == ["gait.nc", "problem.toml", "report.md"]


def test_a_user_table_is_copied_beside_the_result(run, solver, auditor):
    Path("tables").mkdir()
    Path("tables/mine.csv").write_bytes(SLOW_TABLE.read_bytes())
    Path("p.toml").write_text(MINIMAL + "[corridors]\nsource = 'tables/mine.csv'\n")
    assert run("solve", "p.toml", "--no-figures", "-o", "out").status == 0
    assert Path("out/mine.csv").read_bytes() == SLOW_TABLE.read_bytes()
    again = read_problem("out/problem.toml")
    assert again.corridors.source == "mine.csv"
    assert again.human().curves == read_problem("p.toml").human().curves
    with xr.open_dataset("out/gait.nc") as dataset:
        assert dataset.attrs["problem"] == Path("out/problem.toml").read_text("utf-8")
    assert auditor.folders == [Path("out")]


def test_a_table_that_vanishes_during_the_solve_does_not_lose_the_gait(run, solver):
    table = Path("mine.csv")
    table.write_bytes(SLOW_TABLE.read_bytes())
    Path("p.toml").write_text(MINIMAL + "[corridors]\nsource = 'mine.csv'\n")
    solver.afterwards = table.unlink
    assert run("solve", "p.toml", "--no-figures", "-o", "out").status == 0
    assert Path("out/mine.csv").read_bytes() == SLOW_TABLE.read_bytes()
    assert "leg 1 against mine.csv" in Path("out/report.md").read_text("utf-8")


def test_a_table_called_like_a_built_in_one_stays_what_it_is(run, solver):
    Path("winter").mkdir()
    Path("winter/winter-natural").write_bytes(SLOW_TABLE.read_bytes())
    Path("p.toml").write_text(MINIMAL + "[corridors]\nsource = 'winter/winter-natural'\n")
    assert run("solve", "p.toml", "--no-figures", "-o", "out").status == 0
    assert read_problem("out/problem.toml").corridors.source == "winter-natural.csv"
    assert Path("out/winter-natural.csv").read_bytes() == SLOW_TABLE.read_bytes()


def test_a_result_can_be_solved_again_into_its_own_folder(run, solver):
    assert run("solve", "--no-figures", "-o", "out").status == 0
    before = Path("out/problem.toml").read_text("utf-8")
    assert run("solve", "out/problem.toml", "--no-figures", "-o", "out").status == 0
    assert Path("out/problem.toml").read_text("utf-8") == before


def test_the_problem_file_of_a_user_is_never_replaced(run, solver):
    Path("problem.toml").write_text(MINIMAL + "# a remark\n")
    answer = run("solve", "problem.toml", "--no-figures", "-o", ".")
    assert answer.status == 2
    assert "problem.toml: would be replaced" in answer.err
    assert "choose another folder with -o" in answer.err
    assert solver.calls == []
    assert Path("problem.toml").read_text() == MINIMAL + "# a remark\n"


def test_old_files_are_replaced_and_no_draft_is_left(run, solver):
    Path("out").mkdir()
    for name in ("gait.nc", "problem.toml", "report.md"):
        Path("out", name).write_text("old")
    assert run("solve", "--no-figures", "-o", "out").status == 0
    assert entries(Path("out")) == ["gait.nc", "problem.toml", "report.md"]
    assert all(Path("out", name).read_bytes() != b"old" for name in entries(Path("out")))


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        ("a/../b c", "ergowalk-a-..-b-c"),
        ("../..", "ergowalk-custom"),
        ("", "ergowalk-custom"),
        ("Gang 1\n", "ergowalk-Gang-1"),
        ("x" * 300, "ergowalk-" + "x" * 60),
    ],
)
def test_any_name_makes_one_folder_here(run, solver, name, folder, tmp_path):
    problem = preset("berbyuk2002").replace(name=name)
    Path("p.toml").write_text(problem_to_toml(problem), "utf-8")
    assert run("solve", "p.toml", "--no-figures").status == 0
    assert entries(tmp_path) == sorted([folder, "p.toml"])


@pytest.mark.parametrize(
    ("folder", "reason"),
    [
        ("file/below", "Not a directory"),
        ("file", "File exists"),
        ("x" * 300, "File name too long"),
        ("taken", "gait.nc is a folder"),
    ],
)
def test_an_unusable_folder_is_found_before_solving(run, solver, folder, reason):
    Path("file").write_text("")
    Path("taken/gait.nc").mkdir(parents=True)
    answer = run("solve", "--no-figures", "-o", folder)
    assert answer.status == 2
    assert answer.out == ""
    assert answer.err == (
        f"ergowalk: {folder}: cannot be written ({reason}); choose another folder with -o\n"
    )
    assert solver.calls == []


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_found_before_solving(run, solver):
    Path("locked").mkdir(mode=0o500)
    answer = run("solve", "--no-figures", "-o", "locked")
    assert answer.status == 2
    assert "locked: cannot be written (Permission denied)" in answer.err


def test_an_interrupt_is_one_line_and_leaves_nothing(run, solver, tmp_path):
    solver.error = KeyboardInterrupt()
    answer = run("solve", "--quiet", "-o", "a/b")
    assert (answer.status, answer.out, answer.err) == (130, "", "ergowalk: interrupted\n")
    assert entries(tmp_path) == []


def test_an_interrupt_leaves_an_old_result_as_it_was(run, solver):
    assert run("solve", "--no-figures", "-o", "out").status == 0
    before = {path.name: path.read_bytes() for path in Path("out").iterdir()}
    solver.error = KeyboardInterrupt()
    assert run("solve", "--preset", "winter-slow", "--no-figures", "-o", "out").status == 130
    assert {path.name: path.read_bytes() for path in Path("out").iterdir()} == before


@pytest.mark.skipif(os.name != "posix", reason="sends a signal")
@pytest.mark.parametrize(
    ("presses", "stages"),
    [(1, (("polish", 1),)), (1, ()), (2, None)],
    ids=["seen by the next iteration", "seen at the end", "twice is at once"],
)
def test_ctrl_c_is_never_lost_in_the_solver(run, solver, tmp_path, presses, stages):
    solver.interrupts, solver.stages = presses, stages
    answer = run("solve", "--quiet")
    assert (answer.status, answer.err) == (130, "ergowalk: interrupted\n")
    assert entries(tmp_path) == []
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_what_the_solver_refuses_is_status_2(run, solver, tmp_path):
    solver.error = ProblemError("cannot be reached", "take a shorter step", field="step_length_m")
    answer = run("solve", "--quiet")
    assert answer.status == 2
    assert answer.err == "ergowalk: step_length_m: cannot be reached; take a shorter step\n"
    assert entries(tmp_path) == []


def test_progress_is_one_line_per_stage_where_no_terminal_listens(run, solver):
    answer = run("solve", "--no-figures", "-o", "out")
    assert answer.err.splitlines() == [
        f"solving berbyuk2002: {preset('berbyuk2002').limits.sentence()}",
        "kinematic fit (0.0 s)",
        "free rhythm (0.0 s)",
        "writing out",
    ]


def test_a_name_of_two_lines_stays_on_one(run, solver):
    Path("p.toml").write_text(MINIMAL.replace("'mine'", r'"two\nlines"'))
    answer = run("solve", "p.toml", "--no-figures")
    assert answer.err.startswith("solving two lines: R_y")
    assert "problem            two lines: step 0.7 m" in answer.out


def test_quiet_says_nothing_on_standard_error(run, solver):
    answer = run("solve", "--no-figures", "--quiet")
    assert answer.err == ""
    assert answer.out.startswith("problem ")
