"""Lines about the problem behind the gait: corridors, attributes, mesh, missing numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ergowalk.audit import residuals
from ergowalk.audit.reading import MAY_BE_MISSING
from ergowalk.audit.record import JOINTS, Record, as_number
from ergowalk.audit.report import LEGS, AuditLine, Residual, Worst, worst
from ergowalk.audit.walker import Array
from ergowalk.corridors import BUILT_IN, HumanGait, human_gait
from ergowalk.errors import CorridorError

CORRIDOR_JOINTS = JOINTS[:3]

BODY_FIELDS = {
    "m": "trunk_mass_kg", "r": "trunk_com_m", "J": "trunk_inertia_kgm2",
    "m_a": "thigh_mass_kg", "a": "thigh_length_m", "r_a": "thigh_com_m",
    "J_a": "thigh_inertia_kgm2", "m_b": "shank_mass_kg", "b": "shank_length_m",
    "r_b": "shank_com_m", "J_b": "shank_inertia_kgm2", "m_f": "foot_mass_kg",
    "HA": "heel_to_ankle_m", "AM": "ankle_to_metatarsal_m", "l_m": "toe_length_m",
    "l_h": "heel_to_metatarsal_m", "g": "gravity_m_s2",
}  # fmt: skip
"""Where the table [body] of a problem states each symbol."""


def finite_line(record: Record) -> AuditLine:
    """No NaN or infinity where a number must stand."""
    found = Worst(0.0, "")
    for name in record.raw:
        if name in MAY_BE_MISSING:
            continue
        bad = ~np.isfinite(record.raw[name])
        if np.any(bad) and bad.sum() > found.value:
            first = int(np.argwhere(bad)[0][0])
            found = Worst(float(bad.sum()), f"{name} from t = {record.time[first]:.4f} s")
    return residuals.FINITE.judged(found)


def corridor_lines(record: Record, folder: Path | None) -> list[AuditLine]:
    """Joint angles inside the stored corridors, and these as the stored problem asks for."""
    angle = np.degrees(record.raw["joint_angle"])
    low, high = (np.degrees(record.raw[f"corridor_{k}"]) for k in ("lower", "upper"))
    outside = np.maximum(
        np.where(np.isnan(low), 0.0, low - angle), np.where(np.isnan(high), 0.0, angle - high)
    )
    inside = residuals.CORRIDORS.judged(worst(outside, record.time, LEGS, JOINTS))
    return [inside, _asked_corridor_line(record, folder)]


def _asked_corridor_line(record: Record, folder: Path | None) -> AuditLine:
    line = residuals.CORRIDORS_AS_ASKED
    found = []
    for leg in (0, 1):
        difference = _asked_difference(line, record, leg, folder)
        if isinstance(difference, AuditLine):
            return difference
        found.append(difference)
    difference = np.stack(found, axis=1)
    at = worst(difference, record.time, LEGS, CORRIDOR_JOINTS, one_sided=False)
    return line.judged(at)


def _asked_difference(
    line: Residual, record: Record, leg: int, folder: Path | None
) -> Array | AuditLine:
    """Difference of the stored corridors of a leg [deg] (n, 3), or why there is none."""
    asked = record.leg_table("corridors", leg)
    source, width = asked.get("source"), as_number(asked.get("width_sd"))
    if not isinstance(source, str) or not np.isfinite(width):
        note = "the stored problem does not state corridors.source and corridors.width_sd"
        return line.cannot_be_judged(note)
    if source not in BUILT_IN and not (folder or Path()).joinpath(source).is_file():
        note = f"{source} is not beside the gait file: stored corridors taken on trust"
        return line.nothing_to_judge(note)
    try:
        human = human_gait(source, folder)
    except CorridorError as error:
        return line.cannot_be_judged(str(error))
    widths = [_width(asked.get(f"{joint}_width_sd", "same"), width) for joint in CORRIDOR_JOINTS]
    if np.any(np.isnan(widths)):
        return line.cannot_be_judged("the stored problem states a width that is no number")
    return _corridor_difference(record, human, widths, leg)


def _width(stated: object, common: float) -> float:
    """Half width of one corridor: infinite where it is off, NaN where it is not stated."""
    if stated == "same":
        return common
    return np.inf if stated == "off" else as_number(stated)


def _corridor_difference(record: Record, human: HumanGait, widths: list[float], leg: int) -> Array:
    """Largest difference of either bound [deg] (n, 3); NaN where a bound is missing.

    Where no corridor is asked for, a bound that is there differs by infinity.
    """
    fraction = (record.time - record.contacts[leg]) / record.stride_time
    difference = np.zeros((*fraction.shape, len(CORRIDOR_JOINTS)))
    for j, joint in enumerate(CORRIDOR_JOINTS):
        mean, sd = (curve(fraction) for curve in human.curves[f"{joint}_angle"])
        for name, sign in (("corridor_lower", -1), ("corridor_upper", 1)):
            stored = np.degrees(record.raw[name][:, leg, j])
            if np.isinf(widths[j]):
                difference[..., j] = np.where(np.isnan(stored), 0.0, np.inf)
                continue
            error = np.abs(stored - (mean + sign * widths[j] * sd))
            difference[..., j] = np.maximum(difference[..., j], error)
    return difference


def attribute_line(record: Record) -> AuditLine:
    """Attributes of the file against the stored problem."""
    pairs: list[tuple[str, Any, Any]] = [
        ("step_length_m", record.step_length, record.problem.get("step_length_m")),
        ("stride_time_s", record.stride_time, record.problem.get("stride_time_s")),
    ]
    body = record.table("body")
    pairs += [
        (field, getattr(record.walker, symbol), body[field])
        for symbol, field in BODY_FIELDS.items()
        if field in body
    ]
    found = Worst(0.0, "")
    for name, stored, asked in pairs:
        try:
            wanted = np.asarray(asked, dtype=float)
            difference = float(np.max(np.abs(np.asarray(stored) - wanted) / np.abs(wanted)))
        except (TypeError, ValueError):
            difference = np.nan
        if not np.isfinite(difference):
            note = f"the stored problem does not state {name} as a number"
            return residuals.ATTRIBUTES.cannot_be_judged(note)
        if difference > found.value:
            found = Worst(difference, name)
    return residuals.ATTRIBUTES.judged(found)


def mesh_line(record: Record) -> AuditLine:
    """E on the final mesh against the next finer one, from the stored mesh history."""
    history = [e for e in record.mesh_history if _usable(e)]
    final = next((i for i, e in enumerate(history) if e.get("final") is True), None)
    if final is None:
        note = "mesh_history names no final mesh"
        return residuals.MESH.cannot_be_judged(note)
    reported = history[final]
    finer = [
        e for e in history[final + 1 :]
        if e.get("finer") is True and e["elements"] > reported["elements"]
    ]  # fmt: skip
    if not finer:
        note = "no finer mesh was solved"
        return residuals.MESH.cannot_be_judged(note)
    energy, stated = reported["energy_per_metre"], record.energy_per_metre
    if abs(energy - stated) > 1e-3 * abs(stated):
        note = f"mesh_history reports {energy:.6g} J/m, the file {stated:.6g} J/m"
        return residuals.MESH.cannot_be_judged(note)
    check = finer[0]
    note = (
        f"{energy:.4g} J/m with {reported['elements']} elements, "
        f"{check['energy_per_metre']:.4g} J/m with {check['elements']}"
    )
    if "carried_from" in check:
        note += (
            f", as a check of a gait with {as_number(check['carried_from']):.4g} J/m lets expect"
        )
    change = abs(check["energy_per_metre"] - energy) / energy
    values = [as_number(e.get("objective_per_metre")) for e in (reported, check)]
    if "objective_per_metre" in reported:  # another objective must stand still too
        change = max(change, abs(values[1] - values[0]) / abs(values[0]))
        note += f"; objective {values[0]:.4g} and {values[1]:.4g} J/m"
    return residuals.MESH.judged(Worst(change, ""), note)


def _usable(entry: Any) -> bool:
    numbers = [as_number(entry.get(name)) for name in ("elements", "energy_per_metre")]
    return all(0 < x < np.inf for x in numbers)
