"""Inverse dynamics of a leg from the ground up, the foot with its true mass (Winter 2009)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.anthropometry import segments
from ergowalk.body import LegParameters
from ergowalk.measured.filtering import differences
from ergowalk.measured.kinematics import hanging
from ergowalk.measured.loads import CONTACT, pressure

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointLoads:
    """Moments (n,) [N m] at hip, knee, ankle and metatarsals on the distal segment, counter-
    clockwise +, and the forces (n, 2) [N] on it there."""

    moments: Mapping[str, Array]
    forces: Mapping[str, Array]


@dataclass(frozen=True)
class _Load:
    """Force (n, 2) [N] and moment (n,) about the origin [N m]."""

    force: Array
    moment: Array


def joint_loads(
    leg: Mapping[str, Array], parameters: LegParameters, load: Array, rate: float, gravity: float
) -> JointLoads:
    """Loads of the joints of a leg.

    Parameters
    ----------
    leg : mapping
        Points by role, (n, 2) or more: forward and up [m].
    parameters : LegParameters
        Masses, and centres and inertias of thigh and shank. The foot's centre of mass is half way
        from ankle to metatarsals, its radius of gyration 0.475 of that (Dempster).
    load : (n, 3) array
        Force of the ground on the foot and its moment about the origin.
    rate, gravity : float
        Frames per second; m/s2.
    """
    point = {role: values[:, :2] for role, values in leg.items()}
    p = parameters
    foot = segments("dempster", "male")["foot"]
    foot_length = float(np.linalg.norm(point["ankle"] - point["metatarsal"], axis=1).mean())
    parts = (
        ("ankle", "metatarsal", foot.com, p.foot_mass,
         p.foot_mass * foot.gyration**2 * foot_length**2),
        ("knee", "ankle", p.shank_com / p.shank_length, p.shank_mass,
         p.shank_inertia - p.shank_mass * p.shank_com**2),
        ("hip", "knee", p.thigh_com / p.thigh_length, p.thigh_mass,
         p.thigh_inertia - p.thigh_mass * p.thigh_com**2),
    )  # fmt: skip
    below = _Load(load[:, :2], load[:, 2])
    moments: dict[str, Array] = {"metatarsal": _toe_moment(point["metatarsal"], load)}
    forces: dict[str, Array] = {}
    for joint, distal, share, mass, inertia in parts:
        upper, lower = point[joint], point[distal]
        needed = _needed(upper, lower, share, mass, max(inertia, 0.0), rate, gravity)
        above = _Load(needed.force - below.force, needed.moment - below.moment)
        forces[joint] = above.force
        moments[joint] = above.moment - _cross(upper, above.force)
        below = _Load(-above.force, -above.moment)  # on the next segment up, about the origin too
    return JointLoads(moments, forces)


def _needed(
    upper: Array, lower: Array, share: float, mass: float, inertia: float, rate: float, g: float
) -> _Load:
    """All that acts on a segment beside its weight: mass times acceleration, and the rate of its
    spin, about the origin."""
    centre = upper + share * (lower - upper)
    acceleration = differences(differences(centre, rate), rate)
    force = mass * (acceleration + np.array([0.0, g]))
    spin = inertia * differences(differences(hanging(upper, lower), rate), rate)
    return _Load(force, spin + _cross(centre, force))


def _toe_moment(metatarsal: Array, load: Array) -> Array:
    """Metatarsal moment w (n,): that of the load about the metatarsals while it passes ahead of
    them, without which the toes would not be where they are; their mass is in the foot."""
    about = load[:, 2] - _cross(metatarsal, load[:, :2])
    ahead = np.nan_to_num(pressure(load) - metatarsal[:, 0]) > 0
    return np.where(ahead & (load[:, 1] > CONTACT), -about, 0.0)


def _cross(arm: Array, force: Array) -> Array:
    turned: Array = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
    return turned
