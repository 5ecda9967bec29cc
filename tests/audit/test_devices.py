"""The audit and devices: laws, energy, and lies about them, on a walk led by hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from .conftest import Gait

JOINTS = ("hip", "knee", "ankle", "metatarsal")
TEMPLATE = """
[devices.{joint}]
kind = "{kind}"
own_moment = {own}
stiffness_nm_per_rad = {k}
stiffness_below_nm_per_rad = {below}
damping_nms_per_rad = {c}
rest_angle_deg = {rest}
active = {active}
"""
ALWAYS = '["swing", "heel", "flat", "forefoot", "toe"]'


def fitted(
    gait: Gait,
    joint: str,
    kind: str,
    k: float = 0.0,
    c: float = 0.0,
    rest: float = 0.0,
    active: str = ALWAYS,
    own: str = "true",
) -> Gait:
    """The walk with a device beside the own moment, which then gives the rest."""
    found = gait.copy()
    data, j = found.dataset, JOINTS.index(joint)
    table = TEMPLATE.format(
        joint=joint, kind=kind, own=own, k=k, below='"same"', c=c, rest=rest, active=active
    )
    data.attrs["problem"] += table
    angle = data["joint_angle"].values[:, :, j] - np.radians(rest)
    segments = data["segment_angular_velocity"].values
    trunk = data["trunk_angular_velocity"].values[:, None]
    relative = segments[:, :, 0] - trunk if j == 0 else segments[:, :, j] - segments[:, :, j - 1]
    sense = -1.0 if joint == "knee" else 1.0
    moment = np.zeros(data["joint_moment"].shape)
    moment[:, :, j] = -sense * (k * angle + c * sense * relative)
    data["device_moment"] = (("time", "leg", "joint"), moment)
    data["joint_power"].values[:, :, j] -= moment[:, :, j] * relative
    time, power = data["time"].values, np.abs(data["joint_power"].values)
    data.attrs["energy_per_metre"] = float(np.trapezoid(power.sum(axis=(1, 2)), time)) / (
        2 * data.attrs["step_length"]
    )
    return found


LINES = ("device_law", "device_energy", "device_in_place", "joint_power", "work_energy")


@pytest.mark.parametrize(
    ("joint", "kind", "k", "c"),
    [
        ("hip", "spring", 60.0, 0.0),
        ("knee", "spring", 30.0, 0.0),
        ("hip", "damper", 0.0, 2.0),
        ("knee", "parallel", 20.0, 1.5),
    ],
)
def test_devices_that_keep_their_laws_are_accepted(
    marionette: Gait, joint: str, kind: str, k: float, c: float
) -> None:
    report = fitted(marionette, joint, kind, k, c, rest=5.0 if k else 0.0).audited()
    assert all(report.line(key).accepted for key in LINES), report.table()
    given = float(report.line("device_energy").note.split()[2])
    if c:
        assert given < -0.1  # a damper takes
    else:
        assert abs(given) < 1e-3  # a spring gives back; J of some 100 a stride


def test_without_devices_there_is_nothing_to_judge(marionette: Gait) -> None:
    for key in LINES[:3]:
        line = marionette.audited().line(key)
        assert line.accepted
        assert line.note == "no device"


def scaled(gait: Gait) -> None:
    gait.dataset["device_moment"].values[:] *= 1.01


def elsewhere(gait: Gait) -> None:
    gait.dataset["device_moment"].values[:, 1, 3] += 2.0


def lost(gait: Gait) -> None:
    del gait.dataset["device_moment"]


def renamed(gait: Gait) -> None:
    text = gait.dataset.attrs["problem"]
    gait.dataset.attrs["problem"] = text.replace('kind = "parallel"', 'kind = "magic"')


def active(gait: Gait) -> None:
    gait.dataset.attrs["problem"] = gait.dataset.attrs["problem"].replace(ALWAYS, '["flat"]')


def alone(gait: Gait) -> None:
    text = gait.dataset.attrs["problem"]
    gait.dataset.attrs["problem"] = text.replace("own_moment = true", "own_moment = false")


def giving(gait: Gait) -> None:
    """A damper that pushes."""
    gait.dataset["device_moment"].values[:] *= -1.0


@pytest.mark.parametrize(
    ("lie", "line"),
    [
        (scaled, "device_law"),
        (elsewhere, "device_law"),
        (lost, "device_law"),
        (renamed, "device_energy"),
        (active, "device_law"),
        (alone, "device_in_place"),
        (giving, "device_energy"),
    ],
)
def test_the_audit_names_the_lie(marionette: Gait, lie: Callable[[Gait], None], line: str) -> None:
    gait = fitted(marionette, "knee", "parallel", 20.0, 1.5)
    assert gait.audited().line(line).accepted
    lie(gait)
    assert not gait.audited().line(line).accepted


def test_a_lock_that_moves_is_noticed(marionette: Gait) -> None:
    gait = fitted(marionette, "knee", "locked", own="true")
    line = gait.audited().line("device_law")
    angles = np.abs(marionette.dataset["joint_angle"].values[:, :, 1])
    assert line.value == pytest.approx(angles.max())  # locked at 0
    assert "knee" in line.where


def test_moments_of_devices_that_the_problem_does_not_name_are_noticed(marionette: Gait) -> None:
    gait = marionette.copy()
    gait.dataset["device_moment"] = 0.1 * gait.dataset["joint_moment"]
    assert not gait.audited().line("device_law").accepted
