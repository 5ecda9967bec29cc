"""``price``: the list, the figures, and what has no prices."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from ergowalk.solution import Solution


@pytest.fixture(scope="module")
def priced(paper_gait_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A gait in a folder of its own."""
    folder = tmp_path_factory.mktemp("priced")
    return Path(shutil.copy(paper_gait_file, folder / "gait.nc"))


def test_the_list_and_its_figures_stand_beside_the_gait(priced: Path, run: Any) -> None:
    answer = run("price", str(priced))
    assert answer.status == 0
    assert answer.err == ""
    lines = answer.out.splitlines()
    assert "J/m with R_y <= 1.3 body weights" in lines[0]
    names = [line.split()[0] for line in lines[2:]]
    assert {"step_length_m", "stride_time_s", "corridors.width_sd"} <= set(names)
    for joint in ("hip", "knee", "ankle"):
        assert any(line.split()[:1] == [joint] and line.endswith(" J/m") for line in lines)
    assert {p.name for p in priced.parent.iterdir()} == {"gait.nc", "prices.png", "prices.svg"}


def test_json_has_the_same_numbers(priced: Path, run: Any, tmp_path: Path) -> None:
    answer = run("price", str(priced), "--json", "-o", str(tmp_path / "new"))
    found = json.loads(answer.out)
    assert found["energy_per_metre"] == Solution.load(priced).energy_per_metre
    slopes = {price["name"]: price["slope"] for price in found["numbers"]}
    assert slopes["limits.vertical_reaction_body_weights"] < 0  # a higher cap costs no more
    assert {"step_length_m", "stride_time_s"} <= set(slopes)
    assert set(found["corridor_j_per_m_per_degree"]) == {"hip", "knee", "ankle"}
    assert sorted(p.name for p in (tmp_path / "new").iterdir()) == ["prices.png", "prices.svg"]


def test_a_gait_without_multipliers_is_one_line(priced: Path, run: Any, tmp_path: Path) -> None:
    bare = Solution.load(priced)
    path = Solution(bare.dataset.drop_vars("nlp_variable")).save(tmp_path / "bare.nc")
    answer = run("price", str(path))
    assert answer.status == 2
    assert answer.out == ""
    assert answer.err.startswith(f"ergowalk: {path}: nlp_row_multiplier: keeps no multipliers; ")
    assert answer.err.count("\n") == 1


def test_a_folder_that_cannot_be_is_refused(priced: Path, run: Any, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    answer = run("price", str(priced), "-o", str(tmp_path / "file"))
    assert answer.status == 2
    assert "choose another folder with -o" in answer.err
