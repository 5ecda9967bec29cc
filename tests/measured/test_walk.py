"""A made-up walk of known curves comes back from its markers and forces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ergowalk.corridors import human_gait
from ergowalk.errors import RecordingError
from ergowalk.measured.choices import Choices
from ergowalk.measured.walk import MeasuredWalk, measure
from ergowalk.recording import Plate, Recording
from made_up_walk import BODY, NAMES, STRIDE, recording, walker, without_plates

KNOWN = walker()
WHOLE = recording(KNOWN, unit="mm")
CHOICES = Choices(mass_kg=BODY.total_mass, cutoff_hz=20.0)


@pytest.fixture(scope="module")
def walk() -> MeasuredWalk:
    """The made-up walk, measured."""
    return measure(WHOLE, CHOICES)


def test_angles_come_back(walk: MeasuredWalk) -> None:
    human = human_gait("winter-natural")
    start = walk.strides[0].start
    fraction = np.linspace(0, 1, 101) + float(np.interp(start, KNOWN.time, KNOWN.time)) / STRIDE
    for joint, offset in (("hip", 0.0), ("knee", 0.0), ("ankle", None)):
        mean = walk.curve(f"{joint}_angle")
        assert mean is not None
        known = human.curves[f"{joint}_angle"][0](fraction - 0.3)
        error = np.degrees(mean[0]) - known
        if offset is None:  # a foot of the human means is not quite flat in the middle of stance
            error = error - error.mean()
        assert np.abs(error).max() < 0.35, joint  # degrees: what 20 Hz take from the means


def test_lengths_step_and_time_come_back(walk: MeasuredWalk) -> None:
    leg = BODY.leg(0)
    assert walk.lengths.thigh == pytest.approx(leg.thigh_length, abs=1e-4)
    assert walk.lengths.shank == pytest.approx(leg.shank_length, abs=1e-4)
    assert walk.stride_time.mean == pytest.approx(STRIDE, abs=1e-3)
    hip = KNOWN.points["right"]["hip"][:, 0]
    n = round(STRIDE * 100)
    assert walk.step_length.mean == pytest.approx((hip[50 + n] - hip[50]) / 2, abs=1e-3)
    assert walk.stride_time.sd < 1e-3


def test_both_legs_give_the_same(walk: MeasuredWalk) -> None:
    sides = {side: [s for s in walk.strides if s.side == side] for side in ("right", "left")}
    first, second = (sides[side][0] for side in sides)
    for name in ("hip_angle", "knee_moment", "ankle_power", "reaction_y"):
        np.testing.assert_allclose(
            first.curves[name], second.curves[name],
            atol=0.02 * np.abs(first.curves[name]).max(),  # resampling between frames
        )  # fmt: skip


def test_the_direction_of_the_walk_changes_nothing(walk: MeasuredWalk) -> None:
    back = measure(recording(KNOWN, direction=-1.0, unit="mm"), CHOICES)
    assert back.trial.plane.forward @ walk.trial.plane.forward == pytest.approx(-1.0)
    for name in ("hip_angle", "ankle_moment", "knee_power", "reaction_x"):
        one, other = walk.curve(name), back.curve(name)
        assert one is not None
        assert other is not None
        np.testing.assert_allclose(other[0], one[0], atol=1e-9)


def test_units_change_nothing(walk: MeasuredWalk) -> None:
    metres = measure(recording(KNOWN, unit="m"), CHOICES)
    assert metres.energy_per_metre is not None
    assert walk.energy_per_metre is not None
    assert metres.energy_per_metre.mean == pytest.approx(walk.energy_per_metre.mean)


def test_the_plates_weigh_the_person() -> None:
    """Winter's mean reactions of two legs carry 3 % less than the weight."""
    mass = measure(WHOLE, CHOICES.replace(mass_kg=None)).body.total_mass
    assert mass == pytest.approx(0.97 * BODY.total_mass, rel=0.01)


def test_energy_is_the_work_of_all_joints_over_the_way(walk: MeasuredWalk) -> None:
    energy = walk.energy_per_metre
    assert energy is not None
    total = 0.0
    for stride in walk.strides:
        time = np.linspace(0, stride.duration, 101)
        joints = [np.abs(stride.curves[f"{j}_power"]) for j in ("hip", "knee", "ankle")]
        total += 2 * float(np.trapezoid(sum(joints), time)) / stride.length
    assert energy.mean == pytest.approx(total / len(walk.strides), rel=0.01)
    assert sum(walk.energy_by_joint().values()) == pytest.approx(energy.mean)


def test_a_leg_in_the_air_obeys_newton(walk: MeasuredWalk) -> None:
    """Force at the hip = mass times acceleration of the leg's centre of mass, less weight."""
    record, rate, g = walk.legs["right"], walk.trial.rate, walk.body.gravity_m_s2
    leg, p = walk.trial.legs["right"], walk.body.leg(0)
    shares = (
        (p.thigh_mass, leg["hip"], leg["knee"], p.thigh_com / p.thigh_length),
        (p.shank_mass, leg["knee"], leg["ankle"], p.shank_com / p.shank_length),
        (p.foot_mass, leg["ankle"], leg["metatarsal"], 0.5),
    )
    momentum = sum(m * np.gradient(a + s * (b - a), 1 / rate, axis=0) for m, a, b, s in shares)
    mass = p.thigh_mass + p.shank_mass + p.foot_mass
    expected = np.gradient(momentum, 1 / rate, axis=0)[:, :2] + [0.0, mass * g]
    found = record.loads.forces["hip"] + record.load.load[:, :2]
    np.testing.assert_allclose(found, expected, atol=1e-9 * mass * g)


def test_power_is_the_rate_of_mechanical_energy(walk: MeasuredWalk) -> None:
    """Of a leg: joints, hip force and ground force together do what its energy gains."""
    record, rate, g = walk.legs["left"], walk.trial.rate, walk.body.gravity_m_s2
    leg, p = walk.trial.legs["left"], walk.body.leg(1)
    rates = record.angles.relative_rates(rate)
    swing = record.load.load[:, 1] == 0
    inner = swing & np.roll(swing, 8) & np.roll(swing, -8)
    inner[:20] = inner[-20:] = False

    def rate_of(values):
        return np.gradient(values, 1 / rate, axis=0)

    foot = np.linalg.norm((leg["ankle"] - leg["metatarsal"])[:, :2], axis=1).mean()
    parts = (
        (p.thigh_mass, leg["hip"], leg["knee"], p.thigh_com / p.thigh_length,
         p.thigh_inertia - p.thigh_mass * p.thigh_com**2),
        (p.shank_mass, leg["knee"], leg["ankle"], p.shank_com / p.shank_length,
         p.shank_inertia - p.shank_mass * p.shank_com**2),
        (p.foot_mass, leg["ankle"], leg["metatarsal"], 0.5, p.foot_mass * (0.475 * foot) ** 2),
    )  # fmt: skip
    energy = 0.0
    for mass, upper, lower, share, inertia in parts:
        centre = (upper + share * (lower - upper))[:, :2]
        line = (lower - upper)[:, :2]
        spin = rate_of(np.unwrap(np.arctan2(line[:, 0], -line[:, 1])))
        energy = energy + mass * g * centre[:, 1] + inertia * spin**2 / 2
        energy = energy + mass * (rate_of(centre) ** 2).sum(axis=1) / 2
    moments = record.loads.moments
    hip = moments["hip"] * rate_of(record.angles.thigh)
    joints = hip + sum(moments[j] * rates[j] for j in ("knee", "ankle"))
    pull = (record.loads.forces["hip"] * rate_of(leg["hip"])[:, :2]).sum(axis=1)
    gained = rate_of(energy)[inner]
    assert np.abs((joints + pull)[inner] - gained).max() < 0.04 * np.abs(gained).max()


# What is wrong with a recording is one sentence


def changed(**markers: np.ndarray) -> Recording:
    """The walk with other markers."""
    return replace(WHOLE, markers={**WHOLE.markers, **markers})


def lost(name: str, start: int, end: int) -> Recording:
    """The walk with a marker unseen."""
    values = WHOLE.markers[name].copy()
    values[start:end] = np.nan
    return changed(**{name: values})


def test_short_gaps_are_filled_and_told() -> None:
    found = measure(lost("RKJC", 150, 160), CHOICES)
    assert any("RKJC is lost for 10 frames at most: filled in" in note for note in found.notes)
    whole, filled = measure(WHOLE, CHOICES).curve("knee_angle"), found.curve("knee_angle")
    assert whole is not None
    assert filled is not None
    assert np.degrees(np.abs(whole[0] - filled[0])).max() < 1.0  # a tenth of a second by a spline


def test_long_gaps_leave_the_longest_piece() -> None:
    found = measure(lost("RKJC", 250, 300), CHOICES)
    assert any("all points are there from 0.000 to 2.490 s alone" in note for note in found.notes)


@pytest.mark.parametrize(
    ("recording", "choices", "match"),
    [
        (lost("RKJC", 30, 380), {}, "right knee: is seen in .* of the frames; no 0.5 s remain"),
        (lost("LCAL", 0, 401), {}, "LCAL: is hardly ever seen"),
        (replace(WHOLE, unit="m"), {}, "knee to ankle: is 530 m in m, which is no leg's"),
        (WHOLE, {"units": "m"}, "knee to ankle: is 530 m in m.*give --units mm, cm or m"),
        (recording(KNOWN, unit="m"), {"units": "mm"}, "is 0.00053 m in mm"),
        (WHOLE.flipped(), {}, "pushes the foot down: the plate is upside down.*--flip-forces"),
        (without_plates(WHOLE), {"mass_kg": None}, "has no force plates to weigh.*give --mass"),
        (WHOLE, {"mass_kg": 2.0}, "mass = 2.0: must lie between 20 and 300 kg"),
        (WHOLE, {"markers": "none"}, "markers = 'none': no such marker set; choose one of winter"),
        (WHOLE, {"markers": "winter"}, "of the set winter are missing: knee, ankle"),
    ],
)
def test_what_is_wrong_is_one_sentence(
    recording: Recording, choices: dict[str, object], match: str
) -> None:
    with pytest.raises(RecordingError, match=match) as raised:
        measure(recording, CHOICES.replace(**choices))
    assert "\n" not in str(raised.value)


def test_a_missing_marker_names_the_nearest_set() -> None:
    markers = {name: v for name, v in WHOLE.markers.items() if name != "LKJC"}
    with pytest.raises(RecordingError, match="nearest known set joint-centres are missing: LKJC"):
        measure(replace(WHOLE, markers=markers), CHOICES)


def test_exchanged_markers_are_noticed() -> None:
    knee, ankle = WHOLE.markers["RKJC"].copy(), WHOLE.markers["RAJC"].copy()
    knee[100:200], ankle[100:200] = ankle[100:200].copy(), knee[100:200].copy()
    with pytest.raises(RecordingError, match="changes its length by"):
        measure(changed(RKJC=knee, RAJC=ankle), CHOICES)


def test_forces_along_another_axis_are_noticed() -> None:
    turned = tuple(replace(p, force=p.force[:, [2, 1, 0]]) for p in WHOLE.plates)
    with pytest.raises(RecordingError, match=r"pushes along .* and up is \+z"):
        measure(replace(WHOLE, plates=turned), CHOICES)


def test_walking_backwards_is_refused() -> None:
    markers = {name: v[::-1] for name, v in WHOLE.markers.items()}
    with pytest.raises(RecordingError, match="the toes point away from where the hips go"):
        measure(replace(without_plates(WHOLE), markers=markers), CHOICES)


def test_standing_still_has_no_stride() -> None:
    markers = {name: np.tile(v[:1], (len(v), 1)) for name, v in WHOLE.markers.items()}
    with pytest.raises(RecordingError, match="no leg has a whole stance"):
        measure(replace(without_plates(WHOLE), markers=markers), CHOICES)


def test_a_stride_cut_short_is_no_stride() -> None:
    short = {name: v[:105] for name, v in WHOLE.markers.items()}
    piece = replace(without_plates(WHOLE), time=WHOLE.time[:105], markers=short)
    with pytest.raises(RecordingError, match="from heel contact to heel contact.*longer recording"):
        measure(piece, CHOICES)


def test_an_unstated_unit_is_found_by_the_shank() -> None:
    found = measure(replace(WHOLE, unit=None, plates=()), CHOICES)
    assert "the file states no unit of length: mm, by a shank of 0.53 m" in found.notes


def test_without_plates_there_are_angles_and_no_energy() -> None:
    found = measure(without_plates(WHOLE), CHOICES)
    assert found.energy_per_metre is None
    assert found.curve("hip_angle") is not None
    assert found.curve("hip_moment") is None


def test_a_zero_that_is_off_is_taken_off() -> None:
    off = np.array([3.0, -2.0, -18.0])
    plates = tuple(replace(p, force=p.force + off) for p in WHOLE.plates)
    found = measure(replace(WHOLE, plates=plates), CHOICES)
    assert any("shows -18 N unloaded: taken off" in note for note in found.notes)


def test_a_map_of_other_names_measures_the_same(tmp_path, walk: MeasuredWalk) -> None:
    renamed = {f"my{name}": values for name, values in WHOLE.markers.items()}
    lines = ['trunk = "myC7"', "shoulder = true"]
    for side in ("right", "left"):
        lines.append(f"[{side}]")
        lines += [f'{role} = "my{side[0].upper()}{name}"' for role, name in NAMES.items()]
    path = tmp_path / "map.toml"
    path.write_text("\n".join(lines))
    found = measure(replace(WHOLE, markers=renamed), CHOICES.replace(markers=str(path)))
    assert found.energy_per_metre is not None
    assert walk.energy_per_metre is not None
    assert found.energy_per_metre.mean == pytest.approx(walk.energy_per_metre.mean)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("x = ", "cannot be read as TOML"),
        ('[right]\nhip = "A"', "right.knee.*has no marker; a leg needs knee"),
        ("name = 'a'", "no leg has markers"),
        ('[right]\nshin = "A"', "right.shin: unknown key"),
    ],
)
def test_a_map_that_is_none_is_one_sentence(tmp_path, text: str, match: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(RecordingError, match=match):
        measure(WHOLE, CHOICES.replace(markers=str(path)))


def test_walking_towards_minus_x_in_the_plane_changes_nothing() -> None:
    """A table has x and y alone: mirrored, the same walk goes the other way."""
    flat = in_the_plane(1.0)
    back = in_the_plane(-1.0)
    for name in ("hip_angle", "knee_moment", "ankle_power", "reaction_x", "pressure"):
        one, other = measure(flat, CHOICES).curve(name), measure(back, CHOICES).curve(name)
        assert one is not None
        assert other is not None
        np.testing.assert_allclose(other[0], one[0], atol=1e-9)


def in_the_plane(direction: float) -> Recording:
    """The right leg of the walk as a table would have it."""
    names = {"hip": "hip", "knee": "knee", "ankle": "ankle", "heel": "heel", "metatarsal": "mt5"}
    turn = np.array([direction, 1.0])

    def placed(points: np.ndarray) -> np.ndarray:
        return np.concatenate([points * turn, np.zeros((len(points), 1))], axis=1)

    right = KNOWN.points["right"]
    markers = {name: placed(right[role]) for role, name in names.items()}
    force, point = placed(KNOWN.force["right"]), np.zeros((len(KNOWN.time), 3))
    point[:, 0] = direction * KNOWN.pressure["right"]
    plate = Plate("plate", KNOWN.time, force, np.zeros_like(force), point, "m")
    markers["rib_cage"] = placed(KNOWN.trunk)
    return Recording("table", KNOWN.time, markers, "m", (plate,), planar=True)


def test_a_leg_without_a_whole_stance_is_left_out() -> None:
    """From 0.2 to 1.6 s the right foot makes a stride; the left one is down at both ends."""
    markers = {name: v[20:161] for name, v in WHOLE.markers.items()}
    piece = replace(without_plates(WHOLE), time=WHOLE.time[20:161], markers=markers)
    found = measure(piece, CHOICES)
    assert {stride.side for stride in found.strides} == {"right"}
