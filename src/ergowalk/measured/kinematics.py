"""Segment and joint angles of a measured leg, in the model's signs, with their rates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.measured.events import Events
from ergowalk.measured.filtering import differences
from ergowalk.measured.trial import Trial

Array = NDArray[np.float64]

FLAT = (0.3, 0.5)
"""Part of the stance, from heel contact to toe-off, in which the foot is taken to be flat."""

STANDING = 0.15
"""Speed of the floor under a flat foot [m/s] up to which it is at rest: no treadmill."""


@dataclass(frozen=True)
class LegAngles:
    """Angles of a leg (n,) [rad] as in the model: thigh alpha, shank beta, sole gamma + phi_m
    (pi/2 when flat), toes epsilon (the sole's where there is no marker), trunk psi."""

    thigh: Array
    shank: Array
    sole: Array
    toes: Array
    trunk: Array
    toes_seen: bool

    def joints(self) -> dict[str, Array]:
        """Hip, knee, ankle and metatarsal angle (n,) [rad]: mu_o, mu_k, mu_a and the toes'."""
        return {
            "hip": self.thigh - self.trunk,
            "knee": self.thigh - self.shank,
            "ankle": self.sole - self.shank - np.pi / 2,
            "metatarsal": self.toes - self.sole,
        }

    def relative_rates(self, rate: float) -> dict[str, Array]:
        """Rates (n,) [rad/s] at which the moments of (10) work: of the distal segment against the
        proximal one."""
        thigh, shank, sole, toes, trunk = (
            differences(a, rate) for a in (self.thigh, self.shank, self.sole, self.toes, self.trunk)
        )
        return {
            "hip": thigh - trunk,
            "knee": shank - thigh,
            "ankle": sole - shank,
            "metatarsal": toes - sole,
        }


@dataclass(frozen=True)
class FootShape:
    """A foot that stands flat [m]: ankle over the floor, and ahead of the heel ankle, metatarsals
    and toe tip (NaN without marker)."""

    ankle_height: float
    ankle_ahead: float
    metatarsal_ahead: float
    toe_ahead: float


def hanging(upper: Array, lower: Array) -> Array:
    """Angle (n,) of the line from ``upper`` to ``lower`` from the downward vertical, forward +."""
    line = lower - upper
    angle: Array = np.unwrap(np.arctan2(line[:, 0], -line[:, 1]))
    return angle


def flat_frames(trial: Trial, events: Events) -> NDArray[np.bool_]:
    """Frames in which the foot of a leg is taken to be flat on the ground."""
    flat = np.zeros(len(trial.time), dtype=bool)
    for contact in events.contacts:
        later = [t for t in events.toe_offs if t > contact]
        if later and later[0] - contact < 2.0:
            first, last = (contact + share * (later[0] - contact) for share in FLAT)
            flat |= (trial.time >= first) & (trial.time <= last)
    return flat


def leg_angles(trial: Trial, side: str, flat: NDArray[np.bool_]) -> LegAngles:
    """Angles of a leg; sole and toes are horizontal, on the median, in the ``flat`` frames.

    Segment lines: hip to knee, knee to ankle, heel to metatarsals, metatarsals to toe tip, and
    for the trunk the middle of the hips to its upper marker.
    """
    leg = trial.legs[side]
    sole = _levelled(hanging(leg["heel"], leg["metatarsal"]), flat)
    toes = _levelled(hanging(leg["metatarsal"], leg["toe"]), flat) if "toe" in leg else sole
    trunk = np.zeros(len(trial.time))
    if trial.trunk is not None:
        line = trial.trunk - trial.hips
        trunk = np.arctan2(-line[:, 0], line[:, 1])
    return LegAngles(
        hanging(leg["hip"], leg["knee"]),
        hanging(leg["knee"], leg["ankle"]),
        sole,
        toes,
        trunk,
        "toe" in leg,
    )


def _levelled(angle: Array, flat: NDArray[np.bool_]) -> Array:
    levelled: Array = angle - float(np.median(angle[flat])) + np.pi / 2
    return levelled


def foot_shape(leg: Mapping[str, Array], flat: NDArray[np.bool_]) -> FootShape:
    """Medians over the ``flat`` frames."""

    def ahead(role: str) -> float:
        return float(np.median((leg[role] - leg["heel"])[flat, 0])) if role in leg else np.nan

    height = float(np.median(leg["ankle"][flat, 1]))
    return FootShape(height, ahead("ankle"), ahead("metatarsal"), ahead("toe"))


def belt_speed(trial: Trial, flat: Mapping[str, NDArray[np.bool_]]) -> float:
    """Forward speed of the floor [m/s], negative on a treadmill, by the flat feet; 0 if slow."""
    speeds = [
        differences(trial.legs[side]["metatarsal"][:, 0], trial.rate)[frames]
        for side, frames in flat.items()
        if frames.any()
    ]
    speed = float(np.median(np.concatenate(speeds))) if speeds else 0.0
    return speed if abs(speed) > STANDING else 0.0
