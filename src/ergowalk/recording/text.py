"""Text files of numbers: read with a limit, decoded, cut into cells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError
from ergowalk.recording.recording import MOST_NUMBERS

Array = NDArray[np.float64]

LARGEST_FILE = 512 * 1024 * 1024
"""Largest file that is opened [bytes]."""


def read_bytes(path: Path) -> bytes:
    """The content of a file that is there, is not empty, and is not absurdly large.

    Raises
    ------
    RecordingError
        Otherwise.
    """
    try:
        if not path.is_file():
            raise RecordingError(
                "is no file" if path.exists() else "cannot be read (No such file or directory)",
                "give a recorded walk",
                file=str(path),
            )
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise RecordingError(
                f"is larger than {LARGEST_FILE >> 20} MB",
                "cut the trial",
                field="size",
                value=size,
                file=str(path),
            )
        content = path.read_bytes()
    except (OSError, ValueError) as error:
        if isinstance(error, RecordingError):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        raise RecordingError(
            f"cannot be read ({reason})", "give a recorded walk", file=str(path)
        ) from None
    if not content.strip(b"\0 \t\r\n"):
        raise RecordingError("is empty", "give a recorded walk", file=str(path))
    return content


def read_lines(path: Path) -> list[str]:
    """The lines of a text file.

    Raises
    ------
    RecordingError
        As :func:`read_bytes`, and for a file that is no text.
    """
    content = read_bytes(path)
    if b"\0" in content:
        raise RecordingError("is no text file", "give the kind that its name says", file=str(path))
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")  # what old Windows programs write in comments
    return text.splitlines()


def number(cell: str) -> float:
    """A cell as a number: NaN for an empty one.

    Raises
    ------
    ValueError
        If it is neither.
    """
    cell = cell.strip().strip('"')
    return float(cell) if cell else np.nan


def numbers(rows: list[list[str]], width: int, first_line: int, file: str) -> Array:
    """Rows of cells as an array (n, width); short rows are filled with NaN.

    Raises
    ------
    RecordingError
        For a cell that is no number, a row that is too long, or more than can be held.
    """
    if len(rows) * width > MOST_NUMBERS:
        raise RecordingError(f"holds more than {MOST_NUMBERS} numbers", "cut the trial", file=file)
    found = np.full((len(rows), width), np.nan)
    for i, row in enumerate(rows):
        while len(row) > width and not row[-1].strip():
            row = row[:-1]
        if len(row) > width:
            raise RecordingError(
                f"must have {width} columns as its header says (has {len(row)})",
                "mend the header or the row",
                field=f"line {first_line + i}",
                file=file,
            )
        for j, cell in enumerate(row):
            try:
                found[i, j] = number(cell)
            except ValueError:
                raise RecordingError(
                    "is no number",
                    "mend the cell, or leave it empty where a marker was not seen",
                    field=f"line {first_line + i}, column {j + 1}",
                    value=cell,
                    file=file,
                ) from None
    return found
