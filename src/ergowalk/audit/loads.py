"""Lines about forces: balance of every segment, energy and work."""

from __future__ import annotations

import numpy as np

from ergowalk.audit import balance, residuals
from ergowalk.audit.devices import own_moments
from ergowalk.audit.record import FOREFOOT, JOINTS, SEGMENTS, SWING, TOE, Record
from ergowalk.audit.report import LEGS, AuditLine, Worst, largest, worst


def balance_lines(record: Record) -> list[AuditLine]:
    """Equations of motion (1), and nothing on a foot in swing."""
    weight = record.walker.weight
    left = balance.residuals(
        record.walker, record.body, record.trunk, record.segments, record.loads
    )
    found = [
        worst(left.trunk_force / weight, record.time, ("force x", "force y"), one_sided=False),
        worst(left.trunk_moment[:, None] / weight, record.time, ("trunk",), one_sided=False),
        worst(left.segment_moment / weight, record.time, LEGS, SEGMENTS, one_sided=False),
    ]
    return [
        residuals.EQUATIONS_OF_MOTION.judged(largest(found)),
        residuals.SWING_UNLOADED.judged(_swing_load(record)),
    ]


def _swing_load(record: Record) -> Worst:
    """Reaction per M g, ankle and metatarsal moment per M g 1 m, 1 for a centre of pressure."""
    swing = record.phase == SWING
    weight = record.walker.weight
    feet = np.abs(record.raw["joint_moment"][..., 2:]) / weight
    loads = np.stack(
        [
            np.abs(record.loads.reaction) / weight,
            feet[..., 0],
            feet[..., 1],
            np.isfinite(record.raw["center_of_pressure"]).astype(float),
        ],
        axis=-1,
    )
    names = ("reaction", "ankle moment", "metatarsal moment", "centre of pressure")
    return worst(np.where(swing[..., None], loads, 0.0), record.time, LEGS, names)


def energy_lines(record: Record) -> list[AuditLine]:
    """E against the stored powers, powers against moments, work against energy."""
    power = record.raw["joint_power"]
    rates = balance.relative_rates(record.trunk, record.segments)
    scale = max(float(np.max(np.abs(power))), 1.0)
    mismatch = (power - own_moments(record) * rates) / scale
    spent = sum(
        record.pieces.absolute_integral(power[:, leg, joint])
        for leg in (0, 1)
        for joint in range(4)
    )
    energy = spent / (2 * record.step_length)
    stated = record.energy_per_metre
    error = Worst(abs(stated - energy) / energy if energy > 0 else np.inf, "")
    note = f"stated {stated:.6g} J/m, integral {energy:.6g} J/m"
    return [
        residuals.ENERGY.judged(error, note),
        residuals.JOINT_POWER.judged(worst(mismatch, record.time, LEGS, JOINTS, one_sided=False)),
        _work_line(record, energy),
    ]


def _work_line(record: Record, energy: float) -> AuditLine:
    """Work of moments and ground against kinetic plus potential energy, any two instants."""
    rates = balance.relative_rates(record.trunk, record.segments)
    by_joints = (record.raw["joint_moment"] * rates).sum(axis=(1, 2))
    on_toes = np.isin(record.phase, (FOREFOOT, TOE))
    by_ground = balance.ground_power(record.body, record.segments, record.loads, on_toes)
    done = record.pieces.cumulative(by_joints + by_ground.sum(axis=1))
    stored = balance.mechanical_energy(record.walker, record.body, record.trunk, record.segments)
    surplus = done - (stored - stored[0])
    span = energy * 2 * record.step_length
    if not np.all(np.isfinite(surplus)) or not span > 0:
        found = worst(np.where(np.isfinite(surplus), 0.0, np.nan), record.time)
        return residuals.WORK_ENERGY.judged(Worst(np.nan, found.where))
    low, high = int(np.argmin(surplus)), int(np.argmax(surplus))
    first, last = sorted(record.time[[low, high]])
    where = f"t = {first:.4f} s to {last:.4f} s"
    ground = float(np.max(np.abs(record.pieces.cumulative(by_ground.sum(axis=1)))))
    note = f"ground works {ground:.2g} J at most"
    found = Worst(float(surplus[high] - surplus[low]) / span, where)
    return residuals.WORK_ENERGY.judged(found, note)
