"""Points, joint angles and their derivatives."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.mechanics.kinematics import (
    LegMotion,
    Point,
    Rotation,
    hip_over_contact,
    joint_angles,
    joint_rates,
    leg_points,
    link,
    sole,
)

from .spaces import LAW, PAPER, Array, SmoothMotion, State, bodies, numbers, smooth_motions, states

STEP = 1e-30j
"""An imaginary time step: derivatives without a difference."""

LEG = PAPER.leg(0)


def difference(f: object, time: float, h: float = 2e-4) -> Array:
    """Rate of f(t) by a five-point difference; error of order h^4."""
    assert callable(f)
    near, far = f(time + h) - f(time - h), f(time + 2 * h) - f(time - 2 * h)
    return np.asarray((8 * near - far) / (12 * h))


@LAW
@given(numbers(4, 1.5), st.floats(0.1, 1.0))
def test_tip_of_a_link_moves_as_its_position_changes(wave: Array, length: float) -> None:
    def at(t: float) -> Point:
        return link(
            length,
            Rotation(
                wave[0] + wave[1] * np.sin(3 * t) + wave[2] * t**2,
                3 * wave[1] * np.cos(3 * t) + 2 * wave[2] * t,
                -9 * wave[1] * np.sin(3 * t) + 2 * wave[2],
            ),
        )

    tip, time = at(wave[3]), wave[3]
    slope = difference(lambda t: np.array(at(t).position), time)
    assert np.array(tip.velocity) == pytest.approx(slope, abs=1e-9)
    slope = difference(lambda t: np.array(at(t).velocity), time)
    assert np.array(tip.acceleration) == pytest.approx(slope, abs=1e-8)


@LAW
@given(bodies, smooth_motions)
def test_velocities_and_accelerations_of_all_points_are_derivatives(
    body: Body, motion: SmoothMotion
) -> None:
    now, later = motion.at(0.1).motion(), motion.at(0.1 + STEP).motion()
    for i in (0, 1):
        here = leg_points(body.leg(i), now.legs[i], now.hip)
        there = leg_points(body.leg(i), later.legs[i], later.hip)
        for name in (f.name for f in fields(here)):
            point, moved = getattr(here, name), getattr(there, name)
            rate = np.imag(moved.position) / STEP.imag
            assert np.array(point.velocity) == pytest.approx(rate, abs=1e-11)
            rate = np.imag(moved.velocity) / STEP.imag
            assert np.array(point.acceleration) == pytest.approx(rate, abs=1e-10)


@LAW
@given(bodies, states)
def test_bones_keep_their_lengths(body: Body, state: State) -> None:
    motion = state.motion()
    for i in (0, 1):
        leg = body.leg(i)
        p = leg_points(leg, motion.legs[i], motion.hip)
        for start, end, length in (
            (motion.hip, p.knee, leg.thigh_length),
            (p.knee, p.ankle, leg.shank_length),
            (p.ankle, p.metatarsal, leg.ankle_to_metatarsal),
            (p.heel, p.metatarsal, leg.heel_to_metatarsal),
            (p.heel, p.ankle, leg.heel_to_ankle),
            (p.metatarsal, p.toe_tip, leg.toe_length),
        ):
            assert np.hypot(*(end - start).position) == pytest.approx(length, rel=1e-12)


FLAT = LegMotion(
    Rotation(0.0), Rotation(0.0), Rotation(np.pi / 2 - LEG.foot_angle), Rotation(np.pi / 2)
)


def test_flat_foot_stands_on_heel_metatarsal_and_toe_tip() -> None:
    hip = Point((0.0, LEG.thigh_length + LEG.shank_length + LEG.ankle_height))
    points = leg_points(LEG, FLAT, hip)
    for point in (points.heel, points.metatarsal, points.toe_tip):
        assert point.position[1] == pytest.approx(0.0, abs=1e-15)
    assert points.ankle.position == pytest.approx((0.0, LEG.ankle_height))
    assert points.heel.position[0] < 0 < points.metatarsal.position[0]
    assert sole(LEG, FLAT.foot).angle == pytest.approx(np.pi / 2)


def test_joint_angles_of_upright_standing_are_zero() -> None:
    angles = (FLAT.thigh.angle, FLAT.shank.angle, FLAT.foot.angle, FLAT.toes.angle)
    assert joint_angles(LEG, 0.0, *angles) == pytest.approx(4 * [0.0], abs=1e-15)


def test_flexion_and_dorsiflexion_are_positive() -> None:
    stand = (0.0, 0.0, FLAT.foot.angle, FLAT.toes.angle)
    # thigh forward, trunk upright: the hip flexes
    assert joint_angles(LEG, 0.0, 0.3, 0.3, *stand[2:])[0] == pytest.approx(0.3)
    # trunk leaning back: the hip extends
    assert joint_angles(LEG, 0.2, *stand)[0] == pytest.approx(-0.2)
    # shank behind the thigh: the knee flexes
    assert joint_angles(LEG, 0.0, 0.0, -0.4, *stand[2:])[1] == pytest.approx(0.4)
    # toes up: the ankle dorsiflexes; toes above the line of the sole: they extend
    pitched = LegMotion(FLAT.thigh, FLAT.shank, FLAT.foot.plus(0.1), FLAT.toes)
    raised = leg_points(LEG, pitched, Point((0.0, 1.0)))
    assert raised.metatarsal.position[1] > raised.heel.position[1]
    assert joint_angles(LEG, 0.0, 0.0, 0.0, stand[2] + 0.1, stand[3])[2] == pytest.approx(0.1)
    assert joint_angles(LEG, 0.0, 0.0, 0.0, stand[2], stand[3] + 0.1)[3] == pytest.approx(0.1)


@LAW
@given(bodies, smooth_motions)
def test_joint_rates_are_the_rates_of_the_joint_angles(body: Body, motion: SmoothMotion) -> None:
    """The knee alone turns the other way: u extends it, and mu_k is its flexion."""
    now, later = motion.at(0.3).motion(), motion.at(0.3 + STEP).motion()
    for i in (0, 1):
        moved = later.legs[i]
        parts = (moved.thigh, moved.shank, moved.foot, moved.toes)
        angles = joint_angles(body.leg(i), later.trunk.angle, *(part.angle for part in parts))
        leg = now.legs[i]
        rates = joint_rates(
            now.trunk.rate, leg.thigh.rate, leg.shank.rate, leg.foot.rate, leg.toes.rate
        )
        expected = np.imag(angles) / STEP.imag * [1, -1, 1, 1]
        assert rates == pytest.approx(expected, abs=1e-11)


@LAW
@given(bodies, states, st.sampled_from(["heel", "metatarsal"]), numbers(2, 1.0))
def test_hip_over_a_contact_leaves_the_contact_at_rest(
    body: Body, state: State, contact: str, place: Array
) -> None:
    leg, motion = body.leg(0), state.motion().legs[0]
    hip = hip_over_contact(leg, motion, contact, (place[0], place[1]))
    point = getattr(leg_points(leg, motion, hip), contact)
    assert point.position == pytest.approx(tuple(place), abs=1e-14)
    assert point.velocity == pytest.approx((0.0, 0.0), abs=1e-13)
    assert point.acceleration == pytest.approx((0.0, 0.0), abs=1e-11)


def test_hip_stands_over_heel_or_metatarsal_only() -> None:
    with pytest.raises(KeyError, match="toe_tip"):
        hip_over_contact(LEG, FLAT, "toe_tip", (0.0, 0.0))
