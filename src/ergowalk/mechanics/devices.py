"""Springs and dampers at a joint: moments, stored energy, and how fast the moment changes.

Deflections x are those of a joint angle from the rest angle of the device, in the sense in which
joint angles are counted (hip and knee flexion, ankle dorsiflexion, toes bent up). All functions
take numbers, NumPy arrays or CasADi expressions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ergowalk.body import LegParameters
from ergowalk.mechanics.kinematics import LegMotion, Rotation, joint_angles

SENSE = {"hip": 1.0, "knee": -1.0, "ankle": 1.0, "metatarsal": 1.0}
"""Rate of a joint angle over the relative rate, distal minus proximal, that moments work on."""

ROUNDING = float(np.radians(0.5))
"""Deflection [rad] over which the slope of a spring with two slopes turns from one to the other."""


@dataclass(frozen=True)
class Law:
    """A spring of two slopes beside a damper, or in series with it.

    Parameters
    ----------
    above, below
        Stiffness [N m/rad] for deflections above and below rest.
    damping
        N m s/rad.
    """

    above: Any
    below: Any
    damping: Any

    def spring(self, x: Any) -> Any:
        """Moment [N m] that deflects the spring by x [rad].

        One slope is linear; two slopes are joined by a hyperbola of half width :data:`ROUNDING`,
        so that the moment is smooth and the energy its exact integral.
        """
        if self.above is self.below:
            return self.above * x
        return self.below * x + (self.above - self.below) * _ramp(x)

    def slope(self, x: Any) -> Any:
        """Derivative of :meth:`spring` [N m/rad]."""
        if self.above is self.below:
            return self.above
        return self.below + (self.above - self.below) * (1 + x / _root(x)) / 2

    def stored(self, x: Any) -> Any:
        """Energy in the spring [J], zero at rest."""
        linear = self.below * x**2 / 2
        if self.above is self.below:
            return linear
        inner = _asinh(x / ROUNDING)
        ramp = (x**2 + x * _root(x) + ROUNDING**2 * inner) / 4 - ROUNDING * x / 2
        return linear + (self.above - self.below) * ramp

    def moment(self, x: Any, rate: Any) -> Any:
        """Moment [N m] against a deflection x [rad] that grows at a rate [rad/s], side by side."""
        return self.spring(x) + self.damping * rate

    def moment_rate(self, x: Any, rate: Any, acceleration: Any) -> Any:
        """Time derivative of :meth:`moment` [N m/s]."""
        return self.slope(x) * rate + self.damping * acceleration


def _root(x: Any) -> Any:
    return (x**2 + ROUNDING**2) ** 0.5


def _ramp(x: Any) -> Any:
    """max(x, 0), rounded, and zero at zero."""
    return (x + _root(x) - ROUNDING) / 2


def _asinh(x: Any) -> Any:
    return x.arcsinh() if hasattr(x, "arcsinh") else np.arcsinh(x)


def joint_rotation(leg: LegParameters, joint: str, trunk: Rotation, motion: LegMotion) -> Rotation:
    """Joint angle [rad] of (6) or (7) with its rate and acceleration."""
    segments = (motion.thigh, motion.shank, motion.foot, motion.toes)
    angles = joint_angles(leg, trunk.angle, *(s.angle for s in segments))
    before, after = {
        "hip": (trunk, motion.thigh),
        "knee": (motion.shank, motion.thigh),
        "ankle": (motion.shank, motion.foot),
        "metatarsal": (motion.foot, motion.toes),
    }[joint]
    index = list(SENSE).index(joint)
    return Rotation(
        angles[index], after.rate - before.rate, after.acceleration - before.acceleration
    )
