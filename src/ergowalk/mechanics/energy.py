"""Kinetic and potential energy of the walker, summed over its segments."""

from __future__ import annotations

import math
from typing import Any

from ergowalk.body import Body
from ergowalk.mechanics.functions import cos, sin
from ergowalk.mechanics.kinematics import BodyMotion, Point, Rotation, link


def kinetic_energy(body: Body, motion: BodyMotion) -> Any:
    """Kinetic energy [J] of trunk, thighs, shanks and feet.

    Inertias are about the proximal joint P of each segment, hence
    m |v_P|^2 / 2 + m r v_P . n phi' + J phi'^2 / 2.
    """
    trunk = Rotation(motion.trunk.angle + math.pi, motion.trunk.rate)
    total = _segment(
        body.trunk_mass_kg, body.trunk_com_m, body.trunk_inertia_kgm2, motion.hip, trunk
    )
    for i, leg in enumerate(motion.legs):
        p = body.leg(i)
        knee = motion.hip + link(p.thigh_length, leg.thigh)
        v_x, v_y = (knee + link(p.shank_length, leg.shank)).velocity
        total = (
            total
            + _segment(p.thigh_mass, p.thigh_com, p.thigh_inertia, motion.hip, leg.thigh)
            + _segment(p.shank_mass, p.shank_com, p.shank_inertia, knee, leg.shank)
            + p.foot_mass * (v_x**2 + v_y**2) / 2
        )
    return total


def potential_energy(body: Body, motion: BodyMotion) -> Any:
    """Potential energy [J] in uniform gravity, zero at the ground."""
    y = motion.hip.position[1]
    moment = body.trunk_mass_kg * (y + body.trunk_com_m * cos(motion.trunk.angle))
    for i, leg in enumerate(motion.legs):
        p = body.leg(i)
        knee = y - p.thigh_length * cos(leg.thigh.angle)
        moment = (
            moment
            + p.thigh_mass * (y - p.thigh_com * cos(leg.thigh.angle))
            + p.shank_mass * (knee - p.shank_com * cos(leg.shank.angle))
            + p.foot_mass * (knee - p.shank_length * cos(leg.shank.angle))
        )
    return body.gravity_m_s2 * moment


def _segment(mass: Any, com: Any, inertia: Any, joint: Point, rotation: Rotation) -> Any:
    v_x, v_y = joint.velocity
    sweep = v_x * cos(rotation.angle) + v_y * sin(rotation.angle)
    return (
        mass * (v_x**2 + v_y**2) / 2
        + mass * com * rotation.rate * sweep
        + inertia * rotation.rate**2 / 2
    )
