"""OpenSim's files: counts, names, units and signs, read by a reader of another hand."""

from __future__ import annotations

import xml.etree.ElementTree as Xml
from pathlib import Path

import numpy as np
import pytest

from ergowalk.audit import audit
from ergowalk.io import Samples

from .readers import Markers, Storage, read_storage, read_trc

SAMPLE = Path(__file__).parents[3] / "shared/data/samples/opensim_gait10dof18musc"

COORDINATES = [
    "pelvis_tilt",
    "pelvis_tx",
    "pelvis_ty",
    "hip_flexion_r",
    "knee_angle_r",
    "ankle_angle_r",
    "hip_flexion_l",
    "knee_angle_l",
    "ankle_angle_l",
    "lumbar_extension",
]
"""Coordinates of gait10dof18musc in the order of its sample of inverse kinematics."""

LOADS = [
    *(f"ground_force_{kind}{axis}" for kind in "vp" for axis in "xyz"),
    *(f"1_ground_force_{kind}{axis}" for kind in "vp" for axis in "xyz"),
    *(f"{foot}ground_torque_{axis}" for foot in ("", "1_") for axis in "xyz"),
]
"""Columns of its sample of ground reactions."""


@pytest.fixture
def angles(export) -> Storage:
    return read_storage(export.text("mot"))


@pytest.fixture
def loads(export) -> Storage:
    return read_storage(export.text("grf"))


@pytest.fixture
def moments(export) -> Storage:
    return read_storage(export.text("sto"))


@pytest.fixture
def markers(export) -> Markers:
    return read_trc(export.text("trc"))


def test_columns_are_those_of_the_sample(angles, loads, moments):
    assert list(angles.columns) == ["time", *COORDINATES]
    assert list(loads.columns) == ["time", *LOADS]
    known = {f"{c}_{'force' if c in ('pelvis_tx', 'pelvis_ty') else 'moment'}" for c in COORDINATES}
    assert set(moments.columns) - {"time"} == known - {"lumbar_extension_moment"}


@pytest.mark.skipif(not SAMPLE.exists(), reason="the sample of OpenSim is not here")
@pytest.mark.parametrize(
    ("format_", "file"), [("mot", "IK.mot"), ("grf", "grf.mot"), ("sto", "ID.sto")]
)
def test_headers_and_columns_are_those_of_opensims_own_files(export, format_, file):
    ours = read_storage(export.text(format_))
    lines = (SAMPLE / f"subject01_walk_{file}").read_text().splitlines()
    theirs = [line.strip() for line in lines[: 2 + [x.strip() for x in lines].index("endheader")]]
    labels = theirs[-1].split("\t")
    assert set(ours.columns) == set(labels) - {"lumbar_extension_moment"}
    keys = {line.split("=")[0] for line in theirs if "=" in line}
    assert keys <= set(ours.header)
    assert f"inDegrees={ours.header['inDegrees']}" in theirs
    if format_ != "grf":
        assert ours.name == theirs[0]


def test_the_first_line_and_the_unit_of_angles_are_told(angles, moments, loads):
    assert (angles.name, angles.header["inDegrees"]) == ("Coordinates", "yes")
    assert moments.name == "Inverse Dynamics Generalized Forces"
    assert moments.header["inDegrees"] == "no"
    assert loads.name == "reactions.mot"


def test_angles_are_the_joint_angles_of_the_gait_with_the_knee_extending(export, angles):
    """Against the stored joint angles at stored instants nearby: 0.2 degrees between samples."""
    gait, time = export.gait, angles.columns["time"]
    for side, leg in (("r", 1), ("l", 2)):
        for name, joint, sign in (
            ("hip_flexion", "hip", 1),
            ("knee_angle", "knee", -1),
            ("ankle_angle", "ankle", 1),
        ):
            stored = gait["joint_angle"].sel(leg=leg, joint=joint).values
            expected = sign * np.degrees(np.interp(time, gait["time"].values, stored))
            np.testing.assert_allclose(angles.columns[f"{name}_{side}"], expected, atol=0.2)
    assert angles.columns["knee_angle_r"].min() < -50  # a knee bends by more in swing
    tilt = np.interp(time, gait["time"].values, np.degrees(gait["trunk_angle"].values))
    np.testing.assert_allclose(angles.columns["pelvis_tilt"], tilt, atol=0.05)


def test_the_hip_of_opensims_model_is_the_hip_of_the_walker(angles, markers):
    """gait10dof18musc has its hip 0.0707 m behind and 0.0661 m below the origin of the pelvis."""
    tilt = np.radians(angles.columns["pelvis_tilt"])
    x = angles.columns["pelvis_tx"] - 0.0707 * np.cos(tilt) + 0.0661 * np.sin(tilt)
    y = angles.columns["pelvis_ty"] - 0.0707 * np.sin(tilt) - 0.0661 * np.cos(tilt)
    np.testing.assert_allclose(x, markers.places["Hip"][:, 0] / 1000, atol=1e-7)
    np.testing.assert_allclose(y, markers.places["Hip"][:, 1] / 1000, atol=1e-7)


def test_the_ground_carries_the_weight_over_a_stride(export, loads):
    """The momentum of a periodic gait returns: mean vertical force M g, mean forward force zero.
    Trapezia at 200 Hz over jumps: 0.5 % of M g."""
    body = Samples(export.gait).body
    weight = body.total_mass * body.gravity_m_s2
    time = loads.columns["time"]
    for axis, expected in (("x", 0.0), ("y", weight), ("z", 0.0)):
        total = loads.columns[f"ground_force_v{axis}"] + loads.columns[f"1_ground_force_v{axis}"]
        mean = np.trapezoid(total, time) / time[-1]
        assert mean == pytest.approx(expected, abs=0.005 * weight)
    early = time < 0.25 * time[-1]
    assert loads.columns["ground_force_vx"][early].mean() < 0  # the leading foot brakes
    assert (
        min(loads.columns["ground_force_vy"].min(), loads.columns["1_ground_force_vy"].min()) >= 0
    )


def test_the_load_acts_under_the_foot(loads, markers):
    """While it carries, the centre of pressure is between heel and toe tip: to 2 mm, as audited."""
    for side, prefix in (("R", ""), ("L", "1_")):
        carries = loads.columns[f"{prefix}ground_force_vy"] > 80
        place = loads.columns[f"{prefix}ground_force_px"][carries]
        heel, tip = (
            markers.places[f"{side}.{point}"][carries, 0] / 1000 for point in ("Heel", "Toe.Tip")
        )
        assert np.all(place >= heel - 2e-3)
        assert np.all(place <= tip + 2e-3)
        assert carries.sum() > 100


def test_ankle_moments_balance_the_ground_about_the_ankle(loads, moments, markers):
    """p = -y_A R_x - (x_R - x_A) R_y with each number from another file: 0.1 N m.

    Reactions are lines and the foot's place a curve between the samples of the gait.
    """
    for side, prefix in (("R", ""), ("L", "1_")):
        ankle = markers.places[f"{side}.Ankle"] / 1000
        r_x, r_y, place = (loads.columns[f"{prefix}ground_force_{c}"] for c in ("vx", "vy", "px"))
        needed = -ankle[:, 1] * r_x - (place - ankle[:, 0]) * r_y
        given = moments.columns[f"ankle_angle_{side.lower()}_moment"]
        np.testing.assert_allclose(given, needed, atol=0.1)
    assert moments.columns["ankle_angle_r_moment"].min() < -80  # the calf pushes off


def test_work_of_the_files_is_the_energy_of_the_gait(export):
    """Sum of |moment x change of angle| of hip, knee and ankle from .sto and .mot at 2 kHz, over
    the stride length, against the stored curves of the same joints: 0.5 %."""
    angles = read_storage(export.text("mot", 2000.0))
    moments = read_storage(export.text("sto", 2000.0))
    work = 0.0
    for side in "rl":
        for name in ("hip_flexion", "knee_angle", "ankle_angle"):
            turn = np.diff(np.radians(angles.columns[f"{name}_{side}"]))
            moment = moments.columns[f"{name}_{side}_moment"]
            work += np.sum(np.abs((moment[1:] + moment[:-1]) / 2 * turn))
    gait = export.gait
    power = np.abs(gait["joint_power"].sel(joint=["hip", "knee", "ankle"]))
    expected = float(np.trapezoid(power.sum(("leg", "joint")).values, gait["time"].values))
    assert work == pytest.approx(expected, rel=5e-3)


def test_a_second_stride_is_the_first_a_stride_length_further_on(export):
    one, two = (read_storage(export.text("mot", 100.0, n)).columns for n in (1, 2))
    again = np.flatnonzero(np.isclose(two["time"], 1.14 + one["time"][1]))[0] - 1
    for name in COORDINATES:
        shift = 1.52 if name == "pelvis_tx" else 0.0
        count = len(one["time"]) - 1
        np.testing.assert_allclose(
            two[name][again : again + count], one[name][:count] + shift, atol=2e-6
        )


def test_external_loads_name_columns_and_file_that_are_there(export, loads):
    root = Xml.fromstring(export.text("loads").encode())
    forces = root.findall(".//ExternalForce")
    assert [force.findtext("applied_to_body") for force in forces] == ["calcn_r", "calcn_l"]
    for force in forces:
        for kind in ("force", "point", "torque"):
            stem = force.findtext(f"{kind}_identifier")
            assert {f"{stem}{axis}" for axis in "xyz"} <= set(loads.columns)
    assert root.findtext(".//datafile") == "reactions.mot"


def test_the_exported_gait_is_one_that_the_audit_accepts(export):
    assert audit(export.gait).accepted
