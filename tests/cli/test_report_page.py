"""``report``: the page, its JSON, and what is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from ergowalk.solution import Solution


@pytest.fixture(scope="module")
def gait_file(paper_gait_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A gait in a folder of its own."""
    folder = tmp_path_factory.mktemp("reported")
    return Path(shutil.copy(paper_gait_file, folder / "gait.nc"))


def test_the_page_stands_beside_the_gait(gait_file: Path, run: Any) -> None:
    answer = run("report", gait_file)
    assert (answer.status, answer.err) == (0, "")
    page = gait_file.with_name("report.html")
    energy, where = answer.out.splitlines()
    assert energy.startswith(f"{gait_file}: E = ")
    assert "J/m with R_y <= 1.3 body weights" in energy
    assert where == f"report: {page}"
    assert page.read_text("utf-8").startswith("<!DOCTYPE html>")
    assert {p.name for p in gait_file.parent.iterdir()} == {"gait.nc", "report.html"}


def test_json_names_page_and_gaits(gait_file: Path, run: Any, tmp_path: Path) -> None:
    wrong = Solution.load(gait_file).dataset.assign_attrs(acceptable=0)
    other = Solution(wrong).save(tmp_path / "other.nc")
    answer = run("report", gait_file, other, "--json", "-o", "two.html")
    assert answer.status == 0
    found = json.loads(answer.out)
    assert found["report"] == "two.html"
    assert found["bytes"] == (tmp_path / "two.html").stat().st_size < 3_000_000
    assert [gait["acceptable"] for gait in found["gaits"]] == [True, False]
    assert "(NOT ACCEPTABLE): E = " in run("report", other).out


def refused(answer: Any, *words: str) -> bool:
    """Whether a command ended with status 2 and one line that has these words."""
    one_line = answer.status == 2 and answer.out == "" and answer.err.count("\n") == 1
    return one_line and all(word in answer.err for word in ("ergowalk: ", *words))


def test_a_file_that_is_not_there_is_one_line(gait_file: Path, run: Any, tmp_path: Path) -> None:
    assert refused(run("report", gait_file, "none.nc", "-o", "r.html"), "none.nc: no such file; ")
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_no_gait_is_one_line(run: Any, tmp_path: Path) -> None:
    (tmp_path / "text.nc").write_text("no gait")
    assert refused(run("report", "text.nc"), "text.nc: is not a NetCDF file")
    assert [p.name for p in tmp_path.iterdir()] == ["text.nc"]


def test_a_place_that_cannot_be_written_is_one_line(gait_file: Path, run: Any) -> None:
    answer = run("report", gait_file, "-o", "none/r.html")
    assert refused(answer, "none/r.html: cannot be written (No such file or directory); ")


def test_a_gait_is_not_replaced_by_its_report(gait_file: Path, run: Any) -> None:
    content = gait_file.read_bytes()
    assert refused(run("report", gait_file, "-o", gait_file), "is one of the gaits; ")
    assert gait_file.read_bytes() == content


def test_a_gait_whose_human_data_are_lost_is_named(
    gait_file: Path, run: Any, tmp_path: Path
) -> None:
    dataset = Solution.load(gait_file).dataset
    problem = str(dataset.attrs["problem"]).replace('"winter-natural"', '"lost.csv"')
    Solution(dataset.assign_attrs(problem=problem)).save(tmp_path / "g.nc")
    assert refused(run("report", "g.nc"), "g.nc: corridors.source = 'lost.csv': cannot be read")


def test_a_report_of_nothing_is_one_line(run: Any) -> None:
    assert refused(run("report"), "GAIT.nc", "see 'ergowalk report --help'")
