"""A solution measures itself, and saves and loads without loss."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from ergowalk.errors import GaitFileError, OutputError
from ergowalk.gait.rhythm import PRINTED_RHYTHM
from ergowalk.problem import Corridors
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.solution.solution import MESH_SHARE

from .made_up import PROBLEM, dataset


@pytest.fixture(scope="module")
def solution() -> Solution:
    return Solution(dataset())


# --- what it says of itself --------------------------------------------------------------------


def test_energies_of_the_joints_add_up_to_e(solution: Solution) -> None:
    parts = solution.energy_by_joint
    assert list(parts) == ["hip", "knee", "ankle", "metatarsal"]
    assert sum(parts.values()) == pytest.approx(solution.energy_per_metre, rel=1e-12)
    assert min(parts.values()) > 0


def test_attributes_come_back_as_values(solution: Solution) -> None:
    assert solution.status == "made up"
    assert solution.acceptable is False
    assert solution.rhythm == PRINTED_RHYTHM
    assert solution.problem == PROBLEM
    assert solution.mesh_history == [{"elements": 4, "energy_per_metre": solution.energy_per_metre}]


def checked(change: float, *, converged: bool = True, method: str = "collocation") -> Solution:
    """A gait whose check found another E by this share."""
    found = dataset()
    energy = float(found.attrs["energy_per_metre"])
    history = [
        {"elements": 4, "energy_per_metre": energy, "converged": True, "final": True},
        {
            "elements": 5,
            "energy_per_metre": energy * (1 + change),
            "converged": converged,
            "finer": True,
        },
    ]
    return Solution(found.assign_attrs(mesh_history=json.dumps(history), method=method))


def test_the_error_bar_is_twice_what_the_check_changed() -> None:
    gait = checked(-0.004)
    assert gait.energy_error == pytest.approx(0.008 * gait.energy_per_metre)


def test_the_error_bar_has_a_floor() -> None:
    gait = checked(0.0001)
    assert gait.energy_error == pytest.approx(MESH_SHARE * gait.energy_per_metre)


def test_there_is_no_error_bar_without_a_check_that_converged(solution: Solution) -> None:
    assert solution.energy_error is None
    assert checked(0.001, converged=False).energy_error is None
    assert checked(0.001, method="spline").energy_error is None


def test_acceptable_is_what_was_stored() -> None:
    assert Solution(dataset().assign_attrs(acceptable=np.int64(1))).acceptable is True


def test_the_audit_sees_the_very_curves(solution: Solution) -> None:
    """The made-up walker walks on air, but its loads, angles and energy are those of its motion."""
    lines = {line.key: line.accepted for line in solution.audit().lines}
    followed = (
        "equations_of_motion",
        "joint_angles",
        "joint_power",
        "corridors_as_asked",
        "leg_symmetry",
        "load_symmetry",
        "energy",
        "finite",
    )
    assert {key: lines[key] for key in followed} == dict.fromkeys(followed, True)
    assert not lines["feet_fixed"]
    assert not solution.audit().accepted


# --- saving and loading ------------------------------------------------------------------------


def test_saving_and_loading_changes_nothing(solution: Solution, tmp_path: Path) -> None:
    written = solution.save(tmp_path / "gait.nc")
    assert written == tmp_path / "gait.nc"
    loaded = Solution.load(written)
    xr.testing.assert_identical(loaded.dataset, solution.dataset)
    for name in solution.dataset.variables:
        assert loaded.dataset[name].dtype.kind == solution.dataset[name].dtype.kind or (
            solution.dataset[name].dtype == object
        )
    assert loaded.energy_per_metre == solution.energy_per_metre
    assert loaded.problem.replace(folder=None) == solution.problem
    assert loaded.rhythm == solution.rhythm


def test_a_corridor_table_beside_the_file_is_found(solution: Solution, tmp_path: Path) -> None:
    table = resources.files("ergowalk").joinpath("data/winter1991/natural.csv").read_text("utf-8")
    (tmp_path / "mine.csv").write_text(table, "utf-8")
    problem = PROBLEM.replace(corridors=Corridors(source="mine.csv"))
    with_table = solution.dataset.assign_attrs(problem=problem_to_toml(problem))
    loaded = Solution.load(Solution(with_table).save(tmp_path / "gait.nc"))
    assert loaded.problem.angle_corridors() == PROBLEM.angle_corridors()
    lines = {line.key: line.accepted for line in loaded.audit().lines}
    assert lines["corridors_as_asked"]


def test_the_file_opens_with_plain_xarray(solution: Solution, tmp_path: Path) -> None:
    with xr.open_dataset(solution.save(tmp_path / "gait.nc")) as stored:
        assert stored["time"].dtype == np.float64  # seconds, not made into dates
        assert stored["contact_phase"].dtype.kind == "i"
        assert stored["joint_moment"].sel(leg=2, joint="ankle").attrs["units"] == "N m"


def test_saving_again_replaces_and_leaves_nothing_beside(
    solution: Solution, tmp_path: Path
) -> None:
    target = tmp_path / "gait.nc"
    target.write_text("old")
    solution.save(str(target))
    assert Solution.load(target).status == "made up"
    assert [p.name for p in tmp_path.iterdir()] == ["gait.nc"]


def test_the_same_solution_is_the_same_bytes(solution: Solution, tmp_path: Path) -> None:
    one, two = (solution.save(tmp_path / name).read_bytes() for name in ("a.nc", "b.nc"))
    assert one == two


def test_a_saved_gait_can_be_read_by_others(solution: Solution, tmp_path: Path) -> None:
    mode = solution.save(tmp_path / "gait.nc").stat().st_mode
    plain = tmp_path / "plain"
    plain.touch()
    assert mode == plain.stat().st_mode


@pytest.mark.parametrize("error", [KeyboardInterrupt(), MemoryError()])
def test_an_interrupted_save_leaves_the_old_file(
    solution: Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    target = solution.save(tmp_path / "gait.nc")
    before = target.read_bytes()

    def half_way(self: xr.Dataset, path: Path, **_: Any) -> None:
        Path(path).write_bytes(before[:1000])
        raise error

    monkeypatch.setattr(xr.Dataset, "to_netcdf", half_way)
    with pytest.raises(type(error)):
        solution.save(target)
    assert target.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["gait.nc"]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), RuntimeError("HDF")])
def test_a_full_disk_is_told_in_one_line_and_leaves_the_old_file(
    solution: Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    target = tmp_path / "gait.nc"
    target.write_text("old")

    def full(self: xr.Dataset, path: Path, **_: Any) -> None:
        raise error

    monkeypatch.setattr(xr.Dataset, "to_netcdf", full)
    with pytest.raises(OutputError, match=r"gait\.nc: cannot be written \((No space left|HDF)"):
        solution.save(target)
    assert target.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["gait.nc"]


def test_a_place_that_cannot_be_is_told(solution: Solution, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"gait\.nc: cannot be written \(No such file.*; choose"):
        solution.save(tmp_path / "missing" / "gait.nc")
    occupied = tmp_path / "occupied.nc"
    occupied.mkdir()
    with pytest.raises(OutputError, match=r"occupied\.nc: cannot be written \(Is a directory\)"):
        solution.save(occupied)
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match=r"cannot be written \(Not a directory\)"):
        solution.save(tmp_path / "file" / "gait.nc")
    with pytest.raises(OutputError, match=r"cannot be written \(embedded null"):
        solution.save(tmp_path / "gait\0.nc")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "occupied.nc"]


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(GaitFileError, match=r"lost\.nc: no such file; give the path of a gait\.nc"):
        Solution.load(tmp_path / "lost.nc")


@pytest.mark.parametrize(
    "content", [b"", b"step_length_m = 0.76\n", b"CDF\x01", b"\x89HDF\r\n\x1a\n"]
)
def test_a_file_of_another_kind_is_told(tmp_path: Path, content: bytes) -> None:
    other = tmp_path / "other.nc"
    other.write_bytes(content)
    with pytest.raises(GaitFileError, match=r"other\.nc: is not a NetCDF file .*'ergowalk solve'"):
        Solution.load(other)


def test_a_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(GaitFileError, match=r"is not a NetCDF file"):
        Solution.load(tmp_path)


def test_a_name_that_no_file_can_have_is_told(tmp_path: Path) -> None:
    with pytest.raises(GaitFileError, match=r"is not a NetCDF file|no such file"):
        Solution.load(tmp_path / "gait\0.nc")


def test_netcdf_without_a_gait_is_told(solution: Solution, tmp_path: Path) -> None:
    empty = tmp_path / "empty.nc"
    xr.Dataset().to_netcdf(empty, engine="netcdf4")
    with pytest.raises(GaitFileError, match=r"empty\.nc: time: required but missing; write"):
        Solution.load(empty)
    lacking = tmp_path / "lacking.nc"
    solution.dataset.drop_vars("joint_moment").to_netcdf(lacking, engine="netcdf4")
    with pytest.raises(GaitFileError, match=r"lacking\.nc: joint_moment: required but missing"):
        Solution.load(lacking)


@pytest.mark.parametrize("name", ["problem", "rhythm", "step_length", "energy_per_metre"])
def test_an_attribute_that_is_missing_is_told(
    solution: Solution, tmp_path: Path, name: str
) -> None:
    lacking = tmp_path / "lacking.nc"
    stripped = solution.dataset.copy()
    del stripped.attrs[name]
    stripped.to_netcdf(lacking, engine="netcdf4")
    with pytest.raises(GaitFileError, match=rf"lacking\.nc: {name}"):
        Solution.load(lacking)
