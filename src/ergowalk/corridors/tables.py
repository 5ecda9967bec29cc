"""Tables of human walking: those of the package, and CSV files of a user."""

from __future__ import annotations

import csv
import io
import math
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ergowalk.corridors.human import ANGLES, SIGNALS, HumanGait, Signal
from ergowalk.corridors.periodic import PeriodicCurve
from ergowalk.errors import CorridorError


def human_gait(source: str, folder: Path | None = None) -> HumanGait:
    """Human gait by name, or from a CSV file.

    Parameters
    ----------
    source : str
        "winter-slow", "winter-natural", "winter-fast" (Winter 1991), or the path of a CSV file
        with a column ``percent_stride`` (0 to 100 in equal steps) and columns
        ``hip_flexion_angle_mean_deg``, ``hip_flexion_angle_sd_deg``, the same for
        ``knee_flexion_angle`` and ``ankle_dorsiflexion_angle``, and optionally the other
        :data:`SIGNALS`. Lines starting with # are comments.
    folder : Path, optional
        Where a relative path starts.

    Raises
    ------
    CorridorError
        If the file cannot be read, a column is missing, or a value is not usable.
    """
    if source in BUILT_IN:
        text = resources.files("ergowalk").joinpath(BUILT_IN[source]).read_text("utf-8")
        return _parse(text, source)
    path = Path(source) if folder is None else folder / source
    try:
        text = path.read_text("utf-8-sig")  # spreadsheets put a byte order mark first
    except (OSError, ValueError) as error:  # ValueError: undecodable text, or NUL in the name
        reason = error.strerror if isinstance(error, OSError) else "not a text file"
        raise CorridorError(
            f"cannot be read ({reason})",
            f"give the path of a CSV table or one of {', '.join(BUILT_IN)}",
            field="corridors.source",
            value=source,
        ) from None
    return _parse(text, str(source))


BUILT_IN = {f"winter-{k}": f"data/winter1991/{k}.csv" for k in ("slow", "natural", "fast")}
"""Tables that come with the package."""


def _parse(text: str, name: str) -> HumanGait:
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    reader = csv.DictReader(io.StringIO("\n".join(lines)), skipinitialspace=True)
    try:
        header, rows = list(reader.fieldnames or []), list(reader)
    except csv.Error as error:
        raise CorridorError(
            f"is no table ({error})", "give a CSV table with a header line", file=name
        ) from None
    required = ["percent_stride", *(c for j in ANGLES for c in SIGNALS[f"{j}_angle"].columns)]
    for column in required:
        if column not in header:
            raise CorridorError(
                "column is missing",
                f"the table needs {', '.join(required)}",
                field=column,
                file=name,
            )
    _check_steps(_column(rows, "percent_stride", name), name)
    curves = {
        signal.name: _curves(signal, rows, name)
        for signal in SIGNALS.values()
        if all(column in header for column in signal.columns)
    }
    return HumanGait(name, curves)


def _curves(
    signal: Signal, rows: list[dict[str, str]], name: str
) -> tuple[PeriodicCurve, PeriodicCurve]:
    mean, sd = (_column(rows, column, name) for column in signal.columns)
    # reactions may be known exactly (zero in swing); a corridor of angles may not close
    corridor = signal.unit == "deg"
    bad = sd <= 0 if corridor else sd < 0
    field = signal.columns[1]
    if np.any(bad):
        at = int(np.argmax(bad))
        raise CorridorError(
            f"must be positive (data row {at + 1})",
            "give the standard deviation of each point",
            field=field,
            value=float(sd[at]),
            file=name,
        )
    width = PeriodicCurve.through(sd)
    if corridor:
        percent = np.linspace(0, 100, 2001)
        between = width(percent / 100)
        at = int(np.argmin(between))
        if between[at] <= 0:
            raise CorridorError(
                f"is so ragged that its curve falls to {between[at]:.3g} at {percent[at]:.0f} %",
                "smooth the standard deviations",
                field=field,
                file=name,
            )
    return PeriodicCurve.through(signal.sign * mean), width


def _column(rows: list[dict[str, str]], column: str, name: str) -> NDArray[np.float64]:
    values = []
    for number, row in enumerate(rows, start=1):
        try:
            value = float(row[column])
        except (TypeError, ValueError):
            value = math.nan
        if not math.isfinite(value):
            raise CorridorError(
                f"must be a finite number (data row {number})",
                "fill the gap or remove the column",
                field=column,
                value=row[column],
                file=name,
            )
        values.append(value)
    return np.array(values)


def _check_steps(percent: NDArray[np.float64], name: str) -> None:
    expected = np.linspace(0, 100, len(percent)) if len(percent) > 1 else np.array([np.nan])
    if len(percent) < 11 or not np.allclose(percent, expected, atol=1e-6):
        raise CorridorError(
            "must run from 0 to 100 in equal steps, with 11 rows or more",
            "resample the curves over the stride",
            field="percent_stride",
            value=[float(p) for p in percent[:3]],
            file=name,
        )
