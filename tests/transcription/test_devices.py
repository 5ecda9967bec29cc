"""Devices in the programme of the collocation: what they add, and what idle ones leave alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ergowalk.gait.rhythm import Contact
from ergowalk.problem import Device, Devices, GaitProblem, preset
from ergowalk.solution import Solution
from ergowalk.solving.memory import recall
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.devices import Fittings
from ergowalk.transcription.walking import walking_problem

FIXED: GaitProblem = preset("berbyuk2002-rhythm")
(ORDER,) = FIXED.rhythm.orders()

IDLE = Devices(
    hip=Device(kind="spring"),
    knee=Device(kind="damper"),
    ankle=Device(kind="parallel"),
    metatarsal=Device(kind="parallel"),
)
ALONE = Device(kind="spring", stiffness_nm_per_rad=300.0, own_moment=False)


@pytest.fixture(scope="module")
def gait(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


def collocation(devices: Devices, gait: Solution) -> Collocation:
    _, result = recall(gait)
    phased = walking_problem(FIXED.replace(devices=devices), (ORDER,))
    return Collocation(phased, result.collocation.mesh, result.points)


def test_no_stiffness_and_no_damping_are_no_device(gait: Solution) -> None:
    """The same unknowns, and the same objective and rows to rounding."""
    _, result = recall(gait)
    x, idle = result.minimum.x, collocation(IDLE, gait)
    cost, rows = result.collocation.programme.evaluate(x)
    same_cost, same_rows = idle.programme.evaluate(x)
    assert same_cost == pytest.approx(cost, rel=1e-12)
    np.testing.assert_allclose(same_rows, rows, atol=1e-11)
    assert idle.programme.labels == result.collocation.programme.labels


def test_a_device_in_the_place_of_a_moment_takes_its_unknown(gait: Solution) -> None:
    phases = collocation(Devices(ankle=ALONE), gait).problem.phases
    names = {u.name for phase in phases for u in phase.controls}
    assert not {"ankle_1", "ankle_2"} & names
    assert {"hip_1", "knee_2", "metatarsal_1"} <= names


def test_a_lock_brings_its_moment_and_an_equation(gait: Solution) -> None:
    walk = collocation(Devices(knee=Device(kind="locked", rest_angle_deg=20.0)), gait)
    for phase, kernel in zip(walk.problem.phases, walk.kernels, strict=True):
        assert {"lock_knee_1", "lock_knee_2"} <= {z.name for z in phase.algebraics}
        assert kernel.labels.count("lock") == 2 * walk.scheme.m


def test_a_spring_and_a_damper_in_series_have_a_deflection_between_them(gait: Solution) -> None:
    device = Device(kind="series", stiffness_nm_per_rad=100.0, damping_nms_per_rad=4.0)
    walk = collocation(Devices(hip=device), gait)
    for phase, kernel in zip(walk.problem.phases, walk.kernels, strict=True):
        assert {"slip_hip_1", "slip_hip_2"} <= {q.name for q in phase.coordinates}
        assert kernel.labels.count("spring and damper in series") == 2 * walk.scheme.m


@pytest.mark.parametrize("own", [True, False])
def test_a_massless_foot_bears_no_moment_in_swing(own: bool) -> None:
    """Beside the own moment the device is held by it; in its place it moves the foot."""
    device = Device(kind="spring", stiffness_nm_per_rad=300.0, own_moment=own)
    fittings = Fittings(FIXED.replace(devices=Devices(ankle=device)))
    assert fittings.holds_swing_foot(1, Contact.SWING) == (device if own else None)
    assert fittings.moves_swing_foot(1, Contact.SWING) == (None if own else device)
    for contact in (Contact.HEEL, Contact.FLAT, Contact.FOREFOOT, Contact.TOE):
        assert fittings.holds_swing_foot(1, contact) is None
        assert fittings.moves_swing_foot(1, contact) is None


def links(devices: Devices, gait: Solution) -> dict[str, str]:
    """Boundary of every link of a device by the name of the link."""
    found = collocation(devices, gait).problem.links
    return {link.name: link.boundary for link in found if link.name not in ("toe_off", "landing")}


def test_latches_close_where_their_phases_begin(gait: Solution) -> None:
    """At heel contact leg 1 is known as leg 2 at the end of the half stride before."""
    stance = Device(
        kind="locked", rest_angle_deg="latched", active=("heel", "flat", "forefoot", "toe")
    )
    assert links(Devices(knee=stance), gait) == {"latch_knee_2_half_stride": "half_stride"}
    flat = Device(kind="spring", stiffness_nm_per_rad=90.0, active=("flat",))
    assert links(Devices(ankle=flat), gait) == {"latch_ankle_1_heel_end": "heel_end"}
    assert links(Devices(ankle=ALONE), gait) == {"toe_off_of_device": "other_toe_off"}
    held = ALONE.replace(own_moment=True)
    assert links(Devices(ankle=held), gait) == {
        "held_ankle_1": "heel_contact",
        "held_ankle_2": "other_toe_off",
    }


def test_own_moments_vanish_where_a_lock_takes_over(gait: Solution) -> None:
    lock = Device(kind="locked", rest_angle_deg="latched", active=("flat",))
    fixed = collocation(Devices(knee=lock), gait).problem.fixed
    assert fixed["heel_end", "knee_1", "control"] == 0.0  # the lock closes
    assert fixed["heel_off", "knee_1", "control"] == 0.0  # and opens
    assert not [key for key in fixed if key[1] == "knee_2"]
