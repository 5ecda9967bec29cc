"""What is unknown of the walker in a phase: coordinates, own moments, reactions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.transcription.design import frees_toes
from ergowalk.transcription.phases import Coordinate, Unknown

if TYPE_CHECKING:
    from ergowalk.transcription.walker import Walker

RATE, ACCELERATION, FORCE = 3.0, 30.0, 10.0
"""Typical sizes by which unknowns and rows are divided (rad/s, rad/s2, N/kg)."""


def coordinates(walker: Walker, phase: Phase) -> tuple[Coordinate, ...]:
    """Angles of this phase; a flat foot has none, a foot on its toe tip follows the ankle.

    The two lines of (12) are coordinates too, of no acceleration.
    """
    names = ["trunk", "thigh_1", "shank_1", "thigh_2", "shank_2"]
    if phase.legs[0] is not Contact.FLAT:
        names.append("foot_1")
    if phase.legs[1] is Contact.SWING:
        names.append("foot_2")
    angles = [Coordinate(n, rate_scale=RATE, acceleration_scale=ACCELERATION) for n in names]
    if phase.legs[1] is Contact.TOE and walker.linear_sharing:
        # the load passes between metatarsal joint and toe tip
        toes = -np.inf if frees_toes(walker.problem) else -walker.legs[1].toe_length
        angles.append(Coordinate("pressure_shift", toes, 0.0))
        angles.append(Coordinate("reaction_share", rate_scale=FORCE))
    return (*angles, *walker.fittings.coordinates(phase))


def controls(walker: Walker, phase: Phase) -> tuple[Unknown, ...]:
    """The walker's own moments per kg that can do work, or carry load over the toes."""
    names = ["hip_1", "knee_1", "ankle_1", "hip_2", "knee_2"]
    if phase.legs[0] is Contact.FOREFOOT:
        names.append("metatarsal_1")
    if phase.legs[1] is Contact.TOE:
        names += ["ankle_2", "metatarsal_2"]
    names = [n for n in names if _own(walker, phase, n)]
    strength = [limits.moment_nm_per_kg for limits in walker.limits]
    bounds = {n: strength[int(n[-1]) - 1].of(n[:-2]) or np.inf for n in names}
    return tuple(Unknown(n, -bounds[n], bounds[n]) for n in names)


def _own(walker: Walker, phase: Phase, name: str) -> bool:
    role = int(name[-1]) - 1
    return walker.fittings.own(role, name[:-2], phase.legs[role])


def algebraics(walker: Walker, phase: Phase) -> tuple[Unknown, ...]:
    """Ground reactions and moments of locks per kg; the trailing foot on its toe tip."""
    unknowns = []
    for i, contact in enumerate(phase.legs, start=1):
        if contact is not Contact.SWING:
            cap = walker.limits[i - 1].vertical_reaction_body_weights
            highest = np.inf if cap == "off" else cap * walker.gravity
            unknowns.append(Unknown(f"reaction_x_{i}", scale=FORCE))
            unknowns.append(Unknown(f"reaction_y_{i}", 0.0, highest, FORCE))
    if phase.legs[1] is Contact.TOE:
        unknowns += [Unknown("foot_2"), Unknown("toes_2")]
        unknowns += [Unknown(n, scale=RATE) for n in ("foot_2_rate", "toes_2_rate")]
    return (*unknowns, *walker.fittings.algebraics(phase))
