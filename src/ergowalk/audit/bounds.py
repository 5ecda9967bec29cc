"""Lines about bounds: the ground reaction, the joint moments, the centre of pressure."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ergowalk.audit import residuals
from ergowalk.audit.devices import own_moments
from ergowalk.audit.record import FLAT, FOREFOOT, HEEL, JOINTS, SWING, TOE, Record, as_number
from ergowalk.audit.report import LEGS, AuditLine, Residual, Worst, largest, worst
from ergowalk.audit.walker import Array

OFF = "off"
LOADED = 0.1
"""Share of body weight above which the centre of pressure counts."""

NOT_STATED = "the stored problem does not state this limit"
NO_LIMIT = "no limit set"


def bound_lines(record: Record) -> list[AuditLine]:
    """R_y >= 0 and the limits of the stored problem, in body weights (times 1 m)."""
    weight = record.walker.weight
    force_x, force_y = np.moveaxis(record.raw["ground_reaction_force"], -1, 0)
    upward = worst(-force_y / weight, record.time, LEGS)
    lines = [residuals.REACTION_UPWARD.judged(upward)]

    caps = _of_legs(record, "vertical_reaction_body_weights")
    lines.append(_limited(residuals.REACTION_CAP, record, caps, force_y / weight - caps))
    cones = _of_legs(record, "friction_coefficient")
    # no cone is not a cone of infinite width: inf times zero is not a number
    excess = (np.abs(force_x) - np.where(np.isfinite(cones), cones, 0.0) * force_y) / weight
    lines.append(_limited(residuals.FRICTION, record, cones, excess))
    return lines + _moment_lines(record)


def _of_legs(record: Record, name: str) -> Array:
    """A limit of the stored problem for each leg (2,)."""
    return np.array([_limit(record.leg_table("limits", leg).get(name)) for leg in (0, 1)])


def _limited(line: Residual, record: Record, limits: Array, excess: Array) -> AuditLine:
    if np.any(np.isnan(limits)):
        return line.cannot_be_judged(NOT_STATED)
    if np.all(np.isinf(limits)):
        return line.nothing_to_judge(NO_LIMIT)
    over = np.where(np.isinf(limits), -np.inf, excess)
    words = " and ".join(dict.fromkeys(f"{limit:g}" for limit in limits))
    return line.judged(worst(over, record.time, LEGS), f"limit {words}")


def _limit(stated: object) -> float:
    """A limit of the stored problem: inf where it is off, NaN where the problem does not say."""
    return np.inf if stated == OFF else as_number(stated)


def _moment_lines(record: Record) -> list[AuditLine]:
    return [
        _moment_line(residuals.MOMENT_LIMITS, record, "moment_nm_per_kg", _moment_excess),
        _moment_line(residuals.MOMENT_RATE_LIMITS, record, "moment_rate_nm_per_kg_s", _rate_excess),
    ]


def _moment_line(
    line: Residual, record: Record, limit: str, check: Callable[[Record, int, Array], Worst]
) -> AuditLine:
    """Line of a bound per joint and kilogram, ``check`` giving the excess [N m] at one joint."""
    stated = [record.leg_table("limits", leg).get(limit) for leg in (0, 1)]
    tables = [table if isinstance(table, dict) else {} for table in stated]
    bounds = np.array([[_limit(table.get(name)) for table in tables] for name in JOINTS])
    if np.any(np.isnan(bounds)):
        return line.cannot_be_judged(NOT_STATED)
    bounds = bounds * record.walker.mass
    found = [check(record, j, b) for j, b in enumerate(bounds) if np.any(np.isfinite(b))]
    if not found:
        return line.nothing_to_judge(NO_LIMIT)
    over = largest(found)
    return line.judged(Worst(over.value / record.walker.weight, over.where))


def physical_moment(record: Record, joint: int) -> Array:
    """The walker's own moment (n, 2) at a joint, where it is one.

    Up to heel-off the toes move with the foot: the stored metatarsal moment only balances the
    last line of (1) there, and what a muscle must give is zero.
    """
    moment = own_moments(record)[..., joint]
    if JOINTS[joint] != "metatarsal":
        return moment
    return np.where(np.isin(record.phase, (HEEL, FLAT)), 0.0, moment)


def _moment_excess(record: Record, joint: int, bounds: Array) -> Worst:
    excess = np.abs(physical_moment(record, joint)) - bounds
    return worst(excess[..., None], record.time, LEGS, (JOINTS[joint],))


def _rate_excess(record: Record, joint: int, bounds: Array) -> Worst:
    """Largest |m(t2) - m(t1)| - bound (t2 - t1) over all pairs of instants of the periodic stride.

    Two strides in a row hold every pair; for each t2 the worst t1 is a running extreme of
    m -+ bound t, so no derivative is taken and a jump counts in full.
    """
    moment = np.tile(physical_moment(record, joint), (2, 1))
    time = np.concatenate([record.time, record.time + record.stride_time])
    limited = np.isfinite(bounds)
    ramp = np.where(limited, bounds, 0.0) * time[:, None]
    rise = (moment - ramp) - np.minimum.accumulate(moment - ramp)
    fall = np.maximum.accumulate(moment + ramp) - (moment + ramp)
    excess = np.where(limited, np.maximum(rise, fall), -np.inf)[..., None]
    return worst(excess, np.tile(record.time, 2), LEGS, (JOINTS[joint],))


def pressure_line(record: Record) -> AuditLine:
    """Centre of pressure inside the interval of its phase while the foot is loaded."""
    body = record.body
    heel, metatarsal, toe = (p.position.real for p in (body.heel, body.metatarsal, body.toe_tip))
    phase, pressure = record.phase, record.loads.pressure
    contacts = [phase == p for p in (HEEL, FLAT, FOREFOOT, TOE)]
    low = np.select(contacts, [heel, heel, metatarsal, toe])
    high = np.select(contacts, [heel, metatarsal, toe, toe])
    loaded = (record.loads.reaction.imag > LOADED * record.walker.weight) & (phase > SWING)
    outside = np.where(loaded, np.maximum(low - pressure, pressure - high), 0.0)
    return residuals.CENTER_OF_PRESSURE.judged(worst(outside, record.time, LEGS))
