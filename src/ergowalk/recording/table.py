"""Tables with a column for each coordinate of each marker and for each force (CSV, TSV, TXT).

Names of columns: ``heel_x_m``, ``RHEE.PosX``, ``LMx``, ``hip x (mm)`` for markers; ``grf_x_N``,
``FP2.ForX``, ``Fx`` for forces; ``cop_x_m``, ``COPx`` for their point; ``FP2.MomZ``, ``My`` for
moments, about that point or, where the table has none, about the origin. Other columns are passed
over.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError
from ergowalk.recording.recording import UNITS, Plate, Recording, checked, even_time
from ergowalk.recording.text import numbers, read_lines

Array = NDArray[np.float64]

_TIME = re.compile(r"^(?:time|time ?stamp|t)[ _]*[(\[]?(s|sec|ms)?[)\]]?$", re.I)
_PLATE = r"^(?:(?P<name>(?!ground)[A-Za-z]{1,5}\d{0,2})[._ ])?"
_LOAD = re.compile(
    _PLATE + r"(?P<kind>grf|force|for|f|cop|moment|mom|free_moment|m)[._ ]?(?P<axis>[xyz])"
    r"(?:[ _]*[(\[]?(?P<unit>n|nm|n\*?mm|mm|cm|m)[)\]]?)?$",
    re.I,
)
_MARKER = re.compile(
    r"^(?P<name>[^\s].*?)(?:[._ ]?pos(?:ition)?)?[._ ]*(?P<axis>[xyz])"
    r"(?:[ _]*[(\[]?(?P<unit>mm|cm|m)[)\]]?)?$",
    re.I,
)
_KINDS = {"g": "f", "f": "f", "c": "c", "m": "m"}


class _Column(NamedTuple):
    place: int
    name: str
    axis: int
    unit: str | None


def read_table(path: Path) -> Recording:
    """Markers and forces of a table; ``planar`` where it has no third coordinate.

    Raises
    ------
    RecordingError
        If the file cannot be read, has no header with a time, or its units contradict each other.
    """
    lines, file = read_lines(path), str(path)
    names, body, first = _split(lines, file)
    table = numbers(body, len(names), first, file)
    time = _time(names, table, file)
    loads, markers = _columns(names)
    unit = _one_unit([*markers, *(c for c in loads if c.name.endswith("|c"))], file)
    points = {
        name: _vectors(table, [c for c in markers if c.name == name])
        for name in dict.fromkeys(c.name for c in markers)
        if {0, 1} <= {c.axis for c in markers if c.name == name}
    }
    planar = not any(column.axis == 2 for column in markers if column.name in points)
    plates = _plates(table, time, loads, unit)
    if not points and not plates:
        raise RecordingError(
            "has no columns of markers or forces",
            "name them like heel_x_m, heel_y_m, grf_x_N, cop_x_m",
            file=file,
        )
    return checked(Recording(file, time, points, unit, plates, planar))


def _split(lines: list[str], file: str) -> tuple[list[str], list[list[str]], int]:
    """Names of the columns, the cells below them, and the number of the first line of those."""
    rows = [(i, text) for i, text in enumerate(lines, start=1) if text.strip()]
    for k, (_, text) in enumerate(rows[:100]):
        plain = text.lstrip("%# \t")
        mark = max("\t;,", key=plain.count)
        names = [name.strip().strip('"') for name in plain.split(mark)]
        if len(names) > 2 and any(_TIME.match(name) for name in names):
            below = rows[k + 1 :]
            return names, [line.split(mark) for _, line in below], below[0][0] if below else 0
    raise RecordingError(
        "has no header line with a time column",
        "begin the table with names such as time_s, heel_x_m, heel_y_m",
        file=file,
    )


def _time(names: list[str], table: Array, file: str) -> Array:
    place = next(i for i, name in enumerate(names) if _TIME.match(name))
    match = _TIME.match(names[place])
    scale = 1e-3 if match and (match[1] or "").lower() == "ms" else 1.0
    return even_time(scale * table[:, place], file, names[place])


def _columns(names: list[str]) -> tuple[list[_Column], list[_Column]]:
    loads, markers = [], []
    for place, name in enumerate(names):
        if load := _LOAD.match(name):
            kind = "free" if load["kind"].lower() == "free_moment" else load["kind"][0].lower()
            axis, unit = "xyz".index(load["axis"].lower()), (load["unit"] or "").lower() or None
            label = f"{load['name'] or 'plate'}|{_KINDS.get(kind, 'm')}"
            loads.append(_Column(place, label, axis, unit))
        elif marker := _MARKER.match(name):
            axis, unit = "xyz".index(marker["axis"].lower()), (marker["unit"] or "").lower() or None
            markers.append(_Column(place, marker["name"].rstrip("._ "), axis, unit))
    return loads, markers


def _one_unit(columns: list[_Column], file: str) -> str | None:
    units = {column.unit for column in columns if column.unit in UNITS}
    if len(units) > 1:
        raise RecordingError(
            f"lengths stand in {' and '.join(sorted(map(str, units)))}",
            "give all of them in one unit",
            file=file,
        )
    return units.pop() if units else None


def _vectors(table: Array, columns: list[_Column]) -> Array:
    found = np.zeros((len(table), 3))
    for column in columns:
        found[:, column.axis] = table[:, column.place]
    found[np.isnan(found).any(axis=1)] = np.nan
    return found


def _plates(table: Array, time: Array, loads: list[_Column], unit: str | None) -> tuple[Plate, ...]:
    plates = []
    for name in dict.fromkeys(column.name.split("|")[0] for column in loads):
        parts = {k: [c for c in loads if c.name == f"{name}|{k}"] for k in "fcm"}
        if not {0, 1} <= {column.axis for column in parts["f"]}:
            continue
        if not parts["c"] and not parts["m"]:
            continue
        force, moment = _vectors(table, parts["f"]), _vectors(table, parts["m"])
        scale = 1e-3 if any("mm" in (c.unit or "") for c in parts["m"]) else 1.0
        point = _vectors(table, parts["c"]) if parts["c"] else None
        # where the foot is off the plate a table may hold nothing
        force, moment = np.nan_to_num(force), scale * np.nan_to_num(moment)
        point = None if point is None else np.nan_to_num(point)
        plates.append(Plate(name, time, force, moment, point, unit))
    return tuple(plates)
