"""The worker: what it leaves for the page, how it talks, and that it ends with its parent."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import ergowalk
from ergowalk.app import film, results, worker
from ergowalk.app.film import film_name
from ergowalk.app.results import DOWNLOADS, PAYLOAD, store
from ergowalk.problem import preset
from ergowalk.problem.files import problem_from_toml, problem_to_toml
from ergowalk.solution import Progress, Solution
from ergowalk.values import as_json

from .serving import STAND_IN, gone


@pytest.fixture(scope="module")
def solution(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


def test_everything_that_the_page_offers_is_written(solution: Solution, tmp_path: Path) -> None:
    said = store(solution, tmp_path, 3)
    assert said["acceptable"] is said["viewable"] is True
    assert said["label"].startswith("3: berbyuk2002-rhythm, 0.76 m, 1.14 s, E = 5")
    assert said["energy"] == solution.energy_per_metre
    assert [label for label, _ in said["rows"]][:2] == ["E", "with the limits"]
    assert said["files"] == list(DOWNLOADS)
    assert json.loads(json.dumps(said, allow_nan=False))
    stored = Solution.load(tmp_path / "gait.nc")
    assert stored.energy_per_metre == solution.energy_per_metre
    text = (tmp_path / "problem.toml").read_text("utf-8")
    assert problem_from_toml(text) == preset("berbyuk2002-rhythm")
    assert json.loads((tmp_path / PAYLOAD).read_text("utf-8"))["label"] == said["label"]
    assert "<title>Gait report: berbyuk2002-rhythm" in (tmp_path / "report.html").read_text("utf-8")


def test_a_gait_that_cannot_be_shown_can_still_be_downloaded(
    solution: Solution, tmp_path: Path
) -> None:
    lost = Solution(solution.dataset.drop_vars("joint_power").assign_attrs(acceptable=0))
    lost.__dict__["energy_by_joint"] = {"hip": 1.0}
    said = store(lost, tmp_path, 1)
    assert said["acceptable"] is said["viewable"] is False
    assert "joint_power" in said["why"]
    assert said["files"] == ["gait.nc", "problem.toml"]


def test_a_solve_is_an_order_carried_out(
    solution: Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def solve(problem: Any, progress: Any) -> Solution:
        assert problem == preset("winter-fast")
        for i in range(1000):
            progress(Progress("fit" if i < 500 else "polish", i, float("nan"), 1e-3, 0.1 * i))
        return solution

    monkeypatch.setattr("ergowalk.solving.solve", solve)
    monkeypatch.setattr(results, "_show", lambda *_: [])
    told: list[dict[str, Any]] = []
    order = {"problem": problem_to_toml(preset("winter-fast")), "folder": tmp_path, "number": 1}
    said = worker.solve_task(order, told.append)
    assert said["label"].startswith("1: ")
    assert said["film"] == film_name()
    stages = [t["progress"]["stage"] for t in told]
    assert stages[0] == "starting the solver"
    assert stages[-1] == "auditing and drawing"
    assert {"fit", "polish"} < set(stages)
    assert len(told) < 100  # a thousand iterations in no time are not a thousand messages
    (first,) = [t["progress"] for t in told if t["progress"].get("iteration") == 0]
    assert first["violation"] == 1e-3


def test_what_is_no_number_reaches_the_page_as_none() -> None:
    plain = as_json({"a": [float("nan"), 1.0, (float("inf"),)], "b": "c"})
    assert plain == {"a": [None, 1.0, [None]], "b": "c"}


@pytest.mark.skipif(sys.platform != "linux", reason="looks a process up")
def test_a_worker_ends_when_its_parent_is_gone() -> None:
    process = subprocess.Popen(
        STAND_IN,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,
        env={"PYTHONPATH": str(Path(ergowalk.__file__).parents[1])},
    )
    assert process.stdin is not None
    assert process.stdout is not None
    order = {"task": "solve", "problem": 'name = "endless"', "folder": "", "number": 1}
    process.stdin.write(json.dumps(order).encode() + b"\n")
    process.stdin.flush()
    assert b"begun" in process.stdout.readline()
    assert not gone(process.pid, within=0.2)
    process.stdin.close()
    assert gone(process.pid)
    process.wait(5)
    process.stdout.close()


@pytest.mark.parametrize(
    ("installed", "name"),
    [((), "film.gif"), (("av",), "film.mp4")],
)
def test_a_film_is_an_mp4_where_something_makes_it(
    installed: tuple[str, ...], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(film, "find_spec", lambda name: name if name in installed else None)
    assert film_name() == name


def test_a_film_is_made_from_what_the_viewer_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ergowalk.film.FilmOptions", lambda format: format)
    monkeypatch.setattr("ergowalk.film.film", lambda gaits, how: f"{how} of {gaits}".encode())
    (tmp_path / PAYLOAD).write_text('{"label": "a gait"}', "utf-8")
    worker.film_task({"folder": str(tmp_path), "name": "film.gif"}, lambda message: None)
    assert (tmp_path / "film.gif").read_bytes() == b"gif of [{'label': 'a gait'}]"
    assert not list(tmp_path.glob("part-*"))
