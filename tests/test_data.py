"""The packaged tables of Winter (1991): the right bytes, the right cells, the right signs."""

from __future__ import annotations

import csv
import hashlib
from functools import cache
from importlib import resources

import numpy as np
import pytest
from numpy.typing import NDArray

from ergowalk.corridors import ANGLES, BUILT_IN, SIGNALS

FOLDER = resources.files("ergowalk").joinpath("data/winter1991")

CADENCES = ("slow", "natural", "fast")

GRAVITY = 9.81


@cache
def table(cadence: str) -> dict[str, NDArray[np.float64]]:
    """Columns of a table, read here without the package's own reader."""
    text = FOLDER.joinpath(f"{cadence}.csv").read_text("utf-8")
    header, *rows = csv.reader(line for line in text.splitlines() if not line.startswith("#"))
    return dict(zip(header, np.array(rows, dtype=float).T, strict=True))


def mean(cadence: str, signal: str) -> NDArray[np.float64]:
    """Mean of a signal in the table's sign."""
    return table(cadence)[SIGNALS[signal].columns[0]]


def peak(values: NDArray[np.float64]) -> tuple[object, object]:
    """Largest value and its percentage of the stride."""
    return float(values.max()), 2 * int(values.argmax())


def test_files_are_those_of_the_checksums() -> None:
    lines = FOLDER.joinpath("SHA256SUMS").read_text("utf-8").splitlines()
    sums = {name: digest for digest, name in (line.split() for line in lines)}
    assert set(sums) == {f"{cadence}.csv" for cadence in CADENCES}
    for name, digest in sums.items():
        assert hashlib.sha256(FOLDER.joinpath(name).read_bytes()).hexdigest() == digest


def test_every_built_in_source_has_a_file() -> None:
    for name, path in BUILT_IN.items():
        assert resources.files("ergowalk").joinpath(path).is_file(), name


@pytest.mark.parametrize("cadence", CADENCES)
def test_table_has_51_rows_of_11_signals(cadence: str) -> None:
    columns = table(cadence)
    signals = [column for signal in SIGNALS.values() for column in signal.columns]
    assert len(SIGNALS) == 11
    assert sorted(columns) == sorted(["percent_stride", *signals])
    assert columns["percent_stride"].tolist() == list(range(0, 101, 2))
    assert all(np.isfinite(values).all() for values in columns.values())


@pytest.mark.parametrize(
    ("cadence", "signal", "which", "percent", "value"),
    [
        ("natural", "knee_angle", "mean", 58, 32.03),
        ("natural", "reaction_y", "sd", 54, 1.81),
        ("fast", "hip_angle", "mean", 92, 17.86),
        ("natural", "ankle_angle", "mean", 56, -3.26),
    ],
)
def test_misread_cells_are_corrected_and_the_table_says_so(
    cadence: str, signal: str, which: str, percent: int, value: float
) -> None:
    column = SIGNALS[signal].columns[("mean", "sd").index(which)]
    assert table(cadence)[column][percent // 2] == value
    comments = FOLDER.joinpath(f"{cadence}.csv").read_text("utf-8")
    assert f"cell: {SIGNALS[signal].stem} {which} at {percent} %: {value}" in comments


def test_knee_flexion_is_positive() -> None:
    assert peak(mean("natural", "knee_angle")) == (pytest.approx(64.9, abs=0.05), 72)
    for cadence in CADENCES:
        assert peak(mean(cadence, "knee_angle"))[1] in (70, 72)


def test_hip_flexion_and_ankle_dorsiflexion_are_positive() -> None:
    for cadence in CADENCES:
        hip, ankle = mean(cadence, "hip_angle"), mean(cadence, "ankle_angle")
        assert hip[0] > 15  # the leg reaches forward at heel contact
        assert 50 <= 2 * hip.argmin() <= 54  # and trails before toe-off
        assert 2 * ankle.argmin() in (62, 64, 66)  # the foot points at toe-off


def test_plantarflexor_moment_is_positive() -> None:
    assert peak(mean("natural", "ankle_moment")) == (pytest.approx(1.63, abs=0.005), 48)
    for cadence in CADENCES:
        assert peak(mean(cadence, "ankle_moment"))[1] == 48


def test_vertical_reaction_has_two_humps_above_body_weight() -> None:
    force = mean("natural", "reaction_y") / GRAVITY
    assert peak(force[:20]) == (pytest.approx(1.10, abs=0.005), 14)
    assert force[20:].max() == pytest.approx(1.08, abs=0.005)
    assert 2 * (20 + int(force[20:].argmax())) == 48
    assert force[32:50].max() < 0.01  # swing


@pytest.mark.parametrize(
    ("cadence", "expected"), [("slow", 9.65), ("natural", 9.52), ("fast", 9.74)]
)
def test_both_legs_carry_the_weight_within_three_percent(cadence: str, expected: float) -> None:
    total = 2 * float(np.trapezoid(mean(cadence, "reaction_y"), dx=0.02))
    assert total == pytest.approx(expected, abs=0.005)
    assert total == pytest.approx(GRAVITY, rel=0.03)


def test_forward_reaction_brakes_first_and_pushes_later() -> None:
    for cadence in CADENCES:
        force = mean(cadence, "reaction_x")
        assert 2 * force.argmin() == 10
        assert 2 * force.argmax() in (50, 52)
        assert abs(float(np.trapezoid(force, dx=0.02))) < 0.12  # N/kg: the speed stays the same


@pytest.mark.parametrize(("joint", "expected"), [("hip", 0.989), ("knee", 0.996), ("ankle", 0.999)])
def test_moment_times_angular_velocity_is_the_power(joint: str, expected: float) -> None:
    """With the model's signs the moment works at the rate of the angle; the knee's moment u
    extends, against its flexion."""
    rate = np.gradient(np.radians(mean("natural", f"{joint}_angle")), 0.02 * 1.1396)
    turn = -1.0 if joint == "knee" else 1.0
    moment = SIGNALS[f"{joint}_moment"].sign * mean("natural", f"{joint}_moment")
    power = mean("natural", f"{joint}_power")
    assert np.corrcoef(moment * turn * rate, power)[0, 1] == pytest.approx(expected, abs=6e-4)
    assert np.polyfit(power, moment * turn * rate, 1)[0] == pytest.approx(1.0, abs=0.09)


def test_objective_of_the_tabulated_powers_is_the_human_benchmark() -> None:
    """(10) with both legs, 73.18 kg, stride 1.51 m in 1.1396 s: 100.7 J/m."""
    power = sum(np.abs(mean("natural", f"{joint}_power")) for joint in ANGLES)
    work = 2 * 73.18 * np.trapezoid(power, dx=0.02 * 1.1396)
    assert work / 1.51 == pytest.approx(100.7, abs=0.05)


@pytest.mark.parametrize("cadence", CADENCES)
def test_standard_deviations_are_positive_where_the_model_divides_by_them(cadence: str) -> None:
    columns = table(cadence)
    for signal in SIGNALS.values():
        deviation = columns[signal.columns[1]]
        assert deviation.min() >= 0
        if signal.unit == "deg":
            assert deviation.min() > 2.5


def test_readme_tells_source_signs_columns_and_corrections() -> None:
    text = FOLDER.joinpath("README.md").read_text("utf-8")
    for signal in SIGNALS.values():
        assert f"`{signal.stem}`" in text
        assert f"`{signal.unit}`" in text
    for word in ("1991", "2nd edition", "32.03", "1.81", "17.86", "copyrighted"):
        assert word in text
