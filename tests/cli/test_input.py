"""Unusable input: each mistake has its own line on standard error and exit status 2."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import ergowalk

MINIMAL = "step_length_m = 0.7\nstride_time_s = 1.1\n"
SLOW_TABLE = Path(ergowalk.__file__).parent / "data/winter1991/slow.csv"

PROBLEMS = {
    "unknown key": (MINIMAL + "stride_time = 1", "stride_time: unknown key; did you mean"),
    "wrong type": (
        "step_length_m = 'long'\nstride_time_s = 1.1",
        "step_length_m = 'long': .*number",
    ),
    "missing key": ("stride_time_s = 1.1", "step_length_m: required but missing; add it"),
    "negative mass": (
        MINIMAL + "[body]\ntrunk_mass_kg = -1",
        r"body\.trunk_mass_kg = -1: .*greater",
    ),
    "impossible foot": (
        MINIMAL + "[body]\nheel_to_metatarsal_m = 0.3",
        r"body\.heel_to_metatarsal_m = 0\.3: the foot triangle cannot close.*between 0\.05 and",
    ),
    "rhythm out of order": (
        MINIMAL + "[rhythm]\nheel_end = 0.3\nheel_off = 0.2",
        r"rhythm\.heel_end = 0\.3: foot-flat must come before heel-off at 0\.2",
    ),
    "missing column": (
        MINIMAL + "[corridors]\nsource = 'table.csv'",
        r"table\.csv: knee_flexion_angle_sd_deg: column is missing; the table needs",
    ),
    "missing table": (
        MINIMAL + "[corridors]\nsource = 'none.csv'",
        r"p\.toml: corridors\.source = 'none\.csv': cannot be read \(No such file",
    ),
    "no file name": (
        MINIMAL + '[corridors]\nsource = "a\\u0000b"',
        r"corridors\.source = 'a\\x00b': cannot be read",
    ),
    "unreachable step": (
        "step_length_m = 3.0\nstride_time_s = 1.1",
        r"step_length_m = 3\.0: out of reach: these legs span at most 2\.69 m",
    ),
    "no time": ("step_length_m = 0.7\nstride_time_s = 0.0", r"stride_time_s = 0\.0: .*greater"),
    "negative time": ("step_length_m = 0.7\nstride_time_s = -1", "stride_time_s = -1: .*greater"),
    "not a number": ("step_length_m = nan\nstride_time_s = 1.1", "step_length_m = nan: .*finite"),
    "infinite": ("step_length_m = 0.7\nstride_time_s = inf", "stride_time_s = inf: .*finite"),
    "no TOML": ("step_length_m: 0.7", r"not valid TOML: Expected '=' .*\(at line 1, column 14\)"),
}


@pytest.mark.parametrize(("text", "match"), PROBLEMS.values(), ids=PROBLEMS)
def test_a_mistake_in_a_problem_is_one_line(run, solver, text, match, tmp_path):
    Path("p.toml").write_text(text)
    Path("table.csv").write_text(
        SLOW_TABLE.read_text().replace("knee_flexion_angle_sd_deg", "other")
    )
    answer = run("solve", "p.toml")
    assert answer.status == 2
    assert answer.out == ""
    assert re.match(rf"ergowalk: .*{match}", answer.err)
    assert answer.err.count("\n") == 1
    assert solver.calls == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p.toml", "table.csv"]


def test_mistakes_name_the_problem_file(run):
    Path("p.toml").write_text("step_length_m = -1\nstride_time_s = 1.1")
    assert run("solve", "p.toml").err.startswith("ergowalk: p.toml: step_length_m = -1: ")


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        ([], "the following arguments are required: COMMAND; see 'ergowalk --help'"),
        (["walk"], "invalid choice: 'walk'.*'solve'"),
        (["solve", "none.toml"], r"none\.toml: cannot be read \(No such file.*ergowalk init"),
        (["solve", "."], r"\.: cannot be read \(Is a directory\)"),
        (["solve", "--preset", "winter"], "preset = 'winter': no such preset; choose one of"),
        (["solve", "p.toml", "--preset", "winter-slow"], "--preset: not allowed with.*PROBLEM"),
        (["solve", "--method", "magic"], "--method: invalid choice: 'magic'.*collocation"),
        (["solve", "--knots", "many"], "--knots: invalid int value: 'many'"),
        (["solve", "--method", "spline", "--knots", "3"], "knots = 3: must be a whole number"),
        (["solve", "--method", "spline", "--rho", "-1"], r"rho = -1.0: must be .* from 0 up"),
        (["solve", "--method", "spline", "--rho", "nan"], r"rho = nan: must be a finite number"),
        (["solve", "--asked", "nothing"], "--asked: invalid choice: 'nothing'.*paper"),
        (["solve", "--start", "none.nc"], r"none\.nc: no such file"),
        (
            ["solve", "--quiet", "--solver", "rosenbrock"],
            "solver = 'rosenbrock': cannot solve method 'collocation'; use 'ipopt', or method",
        ),
        (["solve", "--quiet", "--knots", "12"], "spline: means nothing to method 'collocation'"),
        (
            ["solve", "--method=spline", "--solver=rosenbrock", "--asked=everything", "--quiet"],
            "asked = 'everything': is beyond Rosenbrock's method",
        ),
        (["solve", "--solver", "snopt"], "--solver: invalid choice: 'snopt'.*ipopt"),
        (["solve", "--starts", "many"], "--starts: invalid int value: .many."),
        (["solve", "--qui"], "unrecognized arguments: --qui"),
        (["solve", "-o"], "-o/--output: expected one argument; see 'ergowalk solve --help'"),
        (["solve", "-o", ""], "-o/--output: the name is empty"),
        (["solve", "a\nb", "c\nd"], "unrecognized arguments: c d"),
        (["audit"], "the following arguments are required: GAIT.nc; see 'ergowalk audit"),
        (["compare"], "the following arguments are required: GAIT.nc; see 'ergowalk compare"),
        (["presets", "x"], "unrecognized arguments: x"),
        (["init", "--preset", "winter"], "preset = 'winter': no such preset"),
        (["init", "--height", "1.8"], "--mass: required but missing; --height needs it"),
        (["init", "--sex", "male"], "--height: required but missing; --sex needs it"),
        (["init", "--height", "180", "--mass", "75"], r"--height = 180\.0: must lie between 1 and"),
        (["init", "--height", "tall", "--mass", "75"], "--height: invalid float value: 'tall'"),
        (
            ["init", "--height", "1.8", "--mass", "75", "--thigh-length", "43"],
            r"--thigh-length = 43\.0: is far from the 0\.441 m that a person of 1\.8 m has",
        ),
        (["init", "--schema", "--height", "1.8"], "--height: means nothing to --schema; leave"),
        (["init", "--schema", "--preset", "winter-slow"], "--preset: means nothing to --schema"),
        (["export", "none.nc"], r"none\.nc: no such file"),
        (["export", "g.nc", "--format", "c3d"], "--format: invalid choice: 'c3d'"),
        (["export", "g.nc", "--rate", "fast"], "--rate: invalid float value: 'fast'"),
        (["init", "-o", "."], r"\.: exists already; choose another name"),
        (["init", "-o", "no/folder.toml"], r"no/folder\.toml: cannot be written \(No such file"),
    ],
)
def test_a_mistake_in_the_arguments_is_one_line(run, arguments, match):
    answer = run(*arguments)
    assert answer.status == 2
    assert answer.out == ""
    assert re.match(rf"ergowalk: .*{match}", answer.err)
    assert answer.err.count("\n") == 1


@pytest.mark.parametrize("command", ["audit", "compare"])
@pytest.mark.parametrize("content", [None, b"", b"not a gait", b"\x89HDF\r\n\x1a\n" + 99 * b"\0"])
def test_a_file_that_is_no_netcdf_is_one_line(run, command, content):
    if content is not None:
        Path("gait.nc").write_bytes(content)
    answer = run(command, "gait.nc")
    assert answer.status == 2
    assert answer.out == ""
    assert re.match(r"ergowalk: gait\.nc: .*; ", answer.err)
    assert answer.err.count("\n") == 1


@pytest.mark.parametrize("command", ["audit", "compare"])
def test_a_folder_is_no_gait(run, command):
    answer = run(command, ".")
    assert answer.status == 2
    assert re.match(r"ergowalk: \.: .*; .*\n\Z", answer.err)


@pytest.mark.parametrize("command", ["audit", "compare"])
def test_a_netcdf_without_the_variables_is_one_line(run, command, gait):
    gait.dataset.drop_vars("ground_reaction_force").to_netcdf("gait.nc")
    answer = run(command, "gait.nc")
    assert answer.status == 2
    assert answer.out == ""
    assert re.match(r"ergowalk: gait\.nc: .*missing; .*\n\Z", answer.err)


@pytest.mark.parametrize("command", [[], ["solve"], ["audit"], ["compare"], ["presets"], ["init"]])
def test_help_tells_the_exit_statuses(run, command):
    answer = run(*command, "--help")
    assert (answer.status, answer.err) == (0, "")
    assert "Exit status: 0 an acceptable answer; 1" in answer.out


def test_the_version_is_that_of_the_package(run):
    answer = run("--version")
    assert (answer.status, answer.out, answer.err) == (0, f"ergowalk {ergowalk.__version__}\n", "")
