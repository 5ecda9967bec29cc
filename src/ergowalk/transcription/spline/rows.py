"""What must hold of one instant, as rows with bounds for a solver of smooth programmes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import casadi as ca
import numpy as np

from ergowalk.corridors import ANGLES
from ergowalk.gait.rhythm import Contact
from ergowalk.problem import Limits
from ergowalk.problem import constraints as c
from ergowalk.transcription.spline.semi_inverse import Instant

FORCE, METRE = 10.0, 0.1
"""Typical force per mass [N/kg] and clearance [m] by which rows are divided."""

PRESSURE_SLACK = 1e-3
"""How far [m] the centre of pressure may be from the heel in the heel phase, where no spline can
hold it exactly: half of what the audit allows."""


GROUND_MARGIN, CORRIDOR_MARGIN, CAP_MARGIN = 1e-4, 0.015, 1e-3
"""Room left below clearances [m], inside corridors [half widths] and below the cap of the vertical
reaction [body weights] for what happens between the instants, where everything is asked for."""


class Asked(StrEnum):
    """Which constraints the programme has."""

    PAPER = "paper"
    """Those of (19): corridors, ground, vertical reaction, centre of pressure; and (7)."""

    EVERYTHING = "everything"
    """Those of the problem: (9) in the heel phase, and its physical limits, too."""


@dataclass(frozen=True)
class Row:
    """An expression between two bounds, and the constraint that it belongs to."""

    label: str
    expression: Any
    lower: float = 0.0
    upper: float = np.inf


def instant_rows(instant: Instant, asked: Asked, limits: Limits) -> list[Row]:
    """All rows of an instant but those that tie slacks and moments to it."""
    rows = []
    everything = asked is Asked.EVERYTHING
    widest = 1 - CORRIDOR_MARGIN * everything
    for i, angle in enumerate(instant.angles):
        low, high = instant.known[i], instant.known[6 + i]
        place = (2 * angle - low - high) / (high - low)
        rows.append(Row(f"corridor {ANGLES[i % 3]} (6)", place, -widest, widest))
    for leg, contact in enumerate(instant.phase.legs):
        heights = c.eq4_clearances(contact, instant.points[leg])
        room: Any = 0.0
        if everything and contact is Contact.SWING:
            # it leaves and meets the ground at rest: no more room than a parabola at either end
            part = instant.swing_fraction
            room = GROUND_MARGIN * (4 * part * (1 - part)) ** 2
        rows += [Row("clearance (4)", (height - room) / METRE) for height in heights]
        if contact is Contact.TOE:
            bend = c.eq7_toe_rotation(contact, instant.leg, instant.motion.legs[leg])
            rows.append(Row("toe rotation (7)", bend))
        if contact is not Contact.SWING:
            rows += _load_rows(instant, leg, asked, limits)
    return rows + _pressure_rows(instant, asked)


def six_moments(instant: Instant) -> list[Any]:
    """Hip, knee, ankle moments per kg of leg 1, then of leg 2 [N m/kg]."""
    mass = instant.problem.body.total_mass
    return [x / mass for m in instant.forces.moments for x in (m.hip, m.knee, m.ankle)]


def moment_rows(moments: ca.SX, instant: Instant, limits: Limits) -> list[Row]:
    """Moments as variables [N m/kg], and their limits."""
    rows = []
    for j, moment in enumerate(six_moments(instant)):
        rows.append(Row("moments", moments[j] - moment, 0.0, 0.0))
        bound = limits.moment_nm_per_kg.of(ANGLES[j % 3])
        if bound is not None:
            rows.append(Row("moment limits", moments[j] / bound, -1.0, 1.0))
    return rows


def _load_rows(instant: Instant, leg: int, asked: Asked, limits: Limits) -> list[Row]:
    force, unit = instant.forces.reactions[leg], FORCE * instant.problem.body.total_mass
    vertical, label = c.eq8_vertical_reaction(force) / unit, "vertical reaction (8)"
    if asked is Asked.PAPER:
        return [Row(label, vertical)]
    cap, friction = limits.vertical_reaction_body_weights, limits.friction_coefficient
    highest = np.inf if cap == "off" else (cap - CAP_MARGIN) * instant.weight / unit
    rows = [Row(label, vertical, 0.0, highest)]
    if friction != "off":
        rows += [Row("friction", x / unit) for x in c.limit_friction(force, friction)]
    return rows


def _pressure_rows(instant: Instant, asked: Asked) -> list[Row]:
    """(9) where the sharing of the load has not settled it; before the foot is flat (19) asks for
    less than (9)."""
    lead = instant.phase.legs[0]
    everything = asked is Asked.EVERYTHING
    if instant.phase.double_support and (lead is Contact.HEEL or not everything):
        return []
    place, unit = instant.prints[0], FORCE * METRE * instant.problem.body.total_mass
    moment, force = instant.forces.pressure_moment, instant.forces.reactions[0]
    if lead is Contact.HEEL and everything:
        first, last = place.heel - PRESSURE_SLACK, place.heel + PRESSURE_SLACK
        edges: tuple[Any, ...] = (moment - first * force[1], last * force[1] - moment)
    else:
        asked_of = Contact.FLAT if lead is Contact.HEEL else lead
        edges = c.eq9_pressure(asked_of, place, moment, force)
    return [Row("centre of pressure (9)", x / unit) for x in edges]
