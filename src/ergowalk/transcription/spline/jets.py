"""Values with their first two time derivatives, so that closed forms differentiate themselves.

Everything takes CasADi symbols. :meth:`Jet.floored` keeps roots real where the geometry is
impossible: twice continuously differentiable, and the identity wherever it is possible.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca

from ergowalk.mechanics.functions import cos, sin
from ergowalk.mechanics.kinematics import Point, Rotation

LEAST = 0.25
"""What remains of a floor far below it."""


@dataclass(frozen=True)
class Jet:
    """A quantity with its rate and acceleration."""

    value: Any
    rate: Any = 0.0
    acceleration: Any = 0.0

    def __add__(self, other: Jet | float) -> Jet:
        o = _jet(other)
        return Jet(self.value + o.value, self.rate + o.rate, self.acceleration + o.acceleration)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.rate, -self.acceleration)

    def __sub__(self, other: Jet | float) -> Jet:
        return self + (-_jet(other))

    def __mul__(self, other: Jet | float) -> Jet:
        o = _jet(other)
        return Jet(
            self.value * o.value,
            self.rate * o.value + self.value * o.rate,
            self.acceleration * o.value + 2 * self.rate * o.rate + self.value * o.acceleration,
        )

    def squared(self) -> Jet:
        """The square."""
        return self * self

    def sin(self) -> Jet:
        """Sine of radians."""
        s, c = sin(self.value), cos(self.value)
        return Jet(s, c * self.rate, c * self.acceleration - s * self.rate**2)

    def cos(self) -> Jet:
        """Cosine of radians."""
        s, c = sin(self.value), cos(self.value)
        return Jet(c, -s * self.rate, -s * self.acceleration - c * self.rate**2)

    def root(self) -> Jet:
        """Square root of a positive quantity."""
        r = ca.sqrt(self.value)
        rate = self.rate / (2 * r)
        return Jet(r, rate, (self.acceleration - 2 * rate**2) / (2 * r))

    def floored(self, floor: float) -> tuple[Jet, Any]:
        """The same where it is above ``floor`` > 0, positive everywhere; and what was added."""
        value, slope, curvature = _floor(self.value, floor)
        raised = Jet(
            value,
            slope * self.rate,
            slope * self.acceleration + curvature * self.rate**2,
        )
        return raised, value - self.value

    @property
    def rotation(self) -> Rotation:
        """The jet of an angle as the mechanics take it."""
        return Rotation(self.value, self.rate, self.acceleration)

    @classmethod
    def of(cls, rotation: Rotation) -> Jet:
        """The jet of a rotation."""
        return cls(rotation.angle, rotation.rate, rotation.acceleration)


def arctan2(y: Jet, x: Jet) -> Jet:
    """Angle of the vector (x, y) from the x axis [rad]; not for the zero vector."""
    square = x.value**2 + y.value**2
    rate = (x.value * y.rate - y.value * x.rate) / square
    stretch = x.value * x.rate + y.value * y.rate
    turn = x.value * y.acceleration - y.value * x.acceleration
    return Jet(ca.atan2(y.value, x.value), rate, (turn - 2 * stretch * rate) / square)


def coordinates(point: Point) -> tuple[Jet, Jet]:
    """A moving point as two jets."""
    (x, y), (v_x, v_y), (a_x, a_y) = point.position, point.velocity, point.acceleration
    return Jet(x, v_x, a_x), Jet(y, v_y, a_y)


def point(x: Jet, y: Jet) -> Point:
    """Two jets as a moving point."""
    return Point((x.value, y.value), (x.rate, y.rate), (x.acceleration, y.acceleration))


def floored(value: Any, floor: float) -> Any:
    """A number as in :meth:`Jet.floored`: itself above ``floor``, never below LEAST of it."""
    return _floor(value, floor)[0]


def capped(value: Any, cap: float, margin: float) -> Any:
    """A number up to ``cap``, then bending to stay below ``cap + margin``; C2."""
    return cap + margin - floored(cap + margin - value, margin)


def _floor(value: Any, floor: float) -> tuple[Any, Any, Any]:
    """f(s) with f', f'': s above the floor e, else e (b + (1 - b) / (1 + w + w^2)) with
    w = (1 - s/e) / (1 - b): slope 1 and curvature 0 at s = e, tending to b e."""
    width = 1 - LEAST
    w = ca.fmax(0.0, (1 - value / floor) / width)
    q, d = 1 + w + w**2, 1 + 2 * w
    lowered = floor * (LEAST + width / q)
    slope = d / q**2
    curvature = (2 * d**2 / q**3 - 2 / q**2) / (floor * width)
    return ca.fmax(0.0, value - floor) + lowered, slope, curvature


def _jet(value: Jet | float) -> Jet:
    return value if isinstance(value, Jet) else Jet(value)
