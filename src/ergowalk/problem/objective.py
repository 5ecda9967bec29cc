"""Objective (10): the integral of absolute joint power per metre."""

from __future__ import annotations

from typing import Any

from ergowalk.mechanics.dynamics import LegMoments
from ergowalk.mechanics.kinematics import LegMotion, Rotation, joint_rates


def eq10_joint_powers(
    moments: LegMoments, trunk: Rotation, leg: LegMotion
) -> tuple[Any, Any, Any, Any]:
    """Powers [W] of hip, knee, ankle and metatarsal moment of one leg, terms of (10).

    Moment times relative rate, distal minus proximal: positive where the moment puts energy into
    the walker. (10) writes the rates with the other sign; the absolute value does not mind.
    """
    rates = joint_rates(trunk.rate, leg.thigh.rate, leg.shank.rate, leg.foot.rate, leg.toes.rate)
    values = (moments.hip, moments.knee, moments.ankle, moments.metatarsal)
    hip, knee, ankle, metatarsal = (m * r for m, r in zip(values, rates, strict=True))
    return hip, knee, ankle, metatarsal


def energy_per_metre(half_stride_integral: Any, step_length: float) -> Any:
    """E of (10) [J/m] from the integral of all absolute powers over half a stride [J].

    By the symmetry of the legs, 1/(2L) over T equals 1/L over T/2.
    """
    return half_stride_integral / step_length
