"""Inverse dynamics of each pair of contacts satisfies the eleven lines of (1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.gait.footprints import leading_print, trailing_print
from ergowalk.gait.loads import Loads, Sharing, inverse_dynamics
from ergowalk.gait.rhythm import Contact, PhaseOrder, half_stride_phases
from ergowalk.mechanics.dynamics import applied_load, coefficients, inertial_load, total_reaction
from ergowalk.mechanics.foot import foot_balance, pressure_moment, toe_balance
from ergowalk.mechanics.kinematics import (
    HALF_PI,
    BodyMotion,
    LegMotion,
    Rotation,
    hip_over_contact,
    leg_points,
)

Array = NDArray[np.float64]

BODY = Body()
LEG = BODY.leg(0)
WEIGHT = BODY.total_mass * BODY.gravity_m_s2
HEEL, TOE_TIP = leading_print(LEG).heel, trailing_print(LEG, 0.76).toe_tip
FLAT = HALF_PI - LEG.foot_angle

LAW = settings(deadline=None, max_examples=40, derandomize=True, database=None)

PAIRS = sorted({p.legs for order in PhaseOrder for p in half_stride_phases(order)})
NAMES = ["+".join(c.name.lower() for c in pair) for pair in PAIRS]
SAMPLES = 3


@dataclass(frozen=True)
class Posture:
    """Nine angles with rates and accelerations at three instants, each (9, 3)."""

    angle: Array
    rate: Array
    acceleration: Array

    def motion(self, contacts: tuple[Contact, Contact]) -> BodyMotion:
        """The walker over leg 1's print; a flat foot lies flat."""
        turns = [
            Rotation(*row) for row in zip(self.angle, self.rate, self.acceleration, strict=True)
        ]
        trunk, (a1, b1, c1, e1), (a2, b2, c2, e2) = turns[0], turns[1:5], turns[5:9]
        if contacts[0] is Contact.FLAT:
            still = np.zeros(SAMPLES)
            c1, e1 = Rotation(FLAT + still, still, still), Rotation(HALF_PI + still, still, still)
        first, second = LegMotion(a1, b1, c1, e1), LegMotion(a2, b2, c2, e2)
        where = "heel" if contacts[0] is Contact.HEEL else "metatarsal"
        place = getattr(leading_print(LEG), where)
        return BodyMotion(hip_over_contact(LEG, first, where, (place, 0.0)), trunk, (first, second))


def table(bound: float) -> st.SearchStrategy[Array]:
    element = st.floats(-bound, bound, allow_subnormal=False)
    return arrays(np.float64, (9, SAMPLES), elements=element)


postures = st.builds(Posture, table(1.5), table(6.0), table(40.0))
forces = arrays(np.float64, (2, SAMPLES), elements=st.floats(-1000, 1000, allow_subnormal=False))


def shared(contacts: tuple[Contact, Contact], force: Array) -> Sharing:
    if contacts[1] is Contact.SWING:
        zero = np.zeros(SAMPLES)
        return Sharing(zero, zero, zero)
    return Sharing(force[0], force[1], np.full(SAMPLES, TOE_TIP))


def eleven_lines(motion: BodyMotion, loads: Loads) -> Array:
    """Residuals of (1), each divided by M g or M g times a metre: (11, n)."""
    c = coefficients(BODY)
    left = inertial_load(c, motion)
    right = applied_load(c, motion, loads.moments, loads.reactions)
    lines = [a - b for a, b in zip(left, right, strict=True)]
    for i in (0, 1):
        points = leg_points(LEG, motion.legs[i], motion.hip)
        moment, reaction = loads.moments[i], loads.reactions[i]
        lines.append(foot_balance(points, moment.ankle, moment.metatarsal, reaction))
        where = np.where(reaction[1] == 0, 0.0, loads.pressures[i])  # nothing acts nowhere
        lines.append(toe_balance(points, moment.metatarsal, reaction, where))
    return np.stack([line + np.zeros(SAMPLES) for line in lines]) / WEIGHT


def size_of(motion: BodyMotion, loads: Loads) -> float:
    """The largest term of (1) in body weights, for rounding."""
    c = coefficients(BODY)
    terms = [*inertial_load(c, motion), *(x for r in loads.reactions for x in r)]
    reach = max(float(np.abs(p).max()) for p in motion.hip.position) + 1.0
    return 1.0 + reach * max(float(np.abs(t).max()) for t in terms) / WEIGHT


@pytest.mark.parametrize("contacts", PAIRS, ids=NAMES)
@LAW
@given(posture=postures, force=forces)
def test_all_eleven_lines_hold_for_any_sharing(
    contacts: tuple[Contact, Contact], posture: Posture, force: Array
) -> None:
    motion = posture.motion(contacts)
    loads = inverse_dynamics(BODY, motion, contacts, shared(contacts, force))
    pressed = np.abs(loads.reactions[0][1]) > 1e-3 * WEIGHT  # x_R is ill-conditioned below
    lines = eleven_lines(motion, loads)[:, pressed]
    assert np.abs(lines).max(initial=0.0) < 1e-10 * size_of(motion, loads)


@pytest.mark.parametrize("contacts", PAIRS, ids=NAMES)
@LAW
@given(posture=postures, force=forces)
def test_both_reactions_together_carry_the_motion(
    contacts: tuple[Contact, Contact], posture: Posture, force: Array
) -> None:
    motion = posture.motion(contacts)
    loads = inverse_dynamics(BODY, motion, contacts, shared(contacts, force))
    total = total_reaction(coefficients(BODY), motion)
    for axis in (0, 1):
        both = loads.reactions[0][axis] + loads.reactions[1][axis]
        np.testing.assert_allclose(both, total[axis], rtol=1e-12, atol=1e-9)


def off_the_heel(motion: BodyMotion, sharing: Sharing) -> tuple[Array, Loads]:
    """How far the leading foot's load is off its heel, x_R R_y [M g m], under this very sharing."""
    contacts = (Contact.FLAT, Contact.TOE)  # takes any sharing as it is given
    loads = inverse_dynamics(BODY, motion, contacts, sharing)
    return off_the_heel_under(motion, loads), loads


def off_the_heel_under(motion: BodyMotion, loads: Loads) -> Array:
    points = leg_points(LEG, motion.legs[0], motion.hip)
    reaction = loads.reactions[0]
    under = pressure_moment(points, loads.moments[0].ankle, reaction)
    return np.asarray((under - HEEL * reaction[1]) / WEIGHT)


def force_for_the_heel(motion: BodyMotion, force_x: Array) -> Array:
    """The only vertical force under the toe for which the leading foot presses on its heel.

    What is off is affine in the force: two values give its zero.
    """
    at, one = np.full(SAMPLES, TOE_TIP), np.full(SAMPLES, WEIGHT)
    zero, _ = off_the_heel(motion, Sharing(force_x, 0 * one, at))
    unit, _ = off_the_heel(motion, Sharing(force_x, one, at))
    return np.asarray(-zero / (unit - zero) * WEIGHT)


HEEL_AND_TOE = (Contact.HEEL, Contact.TOE)


@LAW
@given(posture=postures, force=forces)
def test_on_heel_and_toe_a_force_that_fits_puts_both_pressures_where_they_must_be(
    posture: Posture, force: Array
) -> None:
    motion = posture.motion(HEEL_AND_TOE)
    fits = force_for_the_heel(motion, force[0])
    sharing = Sharing(force[0], fits, np.full(SAMPLES, TOE_TIP))
    loads = inverse_dynamics(BODY, motion, HEEL_AND_TOE, sharing)
    size = size_of(motion, loads)
    assert np.abs(off_the_heel_under(motion, loads)).max() < 1e-11 * size
    assert np.abs(loads.reactions[1][1] - fits).max() < 1e-10 * size * WEIGHT
    np.testing.assert_array_equal(loads.reactions[1][0], force[0])
    np.testing.assert_array_equal(loads.pressures[1], TOE_TIP)


@LAW
@given(posture=postures, force=forces)
def test_on_heel_and_toe_any_other_force_is_moved_towards_the_one_that_fits(
    posture: Posture, force: Array
) -> None:
    motion = posture.motion(HEEL_AND_TOE)
    sharing = shared(HEEL_AND_TOE, force)
    before, asked = off_the_heel(motion, sharing)
    loads = inverse_dynamics(BODY, motion, HEEL_AND_TOE, sharing)
    after = off_the_heel_under(motion, loads)
    slack = 1e-11 * (size_of(motion, loads) + size_of(motion, asked))
    assert np.all(np.abs(after) <= np.abs(before) + slack)
    assert np.all(after * before >= -slack * (1 + np.abs(before)))  # not beyond it


def test_a_heel_that_barely_touches_has_its_pressure_exactly() -> None:
    """There the centre of pressure would run away with any error of the force."""
    rng = np.random.default_rng(8)
    posture = Posture(*(rng.normal(size=(9, SAMPLES)) * x for x in (0.3, 2.0, 10.0)))
    motion = posture.motion(HEEL_AND_TOE)
    _, total_y = total_reaction(coefficients(BODY), motion)
    force_x = rng.normal(size=SAMPLES) * 50
    for share, tolerance in ((0.0, 1e-12), (0.05, 2e-4)):
        sharing = Sharing(force_x, total_y - share * WEIGHT, np.full(SAMPLES, TOE_TIP))
        before, _ = off_the_heel(motion, sharing)
        after = off_the_heel_under(motion, inverse_dynamics(BODY, motion, HEEL_AND_TOE, sharing))
        assert np.abs(before).min() > 1e-3
        assert np.all(np.abs(after) <= tolerance * np.abs(before) + 1e-13)


@pytest.mark.parametrize("contacts", PAIRS, ids=NAMES)
def test_a_swinging_foot_carries_nothing_and_has_no_centre_of_pressure(
    contacts: tuple[Contact, Contact],
) -> None:
    posture = Posture(*(np.full((9, SAMPLES), x) for x in (0.3, 1.0, 2.0)))
    force = np.full((2, SAMPLES), 100.0)
    loads = inverse_dynamics(BODY, posture.motion(contacts), contacts, shared(contacts, force))
    swings = contacts[1] is Contact.SWING
    assert bool(np.all(np.isnan(loads.pressures[1]))) == swings
    if swings:
        for moment in (loads.moments[1].ankle, loads.moments[1].metatarsal):
            np.testing.assert_array_equal(moment, 0.0)


def test_a_foot_without_load_has_finite_moments_and_no_centre_of_pressure() -> None:
    """All weight on the trailing foot: R_y of leg 1 is exactly zero."""
    contacts = (Contact.FLAT, Contact.TOE)
    rng = np.random.default_rng(2)
    posture = Posture(*(rng.normal(size=(9, SAMPLES)) * x for x in (0.4, 2.0, 10.0)))
    motion = posture.motion(contacts)
    _, total_y = total_reaction(coefficients(BODY), motion)
    sharing = Sharing(np.zeros(SAMPLES), total_y, np.full(SAMPLES, TOE_TIP))
    loads = inverse_dynamics(BODY, motion, contacts, sharing)
    np.testing.assert_array_equal(loads.reactions[0][1], 0.0)
    assert np.all(np.isnan(loads.pressures[0]))
    points = leg_points(LEG, motion.legs[0], motion.hip)
    moment, reaction = loads.moments[0], loads.reactions[0]
    for line in (
        foot_balance(points, moment.ankle, moment.metatarsal, reaction),
        moment.metatarsal
        + points.metatarsal.position[1] * reaction[0]
        - points.metatarsal.position[0] * reaction[1]
        + pressure_moment(points, moment.ankle, reaction),  # x_R R_y
    ):
        assert np.abs(line / WEIGHT).max() < 1e-12


def test_standing_still_on_one_flat_foot_carries_the_weight_over_the_centre_of_mass() -> None:
    """Statics: R = (0, M g), and the centre of pressure under the centre of mass."""
    contacts = (Contact.FLAT, Contact.SWING)
    angles = np.array([0.1, 0.2, -0.1, 0, 0, -0.3, -0.5, 1.0, 1.6])[:, None]
    still = np.zeros((9, SAMPLES))
    motion = Posture(angles + still, still, still).motion(contacts)
    loads = inverse_dynamics(BODY, motion, contacts, shared(contacts, np.zeros((2, SAMPLES))))
    np.testing.assert_allclose(loads.reactions[0][0], 0.0, atol=1e-10)
    np.testing.assert_allclose(loads.reactions[0][1], WEIGHT, rtol=1e-13)
    hip, trunk = motion.hip.position[0], motion.trunk.angle
    moment = BODY.trunk_mass_kg * (hip - BODY.trunk_com_m * np.sin(trunk))
    for leg in motion.legs:
        knee = hip + LEG.thigh_length * np.sin(leg.thigh.angle)
        ankle = knee + LEG.shank_length * np.sin(leg.shank.angle)
        moment = moment + LEG.thigh_mass * (hip + LEG.thigh_com * np.sin(leg.thigh.angle))
        moment = moment + LEG.shank_mass * (knee + LEG.shank_com * np.sin(leg.shank.angle))
        moment = moment + LEG.foot_mass * ankle
    np.testing.assert_allclose(loads.pressures[0], moment / BODY.total_mass, atol=1e-12)
