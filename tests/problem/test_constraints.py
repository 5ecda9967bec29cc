"""Constraints (2)-(9): signs and values in postures that one can check by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.corridors import Corridor, human_gait
from ergowalk.gait.footprints import Footprint, leading_print, trailing_print
from ergowalk.gait.rhythm import BOUNDARIES, Contact, PhaseOrder, half_stride_phases
from ergowalk.mechanics.foot import pressure_moment
from ergowalk.mechanics.kinematics import (
    HALF_PI,
    LegMotion,
    LegPoints,
    Point,
    Rotation,
    hip_over_contact,
    leg_points,
    sole,
)
from ergowalk.problem import constraints as c

LEG = Body().leg(0)
FLAT = HALF_PI - LEG.foot_angle
HERE = leading_print(LEG)
BEHIND = trailing_print(LEG, 0.76)


def points(**places: tuple[float, float]) -> LegPoints:
    """Named points of a leg, the others at the origin, all at rest unless four numbers say so."""

    def point(name: str) -> Point:
        x, y, *velocity = places.get(name, (0.0, 0.0))
        return Point((x, y), (velocity[0], velocity[1]) if velocity else (0.0, 0.0))

    return LegPoints(*(point(n) for n in ("knee", "ankle", "heel", "metatarsal", "toe_tip")))


def standing(contact: Contact, foot: float, toes: float, rate: float = 0.0) -> LegPoints:
    """A leg in a bent posture over its print, the foot turning about its contact point."""
    motion = LegMotion(
        Rotation(0.3, 1.0),
        Rotation(-0.2, 2.0),
        Rotation(foot, rate),
        Rotation(toes, rate if c.eq7_toes_in_line(contact) else 0.0),
    )
    where = ("heel", HERE.heel) if contact is Contact.HEEL else ("metatarsal", HERE.metatarsal)
    hip = hip_over_contact(LEG, motion, where[0], (where[1], 0.0))
    return leg_points(LEG, motion, hip)


# --- (2) and (3) -------------------------------------------------------------------------------


def test_eq2_legs_change_places_and_the_trunk_stays() -> None:
    names = ("trunk", "thigh_1", "shank_2", "foot_2", "hip_1", "knee_2")
    assert c.eq2_exchange(names) == {
        "trunk": "trunk",
        "thigh_1": "thigh_2",
        "shank_2": "shank_1",
        "foot_2": "foot_1",
        "hip_1": "hip_2",
        "knee_2": "knee_1",
    }


@given(st.sets(st.sampled_from(["trunk", "thigh_1", "thigh_2", "ankle_1", "foot_2"])))
def test_eq2_exchanging_twice_changes_nothing(names: set[str]) -> None:
    there = c.eq2_exchange(tuple(names))
    back = c.eq2_exchange(tuple(there.values()))
    assert {name: back[there[name]] for name in there} == {name: name for name in names}


@pytest.mark.parametrize("order", PhaseOrder)
def test_eq3_each_phase_ends_after_it_starts(order: PhaseOrder) -> None:
    pairs = c.eq3_rhythm_order(order)
    assert pairs == tuple((p.start, p.end) for p in half_stride_phases(order))
    assert {name for pair in pairs for name in pair} == set(BOUNDARIES)


def test_eq3_both_orders_end_before_heel_off() -> None:
    """tau_1^h <= tau_1^m and tau_2^s <= tau_1^m; what comes first is the order."""
    toe_off_first = c.eq3_rhythm_order(PhaseOrder.TOE_OFF_FIRST)
    flat_first = c.eq3_rhythm_order(PhaseOrder.FLAT_FIRST)
    assert toe_off_first[1:3] == (("other_toe_off", "heel_end"), ("heel_end", "heel_off"))
    assert flat_first[1:3] == (("heel_end", "other_toe_off"), ("other_toe_off", "heel_off"))
    assert toe_off_first[3] == flat_first[3] == ("heel_off", "half_stride")


# --- (4) and (5) -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("contact", "foot", "toes", "rate"),
    [
        (Contact.HEEL, FLAT + 0.3, HALF_PI + 0.3, -4.0),
        (Contact.FLAT, FLAT, HALF_PI, 0.0),
        (Contact.FOREFOOT, FLAT - 0.4, HALF_PI, -3.0),
    ],
)
def test_eq4_a_standing_foot_rests(contact: Contact, foot: float, toes: float, rate: float) -> None:
    found = c.eq4_resting_point(contact, standing(contact, foot, toes, rate), HERE)
    np.testing.assert_allclose(found, 0.0, atol=1e-14)


@pytest.mark.parametrize(
    ("contact", "name", "place"),
    [
        (Contact.HEEL, "heel", HERE.heel),
        (Contact.FLAT, "metatarsal", HERE.metatarsal),
        (Contact.FOREFOOT, "metatarsal", HERE.metatarsal),
        (Contact.TOE, "toe_tip", HERE.toe_tip),
    ],
)
def test_eq4_tells_how_far_off_and_how_fast_the_point_is(
    contact: Contact, name: str, place: float
) -> None:
    moved = points(**{name: (place + 0.02, 0.03, -0.4, 0.5)})
    found = c.eq4_resting_point(contact, moved, HERE)
    assert found == pytest.approx((0.02, 0.03, -0.4, 0.5))


def test_eq4_nothing_rests_in_swing() -> None:
    assert c.eq4_resting_point(Contact.SWING, points(), HERE) == ()


@pytest.mark.parametrize(
    ("contact", "watched"),
    [
        (Contact.SWING, ("heel", "toe_tip")),
        (Contact.HEEL, ("metatarsal",)),
        (Contact.FLAT, ()),
        (Contact.FOREFOOT, ("heel",)),
        (Contact.TOE, ("heel", "metatarsal")),
    ],
)
def test_eq4_heights_are_those_of_the_free_points(
    contact: Contact, watched: tuple[str, ...]
) -> None:
    heights = {"heel": 0.01, "metatarsal": 0.02, "toe_tip": -0.03}
    posture = points(**{name: (0.0, y) for name, y in heights.items()})
    assert c.eq4_clearances(contact, posture) == tuple(heights[name] for name in watched)


def test_eq4_the_toes_up_lift_the_metatarsal_and_the_toes_down_lift_the_heel() -> None:
    landing = standing(Contact.HEEL, FLAT + 0.3, HALF_PI + 0.3)
    assert c.eq4_clearances(Contact.HEEL, landing)[0] == pytest.approx(
        LEG.heel_to_metatarsal * math.sin(0.3)
    )
    leaving = standing(Contact.FOREFOOT, FLAT - 0.4, HALF_PI)
    assert c.eq4_clearances(Contact.FOREFOOT, leaving)[0] == pytest.approx(
        LEG.heel_to_metatarsal * math.sin(0.4)
    )


def test_eq5_the_heel_lands_one_step_ahead_at_rest() -> None:
    assert c.eq5_landing(points(heel=(0.76, 0.0)), 0.76) == (0.0, 0.0, 0.0, 0.0)
    late = c.eq5_landing(points(heel=(0.70, 0.05, 0.3, -0.6)), 0.76)
    assert late == pytest.approx((-0.06, 0.05, 0.3, -0.6))


# --- (6) ---------------------------------------------------------------------------------------


def corridor(joint: str, width: float = 1.5) -> Corridor:
    return human_gait("winter-natural").angle_corridor(joint, width)


@given(st.floats(0, 1), st.sampled_from(["hip", "knee", "ankle"]), st.booleans())
def test_eq6_edges_are_at_minus_one_and_one(s: float, joint: str, leg_2: bool) -> None:
    band = corridor(joint)
    own = s + 0.5 if leg_2 else s
    middle, half = float(band.mean(own)), band.width * float(band.sd(own))
    for angle, place in ((band.lower(own), -1.0), (middle, 0.0), (band.upper(own), 1.0)):
        found = c.eq6_corridor_position(float(angle), middle, half)
        assert found == pytest.approx(place, abs=1e-9)


def test_eq6_is_signed_and_counts_in_half_widths() -> None:
    band = corridor("knee", width=2.0)
    mean, sd = float(band.mean(0.3)), float(band.sd(0.3))
    assert c.eq6_corridor_position(mean + 3 * sd, mean, 2 * sd) == pytest.approx(1.5)
    assert c.eq6_corridor_position(mean - sd, mean, 2 * sd) == pytest.approx(-0.5)


# --- (7) ---------------------------------------------------------------------------------------


def test_eq7_toes_bent_upward_are_allowed_and_downward_are_not() -> None:
    in_line = sole(LEG, Rotation(FLAT - 0.5)).angle
    for bend in (0.2, 0.0, -0.2):
        posture = LegMotion(
            Rotation(0), Rotation(0), Rotation(FLAT - 0.5), Rotation(in_line + bend)
        )
        assert c.eq7_toe_rotation(Contact.TOE, LEG, posture) == pytest.approx(bend, abs=1e-15)


@pytest.mark.parametrize("contact", [x for x in Contact if x is not Contact.TOE])
def test_eq7_toes_do_not_bend_freely_in_other_phases(contact: Contact) -> None:
    posture = LegMotion(*[Rotation(0.0)] * 4)
    with pytest.raises(ValueError, match=f"toe phase only, not in {contact.name}"):
        c.eq7_toe_rotation(contact, LEG, posture)


def test_eq7_toes_are_in_line_while_the_forefoot_is_free() -> None:
    assert [x for x in Contact if c.eq7_toes_in_line(x)] == [Contact.SWING, Contact.HEEL]


# --- (8), (9), limits --------------------------------------------------------------------------


def test_eq8_the_ground_pushes_up() -> None:
    assert c.eq8_vertical_reaction((30.0, 700.0)) == 700.0
    assert c.eq8_vertical_reaction((30.0, -5.0)) < 0


@pytest.mark.parametrize(
    ("contact", "first", "last"),
    [
        (Contact.HEEL, HERE.heel, HERE.heel),
        (Contact.FLAT, HERE.heel, HERE.metatarsal),
        (Contact.FOREFOOT, HERE.metatarsal, HERE.toe_tip),
        (Contact.TOE, HERE.toe_tip, HERE.toe_tip),
    ],
)
def test_eq9_the_load_stays_on_the_part_that_touches(
    contact: Contact, first: float, last: float
) -> None:
    assert c.eq9_pressure_edges(contact, HERE) == (first, last)
    reaction = (40.0, 600.0)
    for x_r in np.linspace(-0.1, 0.4, 11):
        before, after = c.eq9_pressure(contact, HERE, x_r * reaction[1], reaction)
        assert before == pytest.approx((x_r - first) * reaction[1])
        assert after == pytest.approx((last - x_r) * reaction[1])


def test_eq9_has_no_edge_in_swing() -> None:
    with pytest.raises(KeyError, match="SWING"):
        c.eq9_pressure_edges(Contact.SWING, HERE)


def test_eq9_moves_with_the_print() -> None:
    first, last = c.eq9_pressure_edges(Contact.FOREFOOT, BEHIND)
    assert first == pytest.approx(-0.76 + 0.2)
    assert last == pytest.approx(-0.76 + 0.2 + 0.1)


def test_eq9_stays_finite_where_the_reaction_vanishes() -> None:
    assert c.eq9_pressure(Contact.FLAT, HERE, 0.0, (0.0, 0.0)) == (0.0, 0.0)


def test_eq9_a_plantarflexor_moment_moves_the_load_forward() -> None:
    """p is counter-clockwise on the foot: plantarflexion is clockwise, negative."""
    posture = standing(Contact.FLAT, FLAT, HALF_PI)
    reaction = (0.0, 700.0)
    ankle = posture.ankle.position[0]
    at_rest, pushing = (pressure_moment(posture, p, reaction) / 700.0 for p in (0.0, -35.0))
    assert at_rest == pytest.approx(ankle)
    assert pushing == pytest.approx(ankle + 0.05)


def test_the_friction_cone_bounds_both_directions() -> None:
    assert c.limit_friction((300.0, 600.0), 0.5) == (0.0, 600.0)
    assert c.limit_friction((-300.0, 600.0), 0.5) == (600.0, 0.0)
    assert min(c.limit_friction((400.0, 600.0), 0.5)) < 0
    assert min(c.limit_friction((-400.0, 600.0), 0.5)) < 0
    assert min(c.limit_friction((0.0, -1.0), 0.5)) < 0


def test_what_is_fixed_at_boundaries_is_a_flat_foot_at_rest_and_no_moment_without_load() -> None:
    fixed = c.fixed_at_boundaries(FLAT)
    flat = {key: value for key, value in fixed.items() if key[2] != "control"}
    assert flat == {
        ("heel_end", "foot_1", "value"): FLAT,
        ("heel_end", "foot_1", "rate"): 0.0,
        ("heel_off", "foot_1", "value"): FLAT,
        ("heel_off", "foot_1", "rate"): 0.0,
    }
    moments = {key[:2]: value for key, value in fixed.items() if key[2] == "control"}
    assert set(moments.values()) == {0.0}
    assert ("other_toe_off", "ankle_2") in moments
    assert {key[0] for key in fixed} <= set(BOUNDARIES)


def test_a_flat_foot_puts_heel_metatarsal_and_toes_on_the_ground() -> None:
    """The value that is fixed is the right one."""
    posture = standing(Contact.FLAT, FLAT, HALF_PI)
    where = Footprint(*(p.position[0] for p in (posture.heel, posture.metatarsal, posture.toe_tip)))
    assert (where.heel, where.metatarsal, where.toe_tip) == pytest.approx(
        (HERE.heel, HERE.metatarsal, HERE.toe_tip)
    )
    for point in (posture.heel, posture.metatarsal, posture.toe_tip):
        assert point.position[1] == pytest.approx(0.0, abs=1e-15)
