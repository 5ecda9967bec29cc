"""Human data as periodic curves: what they reproduce, how they bound, what tables they refuse."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

import ergowalk
from ergowalk.corridors import (
    ANGLES,
    BUILT_IN,
    MAX_HARMONICS,
    SIGNALS,
    Corridor,
    PeriodicCurve,
    human_gait,
)
from ergowalk.errors import CorridorError

Array = NDArray[np.float64]

LAW = settings(deadline=None, max_examples=40, derandomize=True, database=None)

samples = st.integers(11, 51).flatmap(
    lambda n: arrays(np.float64, n, elements=st.floats(-60, 60, allow_subnormal=False))
)
"""One period of a curve at 11 to 51 equally spaced points, both ends given."""


def joined(values: Array) -> Array:
    """The samples with the average of both ends at both ends."""
    ends = (values[0] + values[-1]) / 2
    return np.array([ends, *values[1:-1], ends])


@LAW
@given(samples)
def test_curve_passes_through_every_sample(values: Array) -> None:
    curve = PeriodicCurve.through(values)
    s = np.linspace(0, 1, len(values))
    assert curve(s) == pytest.approx(joined(values), abs=1e-12 * 60)


@LAW
@given(samples)
def test_curve_has_the_lowest_degree_that_passes(values: Array) -> None:
    assert PeriodicCurve.through(values).degree == (len(values) - 1) // 2


@LAW
@given(samples, st.floats(-1, 2))
def test_curve_is_periodic_with_all_derivatives(values: Array, s: float) -> None:
    curve = PeriodicCurve.through(values)
    for order in (0, 1, 2):
        scale = 1e-12 * 60 * 50 * (2 * np.pi * 25) ** order
        assert curve(s + 1, order) == pytest.approx(curve(s, order), abs=scale)


@LAW
@given(samples, st.floats(0, 1))
def test_first_two_derivatives_are_those_of_the_curve(values: Array, s: float) -> None:
    curve, h = PeriodicCurve.through(values), 1e-5
    for order in (1, 2):
        near = curve(s + h, order - 1) - curve(s - h, order - 1)
        far = curve(s + 2 * h, order - 1) - curve(s - 2 * h, order - 1)
        scale = 60 * 50 * (2 * np.pi * 25) ** order
        assert curve(s, order) == pytest.approx((8 * near - far) / (12 * h), abs=1e-8 * scale)


@LAW
@given(samples, st.floats(0, 1), st.floats(-1, 1))
def test_coefficients_are_those_of_the_shifted_curve(values: Array, s: float, shift: float) -> None:
    curve = PeriodicCurve.through(values)
    cosine, sine = np.split(curve.coefficients(shift), 2)
    turns = 2 * math.pi * np.arange(MAX_HARMONICS + 1) * s
    value = cosine @ np.cos(turns) + sine @ np.sin(turns)
    assert value == pytest.approx(float(curve(s + shift)), abs=1e-12 * 3000)


def test_too_few_coefficients_are_refused() -> None:
    curve = PeriodicCurve((1.0, 2.0, 3.0), (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="degree = 1: the curve has 2 harmonics; ask for no fewer"):
        curve.coefficients(degree=1)


def test_curve_keeps_the_shape_of_its_argument() -> None:
    curve = PeriodicCurve.through(np.cos(np.linspace(0, 2 * np.pi, 12)))
    assert curve(0.5).shape == ()
    assert curve(np.zeros((2, 3)), 1).shape == (2, 3)


@pytest.mark.parametrize("source", BUILT_IN)
@pytest.mark.parametrize("signal", SIGNALS)
def test_packaged_tables_are_reproduced(source: str, signal: str) -> None:
    rows = packaged(source)
    percent = np.array([float(row["percent_stride"]) for row in rows])
    for curve, column, sign in zip(
        human_gait(source).curves[signal],
        SIGNALS[signal].columns,
        (SIGNALS[signal].sign, 1.0),
        strict=True,
    ):
        values = sign * np.array([float(row[column]) for row in rows])
        assert curve(percent / 100) == pytest.approx(joined(values), abs=1e-12 * 100)


def packaged(source: str) -> list[dict[str, str]]:
    path = Path(ergowalk.__file__).parent / BUILT_IN[source]
    lines = [line for line in path.read_text("utf-8").splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def test_both_ends_of_the_stride_give_the_average() -> None:
    curve = human_gait("winter-natural").curves["knee_angle"][0]
    first, *_, last = (float(r["knee_flexion_angle_mean_deg"]) for r in packaged("winter-natural"))
    assert first != last
    assert curve([0.0, 1.0]) == pytest.approx(2 * [(first + last) / 2], abs=1e-12)


def test_moments_come_in_the_models_signs() -> None:
    gait = human_gait("winter-natural")
    assert gait.curves["ankle_moment"][0](0.48) == pytest.approx(-1.628)  # p < 0: plantarflexion
    assert gait.curves["hip_moment"][0](0.02) == pytest.approx(-0.600)  # q < 0: extension
    assert gait.curves["knee_moment"][0](0.14) == pytest.approx(0.615)  # u > 0: extension


@LAW
@given(st.floats(0.1, 5.0), st.floats(0, 1))
def test_corridor_is_as_wide_as_asked(width: float, s: float) -> None:
    gait = human_gait("winter-natural")
    mean, sd = gait.curves["hip_angle"]
    corridor = gait.corridor("hip_angle", width)
    assert corridor.upper(s) == pytest.approx(mean(s) + width * sd(s), abs=1e-11)
    assert corridor.lower(s) == pytest.approx(mean(s) - width * sd(s), abs=1e-11)


def test_angle_corridor_is_the_corridor_in_radians() -> None:
    gait, s = human_gait("winter-slow"), np.linspace(0, 1, 201)
    for joint in ANGLES:
        degrees, radians = gait.corridor(f"{joint}_angle", 2.0), gait.angle_corridor(joint, 2.0)
        for order in (0, 1, 2):
            expected = np.radians(degrees.lower(s, order))
            assert radians.lower(s, order) == pytest.approx(expected, rel=1e-12, abs=1e-10)
            expected = np.radians(degrees.upper(s, order))
            assert radians.upper(s, order) == pytest.approx(expected, rel=1e-12, abs=1e-10)


@pytest.mark.parametrize("source", BUILT_IN)
def test_packaged_corridors_are_open_between_the_rows_too(source: str) -> None:
    s = np.linspace(0, 1, 5001)
    for joint in ANGLES:
        corridor = human_gait(source).angle_corridor(joint, 1.0)
        assert (corridor.upper(s) - corridor.lower(s)).min() > math.radians(4)


def test_curves_combine_linearly() -> None:
    a, b = PeriodicCurve((1.0, 2.0), (0.0, 3.0)), PeriodicCurve((4.0, 5.0), (0.0, 6.0))
    assert a.combined(b, -2.0) == PeriodicCurve((-7.0, -8.0), (0.0, -9.0))
    assert Corridor(a, b).upper == PeriodicCurve((5.0, 7.0), (0.0, 9.0))


# tables of a user

COLUMNS = [column for joint in ANGLES for column in SIGNALS[f"{joint}_angle"].columns]


def write_table(path: Path, rows: int = 51, **cells: Any) -> Path:
    """A table of smooth angles with SD 5; ``cells`` maps a column to its cells, or to None."""
    turn = 2 * np.pi * np.linspace(0, 1, rows)
    columns: dict[str, Any] = {"percent_stride": np.linspace(0, 100, rows)}
    for i, name in enumerate(COLUMNS):
        columns[name] = np.full(rows, 5.0) if "_sd_" in name else 20 * np.sin(turn + i)
    columns.update(cells)
    columns = {name: values for name, values in columns.items() if values is not None}
    lines = [",".join(columns)]
    lines += [",".join(map(str, row)) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def test_users_table_gives_the_curves_of_its_columns(tmp_path: Path) -> None:
    gait = human_gait(str(write_table(tmp_path / "mine.csv")))
    assert sorted(gait.curves) == ["ankle_angle", "hip_angle", "knee_angle"]
    s = np.linspace(0, 1, 501)
    assert gait.curves["hip_angle"][0](s) == pytest.approx(20 * np.sin(2 * np.pi * s), abs=1e-12)
    assert gait.angle_corridor("knee", 2.0).upper(0.3) - gait.angle_corridor("knee", 2.0).lower(
        0.3
    ) == pytest.approx(math.radians(20))


def test_relative_path_starts_in_the_given_folder(tmp_path: Path) -> None:
    write_table(tmp_path / "mine.csv")
    assert human_gait("mine.csv", tmp_path).name == "mine.csv"


@pytest.mark.parametrize("rows", [11, 12, 101, 201])
def test_tables_of_other_lengths_work(tmp_path: Path, rows: int) -> None:
    gait = human_gait(str(write_table(tmp_path / "mine.csv", rows)))
    s = np.linspace(0, 1, rows)
    assert gait.curves["hip_angle"][0](s) == pytest.approx(20 * np.sin(2 * np.pi * s), abs=1e-12)
    assert gait.curves["hip_angle"][0].degree <= MAX_HARMONICS


def test_finer_tables_are_fitted_by_least_squares(tmp_path: Path) -> None:
    """Harmonics beyond 25 are dropped, the others are not bent by them."""
    s = np.linspace(0, 1, 101)
    wave = 20 * np.sin(2 * np.pi * s) + 3 * np.cos(2 * np.pi * 30 * s)
    path = write_table(tmp_path / "fine.csv", 101, hip_flexion_angle_mean_deg=wave)
    curve = human_gait(str(path)).curves["hip_angle"][0]
    assert curve(s) == pytest.approx(20 * np.sin(2 * np.pi * s), abs=1e-12)


def test_byte_order_mark_and_comments_are_skipped(tmp_path: Path) -> None:
    path = write_table(tmp_path / "mine.csv")
    path.write_text("# from a spreadsheet\n\n" + path.read_text("utf-8"), "utf-8-sig")
    assert len(human_gait(str(path)).curves) == 3
    path.write_text(write_table(tmp_path / "x.csv").read_text("utf-8"), "utf-8-sig")
    assert len(human_gait(str(path)).curves) == 3


def spoiled(row: int, value: object, base: float = 5.0) -> list[object]:
    cells: list[object] = [base] * 51
    cells[row] = value
    return cells


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ({"knee_flexion_angle_sd_deg": None}, r"knee_flexion_angle_sd_deg: column is missing; the"),
        ({"percent_stride": None}, r"percent_stride: column is missing; the table needs percent"),
        (
            {"hip_flexion_angle_mean_deg": spoiled(6, "nan")},
            r"hip_flexion_angle_mean_deg = 'nan': must be a finite number \(data row 7\); fill",
        ),
        (
            {"hip_flexion_angle_mean_deg": spoiled(0, "")},
            r"hip_flexion_angle_mean_deg = '': must be a finite number \(data row 1\)",
        ),
        (
            {"ankle_dorsiflexion_angle_mean_deg": spoiled(50, "inf")},
            r"must be a finite number \(data row 51\)",
        ),
        (
            {"ankle_dorsiflexion_angle_sd_deg": spoiled(3, 0.0)},
            r"ankle_dorsiflexion_angle_sd_deg = 0\.0: must be positive \(data row 4\); give",
        ),
        ({"hip_flexion_angle_sd_deg": spoiled(3, -1.0)}, r"sd_deg = -1\.0: must be positive"),
        (
            {"hip_flexion_angle_sd_deg": spoiled(25, 500.0)},
            r"hip_flexion_angle_sd_deg: is so ragged that its curve falls to -\d.* smooth",
        ),
        (
            {"percent_stride": [*range(0, 100, 2), 99]},
            r"percent_stride = \[0\.0, 2\.0, 4\.0\]: must run from 0 to 100 in equal steps",
        ),
        ({"percent_stride": list(range(51))}, r"must run from 0 to 100 in equal steps, with 11"),
        ({"percent_stride": spoiled(4, "x")}, r"percent_stride = 'x': must be a finite number"),
    ],
)
def test_unusable_table_is_refused_with_its_name(
    tmp_path: Path, cells: dict[str, Any], message: str
) -> None:
    path = write_table(tmp_path / "mine.csv", **cells)
    with pytest.raises(CorridorError, match=message) as caught:
        human_gait(str(path))
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_too_short_a_table_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CorridorError, match="with 11 rows or more; resample"):
        human_gait(str(write_table(tmp_path / "short.csv", 10)))


def test_row_that_ends_early_is_refused(tmp_path: Path) -> None:
    path = write_table(tmp_path / "mine.csv")
    path.write_text(path.read_text("utf-8").rstrip("\n").rsplit(",", 1)[0], "utf-8")
    with pytest.raises(CorridorError, match=r"sd_deg: must be a finite number \(data row 51\)"):
        human_gait(str(path))


def test_zero_deviation_of_a_reaction_is_allowed(tmp_path: Path) -> None:
    mean, sd = SIGNALS["reaction_y"].columns
    cells: dict[str, Any] = {mean: [1.0] * 51, sd: [0.0] * 51}
    path = write_table(tmp_path / "mine.csv", **cells)
    assert human_gait(str(path)).corridor("reaction_y").upper(0.5) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (bytes(range(256)), r"cannot be read \(not a text file\); give the path of a CSV table or"),
        (b"\x00\x00,\x00\n\x00", "percent_stride: column is missing"),
        (b"", "percent_stride: column is missing"),
        (b"percent_stride", "hip_flexion_angle_mean_deg: column is missing"),
        (b"a" * 200_000, "is no table .*field limit.*; give a CSV table with a header line"),
        (",".join(["percent_stride", *COLUMNS]).encode(), "must run from 0 to 100 in equal steps"),
    ],
)
def test_file_that_is_no_table_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "mine.csv"
    path.write_bytes(content)
    with pytest.raises(CorridorError, match=message):
        human_gait(str(path))


@pytest.mark.parametrize("source", ["nowhere.csv", "winter", "\0", ""])
def test_path_that_leads_to_no_file_is_refused(tmp_path: Path, source: str) -> None:
    with pytest.raises(CorridorError, match=r"corridors.source = .*cannot be read.*winter-fast"):
        human_gait(source, tmp_path)


def test_folder_instead_of_a_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CorridorError, match="cannot be read .*give the path of a CSV table"):
        human_gait(str(tmp_path))


def test_corridor_of_a_signal_the_table_lacks_is_refused(tmp_path: Path) -> None:
    gait = human_gait(str(write_table(tmp_path / "mine.csv")))
    message = r"mine.csv: has no columns hip_power_mean_w_per_kg and hip_power_sd_w_per_kg; add"
    with pytest.raises(CorridorError, match=message):
        gait.corridor("hip_power")
