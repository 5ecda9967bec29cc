"""The command with the real solver: a gait beside the stored one, found from it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from ergowalk.cli import main
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.study import collect

from .conftest import index


def test_a_neighbour_of_a_stored_gait_is_found_from_it(
    here: str, paper_gait_file: Path, tmp_path: Path, capsys: Any
) -> None:
    start = Solution.load(paper_gait_file)
    length = 1.01 * start.problem.step_length_m
    (tmp_path / "problem.toml").write_text(problem_to_toml(start.problem))
    (tmp_path / "sweep.toml").write_text(
        f'name = "near"\nproblem = "problem.toml"\nstart = "{paper_gait_file}"\n'
        f"[grid]\nstep_length_m = [{length!r}]\n"
    )
    folder = tmp_path / "out"
    command = ["sweep", str(tmp_path / "sweep.toml"), "-o", str(folder), "--scheduler", here]
    assert main([*command, "--json"]) == 0
    out, err = capsys.readouterr()
    told = json.loads(out)
    assert told["status"] == {"accepted": 1}
    assert told["limits"] == start.problem.limits.sentence()
    assert "1 of 1 cases, 1 accepted" in err

    gait = Solution.load(told["cheapest"]["gait"])
    assert gait.problem.step_length_m == length
    assert gait.audit().accepted
    # 7.6 mm at a price of the order of 100 J/m per metre of step length
    assert 0.0 < abs(gait.energy_per_metre - start.energy_per_metre) < 1.5
    found = collect(folder)
    assert found["way"].item() == "neighbour"
    assert found["energy_per_metre"].item() == gait.energy_per_metre
    assert found["energy_by_joint"].sum().item() == pytest.approx(gait.energy_per_metre, rel=1e-9)
    assert 0.2 < found["human_distance"].item() < 5.0
    assert found["iterations"].item() < start.dataset.attrs["iterations"]
    with xr.open_dataset(told["results"]) as stored:
        assert stored.load().identical(found)
    (row,) = index(folder).values()
    assert row["energy_per_metre"] == gait.energy_per_metre

    # the same command again has nothing to do
    written = Path(told["cheapest"]["gait"]).stat().st_mtime_ns
    assert main([*command, "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("sweep     near\ncases     1: 1 accepted\ncheapest  ")
    assert err == ""
    assert Path(told["cheapest"]["gait"]).stat().st_mtime_ns == written
