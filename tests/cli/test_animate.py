"""``animate``: the film, what is said of it, and what is refused."""

from __future__ import annotations

import json
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

ASKED = ("--size", "240x160", "--fps", "10")


@pytest.fixture(scope="module")
def gait_file(paper_gait_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A gait in a folder of its own."""
    return Path(shutil.copy(paper_gait_file, tmp_path_factory.mktemp("filmed") / "gait.nc"))


@pytest.mark.parametrize("kind", ["gif", "webp"])
def test_the_film_is_written_and_told(gait_file: Path, run: Any, tmp_path: Path, kind: str):
    answer = run("animate", gait_file, "-o", f"walk.{kind}", *ASKED)
    assert (answer.status, answer.err) == (0, "")
    energy, told = answer.out.splitlines()
    assert "J/m with R_y <= 1.3 body weights" in energy
    assert told.startswith(f"film: walk.{kind}: 240x160, 11 frames, 1.10 s, ")
    assert [path.name for path in tmp_path.iterdir()] == [f"walk.{kind}"]
    assert (tmp_path / f"walk.{kind}").read_bytes()[:3] in (b"GIF", b"RIF")


def test_json_says_the_same(gait_file: Path, run: Any) -> None:
    answer = run("animate", gait_file, gait_file, "--human", "-o", "w.GIF", *ASKED, "--json")
    found = json.loads(answer.out)
    assert found["frames"] == 11
    assert found["duration_s"] == pytest.approx(1.1)
    assert [label[:5] for label in found["gaits"]] == ["berby", "berby", "human"]
    assert found["bytes"] == Path(found["film"]).stat().st_size


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (
            ["-o", "walk.avi"],
            "walk.avi: the name of a film must say its format; let it end on .mp4",
        ),
        (["-o", "walk"], "walk: the name of a film must say its format"),
        (["-o", "no/walk.gif"], "no: no such folder"),
        (["-o", "walk.gif", "--size", "big"], "argument --size: 'big' is no size such as 960x540"),
        (["-o", "walk.gif", "--size", "12x12"], "width = 12: should be greater than or equal"),
        (["-o", "walk.mp4", "--size", "241x160"], "width = 241: must be even in an mp4"),
        (["-o", "walk.gif", "--fps", "x"], "argument --fps: invalid float value: 'x'"),
        (["-o", "walk.gif", "--fps", "99"], "fps = 99.0: must be at most 50 in a gif"),
        (["-o", "walk.gif", "--strides", "-1"], "strides = -1: should be greater"),
        ([], "the following arguments are required: -o/--output"),
    ],
)
def test_what_cannot_be_filmed_is_one_line(
    gait_file: Path, run: Any, tmp_path: Path, arguments: list[str], told: str
) -> None:
    answer = run("animate", gait_file, *arguments)
    assert (answer.status, answer.out) == (2, "")
    assert answer.err.count("\n") == 1
    assert told in answer.err
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_no_gait_is_named(run: Any, tmp_path: Path) -> None:
    (tmp_path / "x.nc").write_text("no gait")
    answer = run("animate", "x.nc", "-o", "walk.gif")
    assert answer.status == 2
    assert answer.err.startswith("ergowalk: x.nc: is not a NetCDF file")


def test_a_film_does_not_replace_its_gait(gait_file: Path, run: Any, tmp_path: Path) -> None:
    disguised = tmp_path / "gait.gif"
    shutil.copy(gait_file, disguised)
    before = disguised.read_bytes()
    answer = run("animate", disguised, "-o", disguised, *ASKED)
    assert answer.status == 2
    assert "is one of the gaits; choose another file with -o" in answer.err
    assert disguised.read_bytes() == before


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_failure_leaves_the_old_film(
    gait_file: Path, run: Any, tmp_path: Path, monkeypatch: Any, failure: BaseException
) -> None:
    old = tmp_path / "walk.gif"
    old.write_bytes(b"old")

    def half(self: Path, content: bytes) -> int:
        with open(self, "wb") as file:
            file.write(content[:100])
        raise failure

    monkeypatch.setattr(Path, "write_bytes", half)
    answer = run("animate", gait_file, "-o", old, *ASKED)
    assert answer.status == (130 if isinstance(failure, KeyboardInterrupt) else 2)
    assert answer.err.count("\n") == 1
    assert old.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [old]


def test_without_pyav_an_mp4_is_refused_in_one_line(
    gait_file: Path, run: Any, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    answer = run("animate", gait_file, "-o", "walk.mp4")
    assert answer.status == 2
    assert (
        "an mp4 needs the package PyAV; install it with: pip install 'ergowalk[film]'" in answer.err
    )
    assert list(tmp_path.iterdir()) == []
