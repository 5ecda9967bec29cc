"""Storage files of OpenSim (MOT, STO): tables, and the ground reactions in them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError
from ergowalk.recording.recording import Plate, even_time
from ergowalk.recording.text import numbers, read_lines

Array = NDArray[np.float64]

_FORCE = re.compile(r"^(.*?)ground_force_(.*?)([vp])([xyz])$")
_TORQUE = re.compile(r"^(.*?)ground_(?:torque|moment)_(.*?)m?([xyz])$")


def read_storage(path: Path) -> dict[str, Array]:
    """The columns of a storage file by name, ``time`` among them.

    Raises
    ------
    RecordingError
        If the file cannot be read or is no storage file.
    """
    lines, file = read_lines(path), str(path)
    end = next((i for i, t in enumerate(lines[:200]) if t.strip().lower() == "endheader"), None)
    if end is None or end + 1 >= len(lines):
        raise RecordingError(
            "must have a header that ends with the line endheader", "export it again", file=file
        )
    names = lines[end + 1].split()
    if not names or names[0].lower() != "time" or len(set(names)) != len(names):
        raise RecordingError(
            "must name its columns once each, beginning with time",
            "export it again",
            field=f"line {end + 2}",
            file=file,
        )
    rows = [line.split() for line in lines[end + 2 :] if line.strip()]
    stated = re.search(r"^n?(?:Rows|datarows)\s*=?\s*(\d{1,12})", "\n".join(lines[:end]), re.M)
    if stated and int(stated[1]) != len(rows):
        raise RecordingError(
            f"the file has {len(rows)}; it is truncated or its header is wrong",
            "export it again",
            field="nRows",
            value=int(stated[1]),
            file=file,
        )
    table = numbers(rows, len(names), end + 3, file)
    if np.isnan(table).any():
        row = int(np.argwhere(np.isnan(table))[0][0])
        raise RecordingError(
            f"must have {len(names)} numbers",
            "export it again",
            field=f"line {end + 3 + row}",
            file=file,
        )
    columns = dict(zip(names, table.T, strict=True))
    columns["time"] = even_time(columns.pop(names[0]), file, "time")
    return columns


def read_reactions(path: Path) -> tuple[Plate, ...]:
    """The force plates of a storage file of ground reactions: force, point and torque, SI units.

    Raises
    ------
    RecordingError
        As :func:`read_storage`, and if it has no ground reactions.
    """
    columns = read_storage(path)
    found: dict[tuple[str, str], dict[str, Array]] = {}
    for name, values in columns.items():
        if match := _FORCE.match(name):
            before, between, kind, axis = match.groups()
        elif match := _TORQUE.match(name):
            (before, between, axis), kind = match.groups(), "t"
        else:
            continue
        found.setdefault((before, between), {})[kind + axis] = values
    plates = [
        Plate(
            name=f"{before}ground_force_{between}".strip("_"),
            time=columns["time"],
            force=_vector(parts, "v"),
            moment=_vector(parts, "t", len(columns["time"])),
            point=_vector(parts, "p"),
            unit="m",
        )
        for (before, between), parts in found.items()
        if {"vx", "vy", "px"} <= parts.keys()
    ]
    if not plates:
        raise RecordingError(
            "has no ground reactions",
            "name the columns ground_force_vx, ground_force_px, ground_torque_x ...",
            file=str(path),
        )
    return tuple(plates)


def _vector(parts: dict[str, Array], kind: str, length: int = 0) -> Array:
    length = length or len(parts["vx"])
    return np.stack([parts.get(kind + axis, np.zeros(length)) for axis in "xyz"], axis=1)
