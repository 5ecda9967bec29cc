"""Where the points of the walker are, how fast they move and how they accelerate.

Angles are absolute, counter-clockwise positive, measured from the downward vertical for thigh,
shank, foot (line ankle -> metatarsal joint) and toes, and from the upward vertical for the trunk.
All functions take numbers, NumPy arrays or CasADi expressions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ergowalk.body import LegParameters
from ergowalk.mechanics.functions import cos, sin

Vector = tuple[Any, Any]
"""Horizontal and vertical component."""


@dataclass(frozen=True)
class Rotation:
    """An angle [rad] with its rate [rad/s] and angular acceleration [rad/s2]."""

    angle: Any
    rate: Any = 0.0
    acceleration: Any = 0.0

    def plus(self, offset: float) -> Rotation:
        """The same rotation seen from a line turned by a constant ``offset`` [rad]."""
        return Rotation(self.angle + offset, self.rate, self.acceleration)


@dataclass(frozen=True)
class Point:
    """A moving point: position [m], velocity [m/s] and acceleration [m/s2]."""

    position: Vector
    velocity: Vector = (0.0, 0.0)
    acceleration: Vector = (0.0, 0.0)

    def __add__(self, other: Point) -> Point:
        return Point(
            _sum(self.position, other.position),
            _sum(self.velocity, other.velocity),
            _sum(self.acceleration, other.acceleration),
        )

    def __sub__(self, other: Point) -> Point:
        return Point(
            _difference(self.position, other.position),
            _difference(self.velocity, other.velocity),
            _difference(self.acceleration, other.acceleration),
        )


@dataclass(frozen=True)
class LegMotion:
    """The four segment angles of one leg: alpha, beta, gamma, epsilon of the paper."""

    thigh: Rotation
    shank: Rotation
    foot: Rotation
    toes: Rotation


@dataclass(frozen=True)
class BodyMotion:
    """The whole walker: hip point O, trunk angle psi, two legs."""

    hip: Point
    trunk: Rotation
    legs: tuple[LegMotion, LegMotion]


@dataclass(frozen=True)
class LegPoints:
    """The named points of one leg: K, A, H, M, T of the paper."""

    knee: Point
    ankle: Point
    heel: Point
    metatarsal: Point
    toe_tip: Point


def link(length: Any, rotation: Rotation) -> Point:
    """Tip of a rod of ``length`` [m] relative to its base.

    The rod hangs along (sin, -cos) of its angle; velocity and acceleration are the exact time
    derivatives.
    """
    s, c = sin(rotation.angle), cos(rotation.angle)
    tangential, centripetal = length * rotation.acceleration, length * rotation.rate**2
    return Point(
        (length * s, -length * c),
        (length * rotation.rate * c, length * rotation.rate * s),
        (tangential * c - centripetal * s, tangential * s + centripetal * c),
    )


def leg_points(leg: LegParameters, motion: LegMotion, hip: Point) -> LegPoints:
    """Points of one leg hanging from the ``hip``."""
    knee = hip + link(leg.thigh_length, motion.thigh)
    ankle = knee + link(leg.shank_length, motion.shank)
    metatarsal = ankle + link(leg.ankle_to_metatarsal, motion.foot)
    heel = metatarsal - link(leg.heel_to_metatarsal, sole(leg, motion.foot))
    toe_tip = metatarsal + link(leg.toe_length, motion.toes)
    return LegPoints(knee, ankle, heel, metatarsal, toe_tip)


def sole(leg: LegParameters, foot: Rotation) -> Rotation:
    """Angle of the sole H -> M, pi/2 when flat: the foot angle plus phi_m."""
    return foot.plus(leg.foot_angle)


def hip_over_contact(leg: LegParameters, motion: LegMotion, contact: str, point: Vector) -> Point:
    """Hip point O of a leg that stands on ``point``.

    Parameters
    ----------
    contact : {"heel", "metatarsal"}
        Which point of the foot rests on the ground; a flat foot rests on either.
    point : (x, y)
        Where it rests [m].

    Raises
    ------
    KeyError
        If ``contact`` is neither.
    """
    base = Point(point)
    metatarsal = {
        "heel": lambda: base + link(leg.heel_to_metatarsal, sole(leg, motion.foot)),
        "metatarsal": lambda: base,
    }[contact]()
    ankle = metatarsal - link(leg.ankle_to_metatarsal, motion.foot)
    return ankle - link(leg.shank_length, motion.shank) - link(leg.thigh_length, motion.thigh)


def joint_angles(
    leg: LegParameters, trunk: Any, thigh: Any, shank: Any, foot: Any, toes: Any
) -> tuple[Any, Any, Any, Any]:
    """Hip, knee, ankle angle of (6) and the toe angle of (7), in rad.

    mu_o = alpha - psi, mu_k = alpha - beta, mu_a = gamma - beta + phi_m - pi/2 and
    epsilon - gamma - phi_m; flexion and dorsiflexion positive. The arguments are the absolute
    angles psi, alpha, beta, gamma, epsilon [rad].
    """
    return (
        thigh - trunk,
        thigh - shank,
        foot - shank + leg.foot_angle - HALF_PI,
        toes - foot - leg.foot_angle,
    )


def joint_rates(
    trunk: Any, thigh: Any, shank: Any, foot: Any, toes: Any
) -> tuple[Any, Any, Any, Any]:
    """Relative rates that the moments q, u, p, w work on in (10), in rad/s.

    alpha' - psi', beta' - alpha', gamma' - beta', epsilon' - gamma': distal minus proximal, so
    that moment times rate is the power delivered to the walker.
    """
    return thigh - trunk, shank - thigh, foot - shank, toes - foot


HALF_PI = math.pi / 2


def _sum(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1]


def _difference(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1]
