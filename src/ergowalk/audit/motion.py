"""Lines about the motion: curves and their rates, feet on the ground, symmetry of the legs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ergowalk.audit import residuals
from ergowalk.audit.record import (
    FLAT,
    FOREFOOT,
    HEEL,
    JOINTS,
    LEG_TABLES,
    SEGMENTS,
    SWING,
    TOE,
    Record,
)
from ergowalk.audit.report import LEGS, AuditLine, Worst, largest, worst
from ergowalk.audit.walker import FOOT, SHANK, THIGH, TOES, Array

SLOWEST = 1e-3
"""Rates [m/s, rad/s and their rates] below which a curve counts as being at rest."""

FOOT_POINTS = ("heel", "metatarsal joint", "toe tip")

_CURVES: tuple[tuple[tuple[str, str, str], tuple[Sequence[str], ...]], ...] = (
    (("hip_position", "hip_velocity", "hip_acceleration"), (("hip x", "hip y"),)),
    (("trunk_angle", "trunk_angular_velocity", "trunk_angular_acceleration"), ()),
    (
        ("segment_angle", "segment_angular_velocity", "segment_angular_acceleration"),
        (LEGS, SEGMENTS),
    ),
)


def curve_lines(record: Record) -> list[AuditLine]:
    """Velocities and accelerations against the curves, and no jump of either: no impact."""
    return [
        residuals.VELOCITIES.judged(_integral_error(record, 0)),
        residuals.ACCELERATIONS.judged(_integral_error(record, 1)),
        residuals.NO_IMPACT.judged(_jumps(record)),
    ]


def _integral_error(record: Record, order: int) -> Worst:
    """Error of the integral of each rate from t = 0, divided by its largest value times T."""
    found = []
    for names, axes in _CURVES:
        curve, rate = record.raw[names[order]], record.raw[names[order + 1]]
        error = record.pieces.cumulative(rate) - (curve - curve[0])
        error = error / (_largest_rate(rate) * record.stride_time)
        found.append(worst(error, record.time, *axes, one_sided=False))
    return largest(found)


def _jumps(record: Record) -> Worst:
    """Largest jump across an instant that stands twice, in the scale of its curve."""
    left, right = record.pieces.last[:-1], record.pieces.first[1:]
    if len(left) == 0:
        return Worst(0.0, "")
    found = []
    for (curve, rate, _), axes in _CURVES:
        scale = _largest_rate(record.raw[rate])
        for name, unit in ((curve, scale * record.stride_time), (rate, scale)):
            jump = (record.raw[name][right] - record.raw[name][left]) / unit
            found.append(worst(jump, record.time[left], *axes, one_sided=False))
    return largest(found)


def _largest_rate(rate: Array) -> Array:
    return np.asarray(np.maximum(np.max(np.abs(rate), axis=0), SLOWEST))


def foot_lines(record: Record) -> list[AuditLine]:
    """Contact points fixed in their prints, nothing below ground, toes as in (7), joint angles."""
    body, phase = record.body, record.phase
    points = np.stack([p.position for p in (body.heel, body.metatarsal, body.toe_tip)], axis=-1)
    rests = np.stack(
        [
            np.isin(phase, (HEEL, FLAT)),
            np.isin(phase, (FLAT, FOREFOOT)),
            np.isin(phase, (FLAT, FOREFOOT, TOE)),
        ],
        axis=-1,
    )
    astray = np.where(rests, np.abs(points - _prints(record)), 0.0)
    below = worst(-points.imag, record.time, LEGS, FOOT_POINTS)
    return [
        residuals.FEET_FIXED.judged(worst(astray, record.time, LEGS, FOOT_POINTS)),
        residuals.FEET_ABOVE_GROUND.judged(below),
        residuals.TOES.judged(_toes(record)),
        residuals.JOINT_ANGLES.judged(_angles(record)),
    ]


def _prints(record: Record) -> Array:
    """Abscissas of heel, metatarsal joint and toe tip of the current prints (n, 2, 3) [m]."""
    walker = record.walker
    offsets = np.stack([0 * walker.l_h, walker.l_h, walker.l_h + walker.l_m], axis=-1)
    return np.asarray(record.heel_print[..., None] + offsets)


def _toes(record: Record) -> Worst:
    """How far the toe tip is from where (7) wants it, by the bend epsilon - gamma - phi_m."""
    bend = record.segments[TOES].angle - record.segments[FOOT].angle - record.walker.sole_angle
    straight = np.isin(record.phase, (SWING, HEEL))
    astray = record.walker.l_m * np.where(straight, np.abs(bend), -bend)
    return worst(astray, record.time, LEGS)


def _angles(record: Record) -> Worst:
    thigh, shank, foot, toes = (record.segments[s].angle for s in (THIGH, SHANK, FOOT, TOES))
    sole = record.walker.sole_angle
    angles = (
        thigh - record.trunk.angle[:, None],
        thigh - shank,
        foot - shank + sole - np.pi / 2,
        toes - foot - sole,
    )
    error = record.raw["joint_angle"] - np.stack(angles, axis=-1)
    return worst(error, record.time, LEGS, JOINTS, one_sided=False)


def symmetry_lines(record: Record) -> list[AuditLine]:
    """Periodicity (2) and the legs half a stride apart, in motion and in loads."""
    mirrors = (residuals.LEG_SYMMETRY, residuals.LOAD_SYMMETRY)
    periodic = residuals.PERIODICITY.judged(_periodicity(record))
    if record.each_leg and asks_for_each_leg(record):
        return [periodic, *(m.nothing_to_judge("each leg has its own curves") for m in mirrors)]
    if record.each_leg:
        note = "each leg has its own curves, for which the stored problem does not ask"
        return [periodic, *(m.cannot_be_judged(note) for m in mirrors)]
    return [
        periodic,
        residuals.LEG_SYMMETRY.judged(_mirror(record)),
        residuals.LOAD_SYMMETRY.judged(_loads(record)),
    ]


def asks_for_each_leg(record: Record) -> bool:
    """Whether the stored problem lets the legs differ."""
    asked = record.table("stride").get("legs")
    if asked != "auto":
        return asked == "each"
    pairs = (v for v in record.table("body").values() if isinstance(v, list))
    tables = ("limits", "rhythm", "corridors", "devices")
    own = any(name in record.table(t) for t in tables for name in LEG_TABLES)
    return own or any(len(set(pair)) > 1 for pair in pairs)


def _periodicity(record: Record) -> Worst:
    """Angles [rad], hip [m] and rates (of the largest) at T against 0."""
    found, end = [], record.time[-1:]
    for (curve, rate, _), axes in _CURVES:
        change = record.raw[curve][-1] - record.raw[curve][0]
        if curve == "hip_position":
            change = change - np.array([2 * record.step_length, 0.0])
        rates = record.raw[rate]
        change_of_rate = (rates[-1] - rates[0]) / _largest_rate(rates)
        found.append(worst(change[None], end, *axes, one_sided=False))
        found.append(worst(change_of_rate[None], end, *axes, one_sided=False))
    return largest(found)


def _mirror(record: Record) -> Worst:
    """Angles [rad], hip [m] and rates (of the largest) half a stride later, legs exchanged."""
    found = []
    for (curve, rate, _), axes in _CURVES:
        legs = axes[:1] == (LEGS,)
        error = _half_stride_error(record, record.raw[curve], legs)
        if curve == "hip_position":
            error = error - _advance(record)[:, None] * np.array([1.0, 0.0])
        scale = _largest_rate(record.raw[rate])
        scale = scale.max(axis=0) if legs else scale
        rates = _half_stride_error(record, record.raw[rate], legs) / scale
        found.append(worst(error, record.time, *axes, one_sided=False))
        found.append(worst(rates, record.time, *axes, one_sided=False))
    return largest(found)


def _loads(record: Record) -> Worst:
    """Moments per M g 1 m, reactions per M g, moment x_R R_y about the heel per M g 1 m."""
    weight = record.walker.weight
    reaction = record.raw["ground_reaction_force"]
    pressing = (record.loads.pressure - record.heel_print) * reaction[..., 1]
    loads: list[tuple[Array, tuple[Sequence[str], ...]]] = [
        (record.raw["joint_moment"], (LEGS, JOINTS)),
        (reaction, (LEGS, ("R_x", "R_y"))),
        (pressing, (LEGS,)),
    ]
    return largest(
        [
            worst(
                _half_stride_error(record, load / weight, True),
                record.time,
                *names,
                one_sided=False,
            )
            for load, names in loads
        ]
    )


def _half_stride_error(record: Record, values: Array, legs: bool) -> Array:
    """Curves half a stride away, legs exchanged, minus the curves themselves."""
    half = record.stride_time / 2
    at = np.where(_first_half(record), record.time + half, record.time - half)
    moved = record.pieces.values(values, at, record.pieces.side)
    if legs:
        moved = moved[:, ::-1]
    return np.asarray(moved - values)


def _advance(record: Record) -> Array:
    """How much farther the hip must be half a stride away (n,): + L in the first half."""
    return np.where(_first_half(record), record.step_length, -record.step_length)


def _first_half(record: Record) -> NDArray[np.bool_]:
    """Samples of [0, T/2]; T/2 itself counts as far as it is the limit from the left."""
    half, slack = record.stride_time / 2, 1e-9 * record.stride_time
    at_half = np.abs(record.time - half) <= slack
    return np.where(at_half, record.pieces.side < 0, record.time < half)
