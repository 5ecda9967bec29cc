"""Marker files of OpenSim and Motion Analysis (TRC)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ergowalk.errors import RecordingError
from ergowalk.recording.recording import UNITS, Recording, checked, even_time
from ergowalk.recording.text import numbers, read_lines

_REMEDY = "export the trial again"


def read_trc(path: Path) -> Recording:
    """The markers of a TRC file; an empty cell, or a marker at (0, 0, 0), was not seen.

    Raises
    ------
    RecordingError
        If the file cannot be read, its header is none, or its rows are not those of the header.
    """
    lines, file = read_lines(path), str(path)
    if len(lines) < 6 or not lines[0].lower().startswith("pathfiletype"):
        raise RecordingError(
            "must begin with PathFileType and five lines of header", _REMEDY, file=file
        )
    keys, values = lines[1].split(), lines[2].split()
    header = dict(zip(keys, values, strict=False))
    names = [name.strip() for name in lines[3].rstrip().split("\t")[2:] if name.strip()]
    _check_count("NumMarkers", header, len(names), file)
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise RecordingError("stands twice in the header", "rename one", field=twice, file=file)
    rows = [line.split("\t") for line in lines[5:]]
    # a blank line may follow the header; what comes after the last row is nothing
    start = next((i for i, row in enumerate(rows) if any(c.strip() for c in row)), len(rows))
    rows = rows[start:]
    while rows and not any(cell.strip() for cell in rows[-1]):
        rows.pop()
    _check_count("NumFrames", header, len(rows), file)
    table = numbers(rows, 2 + 3 * len(names), 6 + start, file)
    points = table[:, 2:].reshape(len(table), len(names), 3)
    points[np.all(points == 0, axis=2)] = np.nan
    unit = header.get("Units", "").lower()
    if unit not in UNITS:
        raise RecordingError(
            f"must be one of {', '.join(UNITS)}",
            "mend the header",
            field="Units",
            value=unit,
            file=file,
        )
    return checked(
        Recording(
            file=file,
            time=even_time(table[:, 1], file, "Time"),
            markers={name: points[:, i] for i, name in enumerate(names)},
            unit=unit,
        )
    )


def _check_count(key: str, header: dict[str, str], found: int, file: str) -> None:
    text = header.get(key, "")
    if not text.isdecimal() or len(text) > 12:
        raise RecordingError(
            "must be a number in the third line", _REMEDY, field=key, value=text, file=file
        )
    if int(text) != found or not found:
        raise RecordingError(
            f"the file has {found}; it is truncated or its header is wrong",
            _REMEDY,
            field=key,
            value=int(text),
            file=file,
        )
