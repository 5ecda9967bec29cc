"""Recordings whose answers are known: printed tables, and results of other software.

Data that may not be shipped are looked for in ``shared`` beside the checkout, or where
``ERGOWALK_SHARED`` says; without them these tests are skipped.
"""

from __future__ import annotations

import csv
import os
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ergowalk.body import Body
from ergowalk.measured.choices import Choices
from ergowalk.measured.dynamics import joint_loads
from ergowalk.measured.events import events_by_feet
from ergowalk.measured.filtering import low_pass
from ergowalk.measured.walk import MeasuredWalk, measure
from ergowalk.recording import read_recording

Array = NDArray[np.float64]

HERE = Path(__file__).parent
SHARED = Path(os.environ.get("ERGOWALK_SHARED", HERE.parents[2] / "shared"))
WINTER = SHARED / "data" / "winter_wm"
SAMPLES = SHARED / "data" / "samples"
GATK = HERE / "gatk_2d"
OPENSIM = SAMPLES / "opensim_gait10dof18musc"

needs_winter = pytest.mark.skipif(not WINTER.is_dir(), reason="printed tables are not shipped")
needs_samples = pytest.mark.skipif(not SAMPLES.is_dir(), reason="sample files are not shipped")

JOINTS = ("hip", "knee", "ankle")


def table(path: Path) -> dict[str, Array]:
    """Columns of a CSV file."""
    header, *rows = csv.reader(path.read_text("utf-8").splitlines())
    values = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    return dict(zip(header, values.T, strict=True))


def with_masses(body: Body, thigh: float, shank: float, foot: float) -> Body:
    """The body with these masses of segments and Dempster's shares of their lengths."""
    a, b = body.leg(0).thigh_length, body.leg(0).shank_length
    return body.replace(
        thigh_mass_kg=thigh, thigh_com_m=0.433 * a, thigh_inertia_kgm2=thigh * (0.540 * a) ** 2,
        shank_mass_kg=shank, shank_com_m=0.433 * b, shank_inertia_kgm2=shank * (0.528 * b) ** 2,
        foot_mass_kg=foot,
    )  # fmt: skip


# Subject WM, Winter (2009), appendix A: raw markers of table A.1 and forces of A.5.
# Segment lines: hip to knee, knee (lateral epicondyle) to ankle, ankle to metatarsals for the
# foot's inertia, heel to metatarsals for its rate in the power, hip to rib cage for the trunk. The
# filter of the tables takes off 3 dB at 4.95 Hz: there its positions are those of A.2 to 0.04 mm.

HEEL_CONTACT, TOE_OFF, NEXT_CONTACT = 28, 70, 97
"""Frames of the tables, the first of which is 1."""


@cache
def subject_wm() -> MeasuredWalk:
    whole = read_recording([WINTER / "wm_raw_markers.csv", WINTER / "wm_forces_moments.csv"])
    choices = Choices(mass_kg=56.7, cutoff_hz=4.95)
    subject = table_of_subject()
    body = with_masses(measure(whole, choices).body, *subject)
    return measure(whole, choices, body=body)


def table_of_subject() -> tuple[float, float, float]:
    rows = csv.DictReader((WINTER / "wm_subject.csv").read_text("utf-8").splitlines())
    values = {row["quantity"]: float(row["value"]) for row in rows}
    return values["thigh_mass"], values["shank_mass"], values["foot_mass"]


@needs_winter
@pytest.mark.parametrize(
    ("joint", "column"),
    [
        ("ankle", "ankle_moment_on_foot_Nm"),
        ("knee", "knee_moment_on_shank_Nm"),
        ("hip", "hip_moment_on_thigh_Nm"),
    ],
)
def test_moments_of_wm_are_those_of_the_tables(joint: str, column: str) -> None:
    """Within 1 N m over the whole stride, stance and swing, from raw markers and forces."""
    found = subject_wm().legs["right"].loads.moments[joint]
    stride = slice(HEEL_CONTACT - 1, NEXT_CONTACT)
    error = found - table(WINTER / "wm_forces_moments.csv")[column]
    assert np.abs(error[stride]).max() < 1.0


@needs_winter
@pytest.mark.parametrize("joint", JOINTS)
def test_powers_of_wm_are_those_of_the_tables(joint: str) -> None:
    """Within 2 W in stance (frames 28 to 70) and in the swing before it (from frame 12 on: the
    filter of the tables ran in on frames before the first printed one)."""
    record = subject_wm().legs["right"]
    power = (
        record.loads.moments[joint] * record.angles.relative_rates(subject_wm().trial.rate)[joint]
    )
    printed = table(WINTER / "wm_powers.csv")
    frames = printed["frame"].astype(int)
    error = (power[frames - 1] - printed[f"{joint}_power_W"])[frames >= 12]
    assert np.abs(error).max() < 2.0


@needs_winter
def test_stride_of_wm_is_that_of_the_tables() -> None:
    walk = subject_wm()
    assert walk.stride_time.mean == pytest.approx(0.987, abs=0.02)
    assert 2 * walk.step_length.mean == pytest.approx(1.398, abs=0.01)


# GaitAnalysisToolKit. Its reference was made with an effective cut-off of 4.0 Hz (there the angles
# agree to hundredths of a degree), with the mass fraction and radius of gyration of the foot for
# all three segments (0.0145 and 0.475: its forces grow by the same 0.142 N/kg from joint to joint),
# and with the foot along heel to metatarsals.

MASS = 67.2


@cache
def treadmill(own_masses: bool) -> MeasuredWalk:
    whole = read_recording([GATK / "rawdata.txt"])
    choices = Choices(mass_kg=MASS, cutoff_hz=4.0, force_cutoff_hz=4.0)
    walk = measure(whole, choices)
    if own_masses:
        return walk
    body, m = walk.body, 0.0145 * MASS
    a, b = body.leg(0).thigh_length, body.leg(0).shank_length
    share = 0.433**2 + 0.475**2
    return measure(whole, choices, body=with_masses(body, m, m, m).replace(
        thigh_inertia_kgm2=m * share * a**2, shank_inertia_kgm2=m * share * b**2))  # fmt: skip


REFERENCE = {
    "hip": ("hip_flexion", 1.0, 1.0),
    "knee": ("knee_flexion", 1.0, -1.0),
    "ankle": ("ankle_plantarflexion", -1.0, -1.0),
}
"""Name in the reference, and the signs of its angle and moment against ours."""

MIDDLE = slice(20, -20)
"""The filters treat the ends differently."""


@pytest.mark.parametrize("joint", JOINTS)
def test_angles_on_the_treadmill_are_those_of_the_reference(joint: str) -> None:
    name, sign, _ = REFERENCE[joint]
    reference = sign * table(GATK / "reference_results.csv")[f"{name}_angle_rad"]
    error = np.degrees(treadmill(True).legs["right"].angles.joints()[joint] - reference)[MIDDLE]
    # the zero of its ankle angle is the foot along the shank
    assert np.abs(error - error.mean()).max() < 0.15  # degrees
    assert abs(error.mean()) < 0.02 or joint == "ankle"


@pytest.mark.parametrize(("joint", "tolerance"), [("hip", 0.055), ("knee", 0.045), ("ankle", 0.03)])
def test_moments_on_the_treadmill_are_those_of_the_reference(joint: str, tolerance: float) -> None:
    """With its masses; N m/kg. What remains is the load that its filter smears over the contacts of
    the other foot's plate, and 2 N that the plate shows unloaded, 0.9 m below the hip."""
    name, _, sign = REFERENCE[joint]
    reference = table(GATK / "reference_results.csv")[f"{name}_moment_Nm_per_kg"]
    found = sign * treadmill(False).legs["right"].loads.moments[joint] / MASS
    assert np.abs((found - reference)[MIDDLE]).max() < tolerance


@pytest.mark.parametrize("joint", JOINTS)
def test_joint_forces_on_the_treadmill_are_those_of_the_reference(joint: str) -> None:
    reference = table(GATK / "reference_results.csv")
    found = treadmill(False).legs["right"].loads.forces[joint] / MASS
    for axis, column in enumerate("xy"):
        error = (found[:, axis] - reference[f"{joint}_force_{column}_N_per_kg"])[MIDDLE]
        assert np.sqrt(np.mean(error**2)) < 0.03  # N/kg


def test_true_masses_change_the_hip_moment_most() -> None:
    """What the reference's light thigh and shank leave out, N m/kg."""
    own, light = (treadmill(k).legs["right"].loads.moments for k in (True, False))
    change = {j: float(np.abs(own[j] - light[j])[MIDDLE].max()) / MASS for j in JOINTS}
    assert change["ankle"] < 1e-9
    assert change["hip"] > change["knee"] > 0.02


# Contacts: by the feet alone against the plates.


def sample(name: str) -> tuple[list[Path], Path | None]:
    """Files of a sample, and its static trial."""
    return {
        "treadmill": ([GATK / "rawdata.txt"], None),
        "wm": ([WINTER / "wm_raw_markers.csv", WINTER / "wm_forces_moments.csv"], None),
        "bmclab": ([SAMPLES / "bmclab" / "BiomecII2018_gait_n.txt"], None),
        "c3d": ([SAMPLES / "opensim_core_c3d" / "test_walking.c3d"], None),
        "opensim": (
            [OPENSIM / "subject01_walk.trc", OPENSIM / "subject01_walk_grf.mot"],
            OPENSIM / "subject01_static.trc",
        ),
    }[name]


@cache
def measured_sample(name: str) -> MeasuredWalk:
    files, static = sample(name)
    if not all(path.exists() for path in files):
        pytest.skip("sample files are not shipped")
    if name == "c3d":
        pytest.importorskip("ezc3d")
    standing = None if static is None else read_recording([static])
    mass = {"wm": 56.7, "treadmill": 67.2, "opensim": 72.6}.get(name, 70.0)
    return measure(read_recording(files), Choices(mass_kg=mass), standing)


@pytest.mark.parametrize("name", ["treadmill", "wm", "bmclab", "c3d", "opensim"])
def test_contacts_by_the_feet_are_those_of_the_plates_within_20_ms(name: str) -> None:
    """The weights of the two signs were chosen on all but the C3D file."""
    walk, compared = measured_sample(name), 0
    for side, leg in walk.legs.items():
        told, found = leg.load.events(), events_by_feet(walk.trial, side)
        for true, instants in (
            (told["contacts"], found.contacts),
            (told["toe_offs"], found.toe_offs),
        ):
            for instant in true:
                near = [t - instant for t in instants if abs(t - instant) < 0.1]
                compared += len(near)
                assert all(abs(difference) < 0.020 for difference in near), (side, instant)
    assert compared >= {"bmclab": 1, "wm": 2}.get(name, 3)


# OpenSim's reference of its planar model with ten degrees of freedom.


def storage(path: Path) -> dict[str, Array]:
    """Columns of a MOT or STO file."""
    lines = path.read_text("utf-8").splitlines()
    end = lines.index("endheader")
    rows = [[float(cell) for cell in line.split()] for line in lines[end + 2 :] if line.strip()]
    return dict(zip(lines[end + 1].split(), np.array(rows).T, strict=True))


def turned(angle: Array, x: float | Array, y: float | Array) -> Array:
    """(x, y) of a frame at ``angle`` (n,) in the laboratory (n, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x - s * y, s * x + c * y], axis=1)


KNEE_X = (
    [-2.0944, -1.74533, -1.39626, -1.0472, -0.698132, -0.349066, -0.174533, 0.197344],
    [-0.0032, 0.00179, 0.00411, 0.0041, 0.00212, -0.001, -0.0031, -0.005227],
)
KNEE_Y = (
    [-2.0944, -1.22173, -0.523599, -0.349066, -0.174533, 0.159149],
    [-0.4226, -0.4082, -0.399, -0.3976, -0.3966, -0.395264],
)
"""Knee angle [rad] and place of the knee in the unscaled femur [m], from the model file."""

OPENSIM_LEG = {
    "thigh_mass_kg": 8.984, "thigh_length_m": 0.4546, "thigh_com_m": 0.195,
    "thigh_inertia_kgm2": 0.1795 + 8.984 * 0.195**2,
    "shank_mass_kg": 3.581, "shank_length_m": 0.42506, "shank_com_m": 0.18456,
    "shank_inertia_kgm2": 0.04823 + 3.581 * 0.18456**2,
    "foot_mass_kg": 1.513,
}  # fmt: skip
"""Masses of the model: shank and talus from its file, the others in the same proportion to the
unscaled model."""


@cache
def opensim_centres(side: str) -> dict[str, Array]:
    """Hip, knee and ankle (n, 2) of OpenSim's inverse kinematics, in its scaled model.

    Numbers of the model file subject01.osim (opensim-models 2c161f9): the hip in the pelvis, the
    femur's scale on the splines of the knee, which rolls and glides, and the tibia.
    """
    motion, x = storage(OPENSIM / "subject01_walk_IK.mot"), side[0]
    tilt = np.radians(motion["pelvis_tilt"])
    thigh = tilt + np.radians(motion[f"hip_flexion_{x}"])
    shank = thigh + np.radians(motion[f"knee_angle_{x}"])
    pelvis = np.stack([motion["pelvis_tx"], motion["pelvis_ty"]], axis=1)
    hip = pelvis + turned(tilt, -0.0724378, -0.0677247)
    bend = shank - thigh
    knee = hip + 1.14724 * turned(thigh, CubicSpline(*KNEE_X)(bend), CubicSpline(*KNEE_Y)(bend))
    return {"hip": hip, "knee": knee, "ankle": knee + turned(shank, 0.0, -0.42506489)}


def in_stride(walk: MeasuredWalk, side: str) -> NDArray[np.bool_]:
    """Frames of the one stride of a side."""
    (stride,) = (s for s in walk.strides if s.side == side)
    return (walk.trial.time >= stride.start) & (walk.trial.time <= stride.end)


@needs_samples
@pytest.mark.parametrize("side", ["right", "left"])
def test_segment_angles_are_those_of_inverse_kinematics(side: str) -> None:
    """About their means over the stride: 5 degrees for thigh, shank and knee. The model's pelvis is
    not that of the regression, its legs move in planes, and its foot does not bend: at push-off the
    ankle differs by up to 8 degrees."""
    walk, motion, x = (
        measured_sample("opensim"),
        storage(OPENSIM / "subject01_walk_IK.mot"),
        side[0],
    )
    angles, stride = walk.legs[side].angles, in_stride(walk, side)
    thigh = motion["pelvis_tilt"] + motion[f"hip_flexion_{x}"]
    knee = motion[f"knee_angle_{x}"]
    pairs = {
        "thigh": (angles.thigh, thigh, 5.0),
        "shank": (angles.shank, thigh + knee, 5.0),
        "knee": (angles.joints()["knee"], -knee, 5.0),
        "ankle": (angles.joints()["ankle"], motion[f"ankle_angle_{x}"], 8.0),
    }
    for name, (found, reference, tolerance) in pairs.items():
        error = (np.degrees(found) - reference)[stride]
        assert np.abs(error - error.mean()).max() < tolerance, name
        assert abs(error.mean()) < 3.0, name


@needs_samples
@pytest.mark.parametrize("side", ["right", "left"])
def test_moments_about_its_joints_are_those_of_inverse_dynamics(side: str) -> None:
    """Within 15 % of the peak, about the joint centres of the model: those of the markers lie up to
    3 cm away, of which the hip moment takes half its peak."""
    walk, reference = measured_sample("opensim"), storage(OPENSIM / "subject01_walk_ID.sto")
    record, stride = walk.legs[side], in_stride(walk, side)
    centres = {r: low_pass(p, walk.trial.rate, 6.0) for r, p in opensim_centres(side).items()}
    points = {**walk.trial.legs[side], **centres}
    leg = walk.body.replace(**OPENSIM_LEG).leg(0)
    found = joint_loads(points, leg, record.load.load, walk.trial.rate, 9.80665).moments
    for joint, column in (("hip", "hip_flexion"), ("knee", "knee_angle"), ("ankle", "ankle_angle")):
        known = reference[f"{column}_{side[0]}_moment"]
        error = np.abs(found[joint] - known)[stride].max() / np.abs(known[stride]).max()
        assert error < 0.15, (joint, error)


@needs_samples
@pytest.mark.parametrize("side", ["right", "left"])
def test_the_ankle_moment_needs_no_centres_of_the_model(side: str) -> None:
    walk, reference = measured_sample("opensim"), storage(OPENSIM / "subject01_walk_ID.sto")
    known, stride = reference[f"ankle_angle_{side[0]}_moment"], in_stride(walk, side)
    error = walk.legs[side].loads.moments["ankle"] - known
    assert np.abs(error[stride]).max() < 0.10 * np.abs(known[stride]).max()
