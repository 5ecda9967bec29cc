"""The motion in closed form from the free functions (11), one instant at a time.

Leg 1 stands: contact and foot angle give its ankle, hip abscissa and knee angle the hip. Leg 2
hangs from the hip; while its toe tip rests, ankle, metatarsal joint and tip are a two-link chain.
Where a length cannot be reached the geometry is bent (:meth:`~.jets.Jet.floored`), and what was
missing is returned in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca

from ergowalk.body import LegParameters
from ergowalk.gait.footprints import Footprint
from ergowalk.gait.rhythm import Contact
from ergowalk.mechanics.kinematics import HALF_PI, LegMotion, Point, Rotation, link, sole
from ergowalk.transcription.spline.jets import Jet, arctan2, coordinates, floored, point

HIP_ABOVE_ANKLE = 0.2
"""Height of the hip over the ankle [m] below which the leg is taken to be out of reach."""

TOE_OFF_OFFSET = 0.05
"""Distance of the ankle from the line hip - toe tip [m] below which toe-off is out of reach."""

UPRIGHT = 0.1
"""Square of the cosine of the trunk angle below which the trunk is taken to be out of reach."""


@dataclass(frozen=True)
class Standing:
    """Hip and leg 1 over its contact; ``missing`` [m]."""

    hip: Point
    leg: LegMotion
    missing: Any


@dataclass(frozen=True)
class ToeOff:
    """Leg 2 at toe-off: jets (value and rate) of thigh and foot; ``missing`` [m]."""

    thigh: Jet
    foot: Jet
    missing: Any


def ankle_over(leg: LegParameters, contact: Contact, place: Footprint, foot: Jet) -> Point:
    """Ankle of a leg that stands on heel (HEEL) or metatarsal joint (FLAT, FOREFOOT)."""
    rotation = foot.rotation
    if contact is Contact.HEEL:
        base = Point((place.heel, 0.0)) + link(leg.heel_to_metatarsal, sole(leg, rotation))
    else:
        base = Point((place.metatarsal, 0.0))
    return base - link(leg.ankle_to_metatarsal, rotation)


def leg_length(leg: LegParameters, knee: Jet) -> Jet:
    """Square of the hip-ankle distance, a^2 + b^2 + 2 a b cos mu^k [m2]."""
    a, b = leg.thigh_length, leg.shank_length
    return knee.cos() * (2 * a * b) + (a**2 + b**2)


def thigh_offset(leg: LegParameters, knee: Jet) -> Jet:
    """Angle of the thigh before the line hip-ankle."""
    a, b = leg.thigh_length, leg.shank_length
    return arctan2(knee.sin() * b, knee.cos() * b + a)


def standing(
    leg: LegParameters, contact: Contact, place: Footprint, knee: Jet, hip_x: Jet, foot: Jet
) -> Standing:
    """Hip and leg 1 from knee angle, hip abscissa and foot angle: y by Pythagoras."""
    ankle_x, ankle_y = coordinates(ankle_over(leg, contact, place, foot))
    ahead, length = hip_x - ankle_x, leg_length(leg, knee)
    square, added = (length - ahead.squared()).floored(HIP_ABOVE_ANKLE**2)
    height = square.root()
    missing = added / (ca.sqrt(ahead.value**2 + square.value) + ca.sqrt(length.value))
    thigh = arctan2(-ahead, height) + thigh_offset(leg, knee)
    toes = sole(leg, foot.rotation) if contact is Contact.HEEL else Rotation(HALF_PI)
    motion = LegMotion(thigh.rotation, (thigh - knee).rotation, foot.rotation, toes)
    return Standing(point(hip_x, ankle_y + height), motion, missing)


def trunk(hip_x: Jet, trunk_x: Jet, distance: float) -> tuple[Jet, Any]:
    """psi from x_g = x - d sin psi; and what is missing [m]."""
    sine = (hip_x - trunk_x) * (1 / distance)
    square, added = (Jet(1.0) - sine.squared()).floored(UPRIGHT)
    return arctan2(sine, square.root()), distance * added / 2


def hanging(leg: LegParameters, hip: Point, thigh: Jet, knee: Jet) -> tuple[Rotation, Point]:
    """Shank and ankle of a leg from the hip down."""
    shank = (thigh - knee).rotation
    return shank, hip + link(leg.thigh_length, thigh.rotation) + link(leg.shank_length, shank)


def toe_support(leg: LegParameters, ankle: Point, tip: float) -> tuple[Rotation, Rotation, Any]:
    """gamma, epsilon of a foot on its toe tip, as :func:`ergowalk.mechanics.foot.toe_chain`.

    ``missing`` [m]: how much farther the tip is than a foot with its toes in line reaches, which
    is (7), epsilon - gamma - phi_m >= 0; or how much too near.
    """
    c, l_m = leg.ankle_to_metatarsal, leg.toe_length
    x, y = coordinates(ankle)
    d_x, d_y = Jet(tip) - x, -y
    square = d_x.squared() + d_y.squared()
    at_ankle, at_toe = square + (c**2 - l_m**2), square + (l_m**2 - c**2)
    least = (2 * c * l_m * min(0.3, math.sin(leg.foot_angle) / 2)) ** 2
    area, added = (square * (4 * c**2) - at_ankle.squared()).floored(least)
    root, line = area.root(), arctan2(d_x, -d_y)
    foot, toes = line - arctan2(root, at_ankle), line + arctan2(root, at_toe)
    longest = straight_foot(leg)
    too_long = ca.fmax(0.0, square.value - longest**2) / (ca.sqrt(square.value) + longest)
    too_short = ca.if_else(square.value < c**2, added / (8 * c**2 * l_m), 0.0)
    return foot.rotation, toes.rotation, too_long + too_short


def straight_foot(leg: LegParameters) -> float:
    """Distance ankle - toe tip with the toes in line with the sole [m]."""
    c, l_m = leg.ankle_to_metatarsal, leg.toe_length
    return math.sqrt(c**2 + l_m**2 + 2 * c * l_m * math.cos(leg.foot_angle))


def hip_at_contact(
    leg: LegParameters, knees: tuple[Jet, Jet], ankles: tuple[Point, Point]
) -> tuple[Any, Any]:
    """Hip abscissa [m] at heel contact: the upper meeting point of the circles around the two
    ankles (leading, trailing); and what is missing [m]."""
    (x_1, y_1), (x_2, y_2) = (ankle.position for ankle in ankles)
    one, two = (leg_length(leg, knee).value for knee in knees)
    e_x, e_y = x_1 - x_2, y_1 - y_2
    apart = ca.sqrt(floored(e_x**2 + e_y**2, 0.01))
    along = (two - one + apart**2) / (2 * apart)
    under = two - along**2
    square = floored(under, HIP_ABOVE_ANKLE**2)
    missing = (square - under) / (ca.sqrt(along**2 + square) + ca.sqrt(two))
    return x_2 + (along * e_x - ca.sqrt(square) * e_y) / apart, missing


def toe_off(leg: LegParameters, hip: Point, knee: Jet, tip: float) -> ToeOff:
    """Leg 2 at toe-off (7): toes in line with the sole, value and rate.

    The ankle is the rear meeting point of the circles around hip and toe tip, and its velocity is
    square to the line to the tip.
    """
    reach = straight_foot(leg)
    length = leg_length(leg, knee).root()
    (x_o, y_o), (v_x, v_y) = hip.position, hip.velocity
    r_x, r_y = x_o - tip, y_o
    apart = ca.sqrt(floored(r_x**2 + r_y**2, 0.01))
    along = (reach**2 - length.value**2 + apart**2) / (2 * apart)
    under = reach**2 - along**2
    square = floored(under, TOE_OFF_OFFSET**2)
    missing = (square - under) / (ca.sqrt(along**2 + square) + reach)
    side = ca.sqrt(square)
    # ankle minus toe tip, the rear side of the line tip -> hip; unit vector hip -> ankle
    a_x, a_y = (along * r_x - side * r_y) / apart, (along * r_y + side * r_x) / apart
    u_x, u_y = (a_x - r_x) / length.value, (a_y - r_y) / length.value
    drift_x, drift_y = v_x + length.rate * u_x, v_y + length.rate * u_y
    turn = -(a_x * drift_x + a_y * drift_y) / (length.value * (a_y * u_x - a_x * u_y))
    w_x, w_y = drift_x - length.value * turn * u_y, drift_y + length.value * turn * u_x
    thigh = Jet(ca.atan2(u_x, -u_y), turn) + thigh_offset(leg, knee)
    c, l_m, phi = leg.ankle_to_metatarsal, leg.toe_length, leg.foot_angle
    line = ca.atan2(-a_x, a_y)
    rate = -(w_x * a_y - w_y * a_x) / (a_x**2 + a_y**2)
    foot = Jet(line - math.atan2(l_m * math.sin(phi), c + l_m * math.cos(phi)), rate)
    return ToeOff(Jet(thigh.value, thigh.rate), foot, missing)
