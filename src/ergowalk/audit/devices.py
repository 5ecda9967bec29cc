"""Lines about devices: their laws against the stored angles, and the energy that they keep.

The laws are written again here, from the words of the problem file: a spring's moment is the
slope of its energy, a lock stands still, and of a spring and a damper in series each sees the
whole moment.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ergowalk.audit import residuals
from ergowalk.audit.record import FOREFOOT, JOINTS, PHASES, SWING, TOE, Record, as_number
from ergowalk.audit.report import AuditLine, Worst, largest, worst
from ergowalk.audit.walker import Array

DEVICE = "device_moment"
TURN = (1.0, -1.0, 1.0, 1.0)
"""Rate of each joint angle over the relative rate that its moment works on."""

ROUND = np.pi / 360
"""Half a degree: a spring of two slopes turns from one to the other about there."""

KINDS = ("locked", "free", "spring", "damper", "parallel", "series")
NO_DEVICE = "no device"


@dataclass(frozen=True)
class Fitted:
    """A device of one leg as the stored problem states it; angles [rad] of its own joint."""

    leg: int
    joint: int
    kind: str
    own: bool
    above: float
    below: float
    damping: float
    rest: float
    acts: np.ndarray

    def spring(self, x: Array) -> Array:
        """Moment against a deflection, the mean of the slopes and the rounded change between."""
        bent = (np.hypot(x, ROUND) - ROUND) * (self.above - self.below) / 2
        return np.asarray((self.above + self.below) / 2 * x + bent)


def device_lines(record: Record) -> list[AuditLine]:
    """Laws of the devices, their energy, and no own moment where a device stands in its place."""
    lines = (residuals.DEVICE_LAW, residuals.DEVICE_ENERGY, residuals.DEVICE_IN_PLACE)
    if not record.table("devices"):
        if DEVICE in record.raw and np.any(record.raw[DEVICE]):
            note = "the stored problem has no devices"
            return [line.cannot_be_judged(note) for line in lines]
        return [line.nothing_to_judge(NO_DEVICE) for line in lines]
    fitted = list(_fitted(record))
    missing = [f for f in fitted if f is None]
    if missing or DEVICE not in record.raw:
        note = "the file does not state its devices and their moments as it should"
        return [line.cannot_be_judged(note) for line in lines]
    devices = [f for f in fitted if f is not None]
    laws = [_law(record, device) for device in devices]
    strays = [_elsewhere(record, devices)]
    return [
        residuals.DEVICE_LAW.judged(largest([*laws, *strays])),
        _energy_line(record, devices),
        residuals.DEVICE_IN_PLACE.judged(largest([_own(record, d) for d in devices])),
    ]


def own_moments(record: Record) -> Array:
    """What the walker itself gives of the joint moments (n, 2, 4) [N m]."""
    total = record.raw["joint_moment"]
    return total - record.raw[DEVICE] if DEVICE in record.raw else total


def _fitted(record: Record) -> Iterator[Fitted | None]:
    tables = record.table("devices")
    for leg in (0, 1):
        own = tables.get(f"leg_{leg + 1}", {})
        for joint, name in enumerate(JOINTS):
            stated = own.get(name, tables.get(name)) if isinstance(own, dict) else None
            if stated is not None:
                yield _one(record, leg, joint, stated)


def _one(record: Record, leg: int, joint: int, stated: Any) -> Fitted | None:
    """A device of the stored problem; None where it is not stated in full."""
    table: Mapping[str, Any] = stated if isinstance(stated, dict) else {}
    above, damping = (as_number(table.get(k)) for k in ("stiffness_nm_per_rad",
                                                       "damping_nms_per_rad"))  # fmt: skip
    below = table.get("stiffness_below_nm_per_rad")
    slope = above if below == "same" else as_number(below)
    angle = table.get("rest_angle_deg")
    rest = np.nan if angle == "latched" else np.radians(as_number(angle))
    active, kind, own = table.get("active"), table.get("kind"), table.get("own_moment")
    known = isinstance(active, list) and set(active) <= set(PHASES) and kind in KINDS
    numbers = [above, slope, damping] + ([] if angle == "latched" else [float(rest)])
    if not known or not isinstance(own, bool) or not np.all(np.isfinite(numbers)):
        return None
    acts = np.isin(record.phase[:, leg], [PHASES.index(p) for p in active or []])
    if joint == JOINTS.index("metatarsal"):  # at rest while the toes are in line with the sole
        acts = acts & np.isin(record.phase[:, leg], (FOREFOOT, TOE))
    return Fitted(leg, joint, str(kind), own, above, slope, damping, float(rest), acts)


def _law(record: Record, device: Fitted) -> Worst:
    """Error of the law of a device, in moment per M g 1 m, or in angle [rad] where that is it."""
    leg, joint, weight = device.leg, device.joint, record.walker.weight
    names = (f"leg {leg + 1}, {JOINTS[joint]}",)
    angle = record.raw["joint_angle"][:, leg, joint]
    rate = TURN[joint] * _relative_rates(record)[:, leg, joint]
    against = -TURN[joint] * record.raw[DEVICE][:, leg, joint]
    if device.kind == "locked":
        return worst(_moved(record, device, angle, rate)[:, None], record.time, names)
    if device.kind == "free":
        error = np.where(device.acts, np.abs(record.raw["joint_moment"][:, leg, joint]), 0.0)
        return worst((error / weight)[:, None], record.time, names)
    if device.kind == "series":
        slip = angle - against / device.above
        drift = record.pieces.cumulative(against / device.damping) - (slip - slip[0])
        return worst(np.abs(drift)[:, None], record.time, names)
    wanted = device.spring(angle - device.rest) + device.damping * rate
    error = np.where(device.acts, np.abs(against - wanted), 0.0) / weight
    return worst(error[:, None], record.time, names)


def _moved(record: Record, device: Fitted, angle: Array, rate: Array) -> Array:
    """How far a lock is from its angle [rad]; one that holds any angle, how far it moves."""
    if np.isfinite(device.rest):
        return np.where(device.acts, np.abs(angle - device.rest), 0.0)
    moving = record.pieces.cumulative(np.where(device.acts, np.abs(rate), 0.0))
    return np.full_like(angle, moving[-1])


def _elsewhere(record: Record, devices: list[Fitted]) -> Worst:
    """Moments of devices where none acts, per M g 1 m."""
    idle = np.ones_like(record.raw[DEVICE], dtype=bool)
    for device in devices:
        idle[:, device.leg, device.joint] &= ~device.acts | (device.kind == "free")
    error = np.where(idle, np.abs(record.raw[DEVICE]), 0.0) / record.walker.weight
    return worst(error, record.time, ("leg 1", "leg 2"), JOINTS)


def _own(record: Record, device: Fitted) -> Worst:
    """Own moment per M g 1 m where a device stands in its place."""
    leg, joint = device.leg, device.joint
    alone = np.zeros(len(record.time), dtype=bool)
    if device.kind in ("locked", "free"):
        alone = device.acts
    if not device.own and device.kind != "free":
        alone = np.ones_like(alone)
    if joint == JOINTS.index("metatarsal"):
        alone = alone & np.isin(record.phase[:, leg], (FOREFOOT, TOE, SWING))
    own = np.abs(own_moments(record)[:, leg, joint]) / record.walker.weight
    name = f"leg {leg + 1}, {JOINTS[joint]}"
    return worst(np.where(alone, own, 0.0)[:, None], record.time, (name,))


def _energy_line(record: Record, devices: list[Fitted]) -> AuditLine:
    """What the devices give over a stride: nothing, or less than nothing, of the work E 2L."""
    power = record.raw[DEVICE] * _relative_rates(record)
    span = record.energy_per_metre * 2 * record.step_length
    found, total = [], 0.0
    for device in devices:
        work = float(record.pieces.cumulative(power[:, device.leg, device.joint])[-1])
        keeps = device.kind in ("spring", "locked", "free") and bool(np.all(device.acts))
        found.append(Worst(abs(work) / span if keeps else max(work, 0.0) / span,
                           f"leg {device.leg + 1}, {JOINTS[device.joint]}"))  # fmt: skip
        total += work
    over = largest(found)
    note = f"devices give {total:.3g} J a stride"
    return residuals.DEVICE_ENERGY.judged(over if over.value else Worst(0.0, ""), note)


def _relative_rates(record: Record) -> Array:
    """Rates that the moments work on (n, 2, 4) [rad/s], distal minus proximal."""
    trunk = np.repeat(record.trunk.rate[:, None], 2, axis=1)
    chain = np.stack([trunk, *(s.rate for s in record.segments)], axis=-1)
    return np.diff(chain, axis=-1)
