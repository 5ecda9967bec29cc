"""Known answers of the comparison: gaits made of the human curves themselves."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from plots.synthetic import BODY, fractions, gait, human_signals

from ergowalk.comparison import (
    COMPARED,
    DEFAULT_SOURCE,
    body_of,
    compare,
    human_of,
    share_within_one,
    stride_curves,
    stride_mean,
)
from ergowalk.corridors import BUILT_IN, HumanGait, PeriodicCurve, human_gait
from ergowalk.errors import CorridorError, GaitFileError
from ergowalk.problem import Corridors

NAMES = [signal.name for signal in COMPARED]
SPREAD_ALL_ALONG = ["hip_angle", "knee_angle", "ankle_angle", "hip_moment"]


def flat(value: float) -> PeriodicCurve:
    return PeriodicCurve((value,), (0.0,))


def human_with(mean: PeriodicCurve, sd: PeriodicCurve) -> HumanGait:
    """A table in which every compared signal has this mean and SD."""
    return HumanGait("made", dict.fromkeys(NAMES, (mean, sd)))


def constant_gait(**values: float):
    """A gait whose signals are constant, zero unless given."""
    levels = {name: values.get(name, 0.0) for name in NAMES}
    return gait({name: lambda s, v=level: np.full_like(s, v) for name, level in levels.items()})


@pytest.mark.parametrize("source", BUILT_IN)
def test_the_human_mean_is_at_no_distance_from_itself(source):
    human = human_gait(source)
    found = compare(gait(source=source), human)
    assert [signal.name for signal in found.signals] == NAMES
    assert found.missing == ()
    for signal in found.signals:
        assert signal.rms_sd == pytest.approx(0.0, abs=1e-9)
        assert (signal.inside_1sd, signal.inside_2sd) == pytest.approx((1.0, 1.0), abs=1e-12)
        assert signal.correlation == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("source", BUILT_IN)
@pytest.mark.parametrize("sds", [1.5, -1.5])
def test_one_and_a_half_sd_off_is_outside_one_and_inside_two(source, sds):
    human = human_gait(source)
    found = compare(gait(human_signals(human, sds), source=source), human)
    for name in SPREAD_ALL_ALONG:
        signal = found[name]
        assert signal.floored_share == 0.0
        assert signal.rms_sd == pytest.approx(1.5, abs=1e-9)
        assert signal.inside_1sd == 0.0
        assert signal.inside_2sd == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("sds", [1.0, -1.0])
def test_a_curve_on_the_bound_is_inside(sds):
    human = human_gait("winter-natural")
    found = compare(gait(human_signals(human, sds)), human)
    assert [s.inside_1sd for s in found.signals] == pytest.approx([1.0] * 8, abs=1e-12)


def test_angles_may_leave_a_corridor_by_the_tolerance_of_an_acceptable_gait():
    human = human_with(flat(0.0), flat(2.0))
    just, more = (compare(constant_gait(knee_angle=v), human) for v in (2.099, 2.101))
    assert just["knee_angle"].inside_1sd == 1.0
    assert more["knee_angle"].inside_1sd == 0.0
    moment = compare(constant_gait(knee_moment=2.001), human)["knee_moment"]
    assert moment.inside_1sd == 0.0


def test_a_vanishing_sd_counts_as_a_twentieth_of_its_largest_value():
    # SD 1 + cos: largest 2, so the floor is 0.1, and it applies where cos < -0.9
    human = human_with(flat(0.0), PeriodicCurve((1.0, 1.0), (0.0, 0.0)))
    found = compare(constant_gait(reaction_y=0.25, reaction_x=0.1), human)
    vertical, horizontal = found["reaction_y"], found["reaction_x"]
    assert vertical.floored_share == pytest.approx(np.arccos(0.9) / np.pi, abs=1e-3)
    # 0.25 is inside where 2 max(SD, 0.1) >= 0.25, that is where cos >= -0.875
    assert vertical.inside_2sd == pytest.approx(np.arccos(-0.875) / np.pi, abs=2e-3)
    assert horizontal.inside_1sd == pytest.approx(1.0, abs=1e-12)
    # integral of (0.1/(1 + cos))^2 up to the floor, then of 1
    edge = np.arccos(-0.9)
    t = np.tan(edge / 2)
    mean_square = (0.01 * (t / 2 + t**3 / 6) + np.pi - edge) / np.pi
    assert horizontal.rms_sd == pytest.approx(np.sqrt(mean_square), abs=2e-3)


def test_resampled_curves_give_the_same_numbers():
    human = human_gait("winter-natural")

    def signals():
        wave = human_signals(human, 0.7)
        return {
            name: lambda s, f=f, sd=human.curves[name][1]: f(s) + sd(s) * np.sin(6 * np.pi * s)
            for name, f in wave.items()
        }

    random = np.sort(np.random.default_rng(1).uniform(0, 1, 4000))
    grids = [
        np.linspace(0, 1, 2001),
        fractions(250),
        np.concatenate([[0.0], random, [1.0]]),
        np.repeat(np.linspace(0, 1, 2001), 2),
        np.linspace(0, 1, 2001) ** 1.5,
    ]
    rows = []
    for grid in grids:
        found = compare(gait(signals(), grid), human)
        rows.append([[s.rms_sd, s.inside_1sd, s.inside_2sd, s.correlation] for s in found.signals])
    for row in rows[1:]:
        np.testing.assert_allclose(row, rows[0], atol=2e-3)
    spread = np.array([NAMES.index(name) for name in SPREAD_ALL_ALONG])
    rms = np.array(rows[0])[spread, 0]  # sqrt(0.7^2 + 1/2)
    np.testing.assert_allclose(rms, np.sqrt(0.99), atol=1e-4)


def test_a_jump_at_an_instant_that_stands_twice_has_no_width():
    half = np.concatenate([np.linspace(0, 0.5, 7), np.linspace(0.5, 1, 300)])
    jump = np.where(np.arange(len(half)) < 7, 0.0, 3.0)
    human = human_with(flat(0.0), flat(1.0))
    dataset = gait(fraction=half)
    dataset["joint_moment"].loc[{"leg": 1, "joint": "knee"}] = BODY.total_mass * jump
    found = compare(dataset, human)["knee_moment"]
    assert found.rms_sd == pytest.approx(3 / np.sqrt(2), abs=1e-12)
    assert found.inside_1sd == pytest.approx(0.5, abs=1e-12)
    assert found.inside_2sd == pytest.approx(0.5, abs=1e-12)


def test_an_outlier_between_two_equal_instants_has_no_weight():
    fraction = np.array([0.0, 0.25, 0.25, 0.25, 1.0])
    assert stride_mean(fraction, np.array([2.0, 2.0, 1e6, 2.0, 2.0])) == pytest.approx(2.0)
    assert share_within_one(fraction, np.array([0.5, 0.5, 1e6, 0.5, 0.5])) == pytest.approx(1.0)


@given(
    st.lists(st.floats(0.001, 0.999), min_size=0, max_size=30),
    st.floats(-5, 5),
    st.floats(-5, 5),
)
def test_the_share_of_a_straight_line_does_not_depend_on_the_sampling(inner, start, end):
    assume(min(abs(abs(start) - 1), abs(abs(end) - 1), abs(end - start)) > 1e-9)
    coarse = np.array([0.0, 1.0])
    fine = np.array([0.0, *sorted(inner), 1.0])
    expected = share_within_one(coarse, np.array([start, end]))
    found = share_within_one(fine, start + (end - start) * fine)
    assert found == pytest.approx(expected, abs=1e-9)


def test_the_share_of_known_lines():
    ends = np.array([0.0, 1.0])
    assert share_within_one(ends, np.array([0.0, 2.0])) == pytest.approx(0.5)
    assert share_within_one(ends, np.array([-3.0, 3.0])) == pytest.approx(1 / 3)
    assert share_within_one(ends, np.array([2.0, 1.5])) == 0.0
    assert share_within_one(ends, np.array([1.0, 1.0])) == 1.0


def test_extremes_are_told_with_their_instants():
    def wave(s):
        return 5.0 + 2.0 * np.sin(2 * np.pi * s)

    dataset = gait({**human_signals(human_gait("winter-natural")), "hip_moment": wave})
    found = compare(dataset, human_gait("winter-natural"))["hip_moment"].gait
    assert (found.min, found.max) == pytest.approx((3.0, 7.0), abs=1e-3)
    assert found.max_at_percent == pytest.approx(25.0, abs=1.0)
    assert found.min_at_percent == pytest.approx(75.0, abs=1.0)
    human = compare(dataset, human_gait("winter-natural"))["reaction_y"].human
    assert human.max == pytest.approx(10.82, abs=0.02)  # the table's peak, at 14 %
    assert human.max_at_percent == pytest.approx(14.0, abs=0.5)


def test_forces_and_moments_are_per_total_mass_and_of_leg_1():
    dataset = gait()
    dataset["ground_reaction_force"].loc[{"leg": 1, "axis": "y"}] = 73.18 * 9.81
    dataset["ground_reaction_force"].loc[{"leg": 2}] = 1e5
    values = stride_curves(dataset).values["reaction_y"]
    np.testing.assert_allclose(values, 9.81, rtol=1e-12)  # 73.18 kg is the paper's body


def test_the_mirrored_gait_compares_like_its_other_leg():
    human = human_gait("winter-natural")
    later = human_signals(human, 0.3)
    shifted = {name: lambda s, f=f: f((s + 0.5) % 1.0) for name, f in later.items()}
    mirrored = gait(shifted)
    mirrored = mirrored.assign_coords(leg=[2, 1])
    for ours, theirs in zip(
        compare(gait(later), human).signals, compare(mirrored, human).signals, strict=True
    ):
        assert theirs.rms_sd == pytest.approx(ours.rms_sd, abs=1e-6)


def test_signals_without_human_mean_and_sd_are_named_and_left_out():
    curves = {n: human_gait("winter-natural").curves[n] for n in NAMES if n.endswith("angle")}
    curves["reaction_x"] = flat(0.0), flat(0.0)
    found = compare(gait(), HumanGait("angles.csv", curves))
    assert [s.name for s in found.signals] == ["hip_angle", "knee_angle", "ankle_angle"]
    assert found.missing == tuple(NAMES[3:])
    assert "no mean and SD in angles.csv: reaction_x, reaction_y, hip_moment" in found.table()
    with pytest.raises(KeyError, match="hip_moment"):
        found["hip_moment"]


def test_the_dictionary_is_json_and_nan_is_null():
    found = compare(constant_gait(), human_with(flat(0.0), flat(1.0)))
    text = json.dumps(found.as_dict(), allow_nan=False)
    signal = json.loads(text)["signals"]["hip_angle"]
    assert signal["correlation"] is None
    assert signal["rms_sd"] == 0.0
    assert signal["gait"]["max"] == 0.0
    assert "name" not in signal


def test_the_table_is_plain_text_with_a_line_per_signal():
    table = compare(gait(), human_gait("winter-natural")).table()
    assert table.isascii()
    lines = table.splitlines()
    assert lines[0] == "leg 1 against winter-natural, mean +- SD between people"
    assert len(lines) == 2 + 8 + 1
    assert len({len(line) for line in lines[1:-1]}) == 1
    row = next(line for line in lines if line.startswith("knee angle mu^k [deg]"))
    cells = ["0.00 SD", "100%", "100%", "1.00", "0.4 to 64.9", "0.4 to 64.9"]
    assert re.split(r" {2,}", row)[1:] == cells


def test_the_table_has_no_negative_zero():
    found = compare(constant_gait(reaction_y=-1e-9), human_with(flat(0.0), flat(1.0)))
    assert "0.00 to 0.00" in found.table()
    assert "-0.0" not in found.table()


def test_human_data_are_those_that_the_problem_names(tmp_path: Path):
    assert human_of(gait(source="winter-slow")).name == "winter-slow"
    dataset = gait()
    dataset.attrs["problem"] = "step_length_m = 0.76"
    assert human_of(dataset).name == DEFAULT_SOURCE == Corridors().source
    rows = ["percent_stride," + ",".join(_columns())]
    rows += [f"{p}," + ",".join(["10.0,2.0"] * 3) for p in range(0, 101, 10)]
    (tmp_path / "own.csv").write_text("\n".join(rows))
    dataset.attrs["problem"] = '[corridors]\nsource = "own.csv"'
    mean, _ = human_of(dataset, tmp_path).curves["hip_angle"]
    assert mean(0.3) == pytest.approx(10.0)
    with pytest.raises(CorridorError, match=r"own.csv.*cannot be read"):
        human_of(dataset, tmp_path / "elsewhere")


def _columns():
    stems = ("hip_flexion_angle", "knee_flexion_angle", "ankle_dorsiflexion_angle")
    return [f"{stem}_{what}_deg" for stem in stems for what in ("mean", "sd")]


@pytest.mark.parametrize("text", ["[corridors", "corridors = 3", "[corridors]\nsource = 7", None])
def test_a_problem_that_names_no_human_data_is_refused(text):
    dataset = gait()
    dataset.attrs.pop("problem") if text is None else dataset.attrs.update(problem=text)
    with pytest.raises(GaitFileError, match="attribute problem: must be TOML text with a table"):
        human_of(dataset)


@pytest.mark.parametrize("text", ["{", "[1, 2]", '{"m": -1}', '{"mass": 70}', '{"m": "x"}', None])
def test_a_body_that_cannot_be_is_refused(text):
    dataset = gait()
    if text is None:
        del dataset.attrs["body_parameters"]
    else:
        dataset.attrs["body_parameters"] = text
    with pytest.raises(GaitFileError, match="attribute body_parameters: must be a JSON object"):
        body_of(dataset)


def test_the_body_survives_the_file():
    assert body_of(gait()) == BODY


def test_gaits_that_cannot_be_compared_are_refused():
    human = human_gait("winter-natural")
    with pytest.raises(GaitFileError, match="joint_moment: must be there as numbers over time"):
        compare(gait().drop_vars("joint_moment"), human)
    with pytest.raises(GaitFileError, match="joint = hip; give a file"):
        compare(gait().sel(joint=["knee", "ankle"]), human)
    broken = gait()
    broken["joint_angle"][5, 0, 1] = np.nan
    with pytest.raises(GaitFileError, match="joint_angle: must be finite"):
        compare(broken, human)
    backwards = gait()
    backwards = backwards.assign_coords(time=backwards.time.values[::-1])
    with pytest.raises(GaitFileError, match="time: must run from 0 to the stride time"):
        compare(backwards, human)
