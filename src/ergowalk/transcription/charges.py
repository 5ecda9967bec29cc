"""What the walker pays for: the powers and squares of its own moments, and help for devices."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ergowalk.gait.rhythm import Phase
from ergowalk.mechanics.kinematics import BodyMotion, Rotation
from ergowalk.problem import JOINTS, Objective
from ergowalk.problem.objective import eq10_joint_powers, squared_moments
from ergowalk.transcription.devices import LOADED_JOINTS
from ergowalk.transcription.phases import Instant, Terms

if TYPE_CHECKING:
    from ergowalk.transcription.walker import Walker


def work_price(objective: Objective) -> float:
    """What a joule gained and lost again costs, over what it costs in E; 1 if work is free."""
    return sum(objective.of_work) / 2 if objective.charges_work else 1.0


def charge_own_moments(
    walker: Walker, terms: Terms, phase: Phase, instant: Instant, motion: BodyMotion
) -> None:
    """Powers of the walker's own moments (10), and the cost of their squares."""
    objective, own = walker.problem.objective, walker.own_moments(instant)
    paid = list(instant.controls.values())
    for i, contact in enumerate(phase.legs):
        powers = eq10_joint_powers(own[i], motion.trunk, motion.legs[i])
        charged = [
            power
            for joint, power in zip(JOINTS, powers, strict=True)
            if joint in LOADED_JOINTS[contact] and walker.fittings.own(i, joint, contact)
        ]
        held = walker.fittings.own_in_swing(i, contact, motion, instant)
        if held is not None:
            paid.append(held.angle)
            charged.append(held.angle * (motion.legs[i].foot.rate - motion.legs[i].shank.rate))
            _hold(walker, terms, held, i)
        if objective.charges_work:
            terms.absolute += charged
    terms.integrand = terms.integrand + walker.fittings.help(phase, instant, motion)
    if objective.moment_squared_s_per_m2:
        squares = objective.moment_squared_s_per_m2 * squared_moments(paid)
        terms.integrand = terms.integrand + squares


def _hold(walker: Walker, terms: Terms, held: Rotation, role: int) -> None:
    """Limits and cost of the own ankle moment that holds a device in swing, and of its rate."""
    limits = walker.limits[role]
    strength = limits.moment_nm_per_kg.of("ankle")
    speed = limits.moment_rate_nm_per_kg_s.of("ankle")
    if strength is not None:
        terms.between("control bounds", held.angle / strength, -1.0, 1.0)
    if speed is not None:
        terms.between("moment rate", held.rate / speed, -1.0, 1.0)
    price = walker.problem.objective.moment_rate_squared_s3_per_m2 + walker.small.moment_rate
    terms.integrand = terms.integrand + price * held.rate**2
