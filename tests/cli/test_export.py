"""``ergowalk export``: which files come where, and one line for each mistake."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from ergowalk.cli.arguments.showing import FORMATS as CHOICES
from ergowalk.cli.parser import build_parser
from ergowalk.io import FORMATS, RATE, STRIDES
from ergowalk.solution import Solution

FILES = sorted(f.file for f in FORMATS.values())


@pytest.fixture
def here(run, paper_gait_file: Path):
    """A solved gait as ``gait/gait.nc`` in the current folder, and the command."""
    Path("gait").mkdir()
    shutil.copy(paper_gait_file, "gait/gait.nc")
    return run


def names(folder: str) -> list[str]:
    return sorted(path.name for path in Path(folder).iterdir())


def test_all_formats_come_into_a_folder_beside_the_gait(here):
    answer = here("export", "gait/gait.nc")
    assert (answer.status, answer.err) == (0, "")
    assert names("gait/export") == FILES
    first, *lines = answer.out.splitlines()
    assert first.startswith("gait/gait.nc: E = ")
    assert " J/m with R_y <= 1.3 body weights" in first
    assert sorted(line.split()[0] for line in lines) == [f"gait/export/{name}" for name in FILES]


def test_a_named_folder_takes_all_or_what_is_asked_for(here):
    assert here("export", "gait/gait.nc", "-o", "out").status == 0
    assert names("out") == FILES
    assert here("export", "gait/gait.nc", "-o", ".", "--format", "mjcf").status == 0
    assert names(".") == ["gait", "out", "walker.xml"]
    asked = ("--format", "trc", "--format", "sto", "--format", "trc")
    assert here("export", "gait/gait.nc", "-o", "two", *asked).status == 0
    assert names("two") == ["markers.trc", "moments.sto"]


@pytest.mark.parametrize(
    ("output", "format_"),
    [
        ("a.csv", "csv"),
        ("a.mot", "mot"),
        ("a_reactions.mot", "grf"),
        ("A.STO", "sto"),
        ("a.trc", "trc"),
        ("a.xml", "mjcf"),
        ("external_loads.xml", "loads"),
    ],
)
def test_the_name_of_a_file_says_its_format(here, output, format_):
    assert here("export", "gait/gait.nc", "-o", output).status == 0
    dataset = Solution.load("gait/gait.nc").dataset
    expected = FORMATS[format_].text(dataset, RATE, STRIDES)
    assert Path(output).read_text("utf-8") == expected
    assert names(".") == sorted(["gait", output])


def test_a_format_that_is_said_goes_before_the_name(here):
    assert here("export", "gait/gait.nc", "-o", "loads.mot", "--format", "grf").status == 0
    assert Path("loads.mot").read_text().startswith("reactions.mot\nversion=1\n")
    assert here("export", "gait/gait.nc", "-o", "walk.txt", "--format", "csv").status == 0
    assert Path("walk.txt").read_text().startswith("time_s,")


def test_rate_and_strides_are_those_asked_for(here):
    arguments = ("-o", "a.sto", "--rate", 50, "--strides", 2)
    assert here("export", "gait/gait.nc", *arguments).status == 0
    assert "nRows=115\n" in Path("a.sto").read_text()  # 2 x 1.14 s at 50 Hz


def test_json_tells_what_was_written(here):
    found = json.loads(here("export", "gait/gait.nc", "-o", "out", "--json").out)
    assert found["acceptable"] is True
    assert found["file"] == "gait/gait.nc"
    assert [w["format"] for w in found["written"]] == list(FORMATS)
    assert all(Path(w["file"]).exists() for w in found["written"])


def test_an_old_file_is_replaced_and_nothing_else_stays(here):
    Path("a.trc").write_text("old")
    assert here("export", "gait/gait.nc", "-o", "a.trc").status == 0
    assert Path("a.trc").read_text().startswith("PathFileType")
    assert names(".") == ["a.trc", "gait"]


def test_a_gait_that_is_not_acceptable_is_marked(here):
    solution = Solution.load("gait/gait.nc")
    solution.dataset.attrs["acceptable"] = 0
    solution.save("bad.nc")
    answer = here("export", "bad.nc", "-o", "a.csv")
    assert answer.status == 0
    assert answer.out.startswith("bad.nc (NOT ACCEPTABLE): E = ")


@pytest.mark.parametrize(
    ("arguments", "match"),
    [
        (
            ("-o", "a.c3d"),
            "--output = 'a.c3d': has a suffix of no known format; end it on .csv, .mot, .sto, "
            ".trc, .xml, say which with --format, or give a folder",
        ),
        (
            ("-o", "a.csv", "--format", "csv", "--format", "trc"),
            "--format: several formats for one file; give one, or a folder with -o",
        ),
        (("-o", "gait/gait.nc", "--format", "csv"), "gait/gait.nc: is the gait; choose another"),
        (("-o", "no/where/a.csv"), "no/where/a.csv: cannot be written (No such file or directory)"),
        (("-o", "gait/gait.nc/x"), "gait/gait.nc/x: cannot be written (Not a directory)"),
        (("--rate", "0"), "--rate = 0.0: must be positive and at most 20000 Hz; give samples"),
        (("--rate", "nan"), "--rate = nan: must be positive"),
        (("--rate", "0.1"), "--rate = 0.1: must give two samples"),
        (("--strides", "0"), "--strides = 0: must lie between 1 and 100; give a number"),
    ],
)
def test_a_mistake_is_one_line_and_writes_nothing(here, arguments, match):
    answer = here("export", "gait/gait.nc", *arguments)
    assert (answer.status, answer.out) == (2, "")
    assert answer.err.startswith(f"ergowalk: {match}")
    assert answer.err.count("\n") == 1
    assert names(".") == ["gait"]
    assert names("gait") == ["gait.nc"]


def test_a_body_that_no_rigid_bodies_make_names_the_file(here):
    solution = Solution.load("gait/gait.nc")
    symbols = json.loads(solution.dataset.attrs["body_parameters"])
    solution.dataset.attrs["body_parameters"] = json.dumps({**symbols, "J": 1.0})
    solution.save("odd.nc")
    answer = here("export", "odd.nc", "-o", "a.xml")
    assert answer.status == 2
    assert answer.err.startswith("ergowalk: odd.nc: ")
    assert answer.err.count("\n") == 1


def test_choices_and_defaults_of_the_command_are_those_of_the_library():
    assert set(CHOICES) == set(FORMATS)
    arguments = build_parser().parse_args(["export", "gait.nc"])
    assert (arguments.rate, arguments.strides) == (RATE, STRIDES)
