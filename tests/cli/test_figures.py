"""``figures``: the drawings of a journal, and what is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture(scope="module")
def gait_file(paper_gait_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A gait in a folder of its own."""
    return Path(shutil.copy(paper_gait_file, tmp_path_factory.mktemp("drawn") / "gait.nc"))


def test_figures_stand_in_a_folder_beside_the_gait(gait_file: Path, run: Any) -> None:
    answer = run("figures", gait_file)
    folder = gait_file.parent / "figures"
    assert (answer.status, answer.err) == (0, "")
    assert answer.out == f"{gait_file}: 9 figures, 88 mm wide, pdf and svg: {folder}\n"
    assert len(list(folder.glob("figure_*.pdf"))) == len(list(folder.glob("figure_*.svg"))) == 9
    assert len(list(folder.iterdir())) == 18


def test_json_lists_the_files(gait_file: Path, run: Any) -> None:
    answer = run("figures", gait_file, "--column", "double", "-o", "wide", "--json")
    found = json.loads(answer.out)
    assert (found["width_mm"], found["acceptable"]) == (180, True)
    assert sorted(found["files"]) == sorted(p.name for p in Path("wide").iterdir())


def test_what_cannot_be_drawn_or_written_is_one_line(
    gait_file: Path, run: Any, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    for arguments, told in (
        ((gait_file, "-o", "file"), "file: cannot be written"),
        (("file",), "file: is not a NetCDF file"),
        ((gait_file, "--column", "wide"), "argument --column: invalid choice: 'wide'"),
    ):
        answer = run("figures", *arguments)
        assert (answer.status, answer.out) == (2, "")
        assert answer.err.count("\n") == 1
        assert told in answer.err
    assert [p.name for p in tmp_path.iterdir()] == ["file"]
