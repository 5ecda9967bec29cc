"""Human walking data as smooth periodic functions of the stride, and corridors around it.

A table gives mean and standard deviation at equal steps of the stride. Its first and last row
(0 % and 100 %, the same instant of a periodic gait) differ slightly in measured data: their
average is used for both. Through the remaining points goes the trigonometric polynomial of the
lowest degree, so every other row is reproduced exactly, and first and second derivatives are
exact too. Tables finer than 2 % are fitted by least squares with 25 harmonics.
"""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ergowalk.errors import CorridorError

MAX_HARMONICS = 25

ANGLES = ("hip", "knee", "ankle")
"""Joints with an angle corridor, in the order of (6)."""


@dataclass(frozen=True)
class PeriodicCurve:
    """Trigonometric polynomial of the stride fraction s, period 1.

    ``cosine[k]`` and ``sine[k]`` multiply cos(2 pi k s) and sin(2 pi k s).
    """

    cosine: tuple[float, ...]
    sine: tuple[float, ...]

    @classmethod
    def through(cls, samples: ArrayLike) -> PeriodicCurve:
        """Curve through equally spaced samples of one period, both ends given.

        Parameters
        ----------
        samples : (n + 1,) array
            Values at s = 0, 1/n, ..., 1; the first and the last are averaged.
        """
        values = np.asarray(samples, dtype=float)
        n = len(values) - 1
        ring = np.concatenate([[(values[0] + values[-1]) / 2], values[1:-1]])
        spectrum = np.fft.rfft(ring) / n
        degree = min(n // 2, MAX_HARMONICS)
        cosine, sine = 2 * spectrum.real[: degree + 1], -2 * spectrum.imag[: degree + 1]
        cosine[0] /= 2
        sine[0] = 0.0
        if 2 * degree == n:  # the highest harmonic of an even ring is its own alias
            cosine[-1] /= 2
            sine[-1] = 0.0
        return cls(tuple(cosine.tolist()), tuple(sine.tolist()))

    def __call__(self, s: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """Value, or ``derivative``-th derivative with respect to s, at stride fractions s.

        Returns an array shaped like ``s``.
        """
        s = np.asarray(s, dtype=float)
        k = np.arange(len(self.cosine))
        phase = 2 * np.pi * k * s[..., None]
        turn = derivative * np.pi / 2  # each derivative advances the phase by a right angle
        scale = (2 * np.pi * k) ** derivative
        even = np.cos(phase + turn) @ (scale * np.array(self.cosine))
        odd = np.sin(phase + turn) @ (scale * np.array(self.sine))
        return np.asarray(even + odd, dtype=float)

    def combined(self, other: PeriodicCurve, factor: float) -> PeriodicCurve:
        """self + factor * other."""
        return PeriodicCurve(
            tuple(a + factor * b for a, b in zip(self.cosine, other.cosine, strict=True)),
            tuple(a + factor * b for a, b in zip(self.sine, other.sine, strict=True)),
        )

    def of_harmonics(self, harmonics: list[tuple[Any, Any]]) -> Any:
        """Value from cos(2 pi k s), sin(2 pi k s) for k = 1, 2, ...: numbers or CasADi symbols.

        ``harmonics`` may go beyond :attr:`degree`; ValueError if it stops short of it.
        """
        total: Any = self.cosine[0]
        enough = harmonics[: self.degree]
        for a, b, (c, s) in zip(self.cosine[1:], self.sine[1:], enough, strict=True):
            total = total + a * c + b * s
        return total

    @property
    def degree(self) -> int:
        """Highest harmonic."""
        return len(self.cosine) - 1


@dataclass(frozen=True)
class Corridor:
    """Band mean - width * sd ... mean + width * sd around a human curve (6)."""

    mean: PeriodicCurve
    sd: PeriodicCurve
    width: float = 1.0

    @cached_property
    def lower(self) -> PeriodicCurve:
        """Lower bound theta(t) of (6)."""
        return self.mean.combined(self.sd, -self.width)

    @cached_property
    def upper(self) -> PeriodicCurve:
        """Upper bound Theta(t) of (6)."""
        return self.mean.combined(self.sd, self.width)


@dataclass(frozen=True)
class Signal:
    """A column pair of a table of human gait, and how it maps to the model's signs."""

    name: str
    stem: str
    unit: str
    sign: float
    label: str

    @property
    def columns(self) -> tuple[str, str]:
        """Column names of mean and standard deviation."""
        return f"{self.stem}_mean_{self.unit}", f"{self.stem}_sd_{self.unit}"


SIGNALS = {
    s.name: s
    for s in (
        Signal("hip_angle", "hip_flexion_angle", "deg", 1.0, "hip angle"),
        Signal("knee_angle", "knee_flexion_angle", "deg", 1.0, "knee angle"),
        Signal("ankle_angle", "ankle_dorsiflexion_angle", "deg", 1.0, "ankle angle"),
        Signal("reaction_x", "forward_reaction", "n_per_kg", 1.0, "horizontal reaction"),
        Signal("reaction_y", "vertical_reaction", "n_per_kg", 1.0, "vertical reaction"),
        # q and p are counter-clockwise on the distal segment: extension and plantarflexion are
        # clockwise there, knee extension is counter-clockwise on the shank.
        Signal("hip_moment", "hip_extension_moment", "nm_per_kg", -1.0, "hip moment"),
        Signal("knee_moment", "knee_extension_moment", "nm_per_kg", 1.0, "knee moment"),
        Signal("ankle_moment", "ankle_plantarflexion_moment", "nm_per_kg", -1.0, "ankle moment"),
        Signal("hip_power", "hip_power", "w_per_kg", 1.0, "hip power"),
        Signal("knee_power", "knee_power", "w_per_kg", 1.0, "knee power"),
        Signal("ankle_power", "ankle_power", "w_per_kg", 1.0, "ankle power"),
    )
}
"""Every signal a table may carry, by name; signs: +1 where the table's sign is the model's."""


@dataclass(frozen=True)
class HumanGait:
    """Mean and SD curves of human walking in the model's signs (angles in degrees)."""

    name: str
    curves: dict[str, tuple[PeriodicCurve, PeriodicCurve]]

    def corridor(self, signal: str, width: float = 1.0) -> Corridor:
        """Corridor of ``width`` standard deviations around ``signal``, in the table's unit.

        Raises
        ------
        CorridorError
            If the table has no such signal.
        """
        if signal not in self.curves:
            raise CorridorError(
                f"has no columns {' and '.join(SIGNALS[signal].columns)}",
                "add them, or choose another table",
                file=self.name,
            )
        mean, sd = self.curves[signal]
        return Corridor(mean, sd, width)

    def angle_corridor(self, joint: str, width: float) -> Corridor:
        """Corridor of a joint angle in radians."""
        mean, sd = self.curves[f"{joint}_angle"]
        zero = PeriodicCurve((0.0,) * len(mean.cosine), (0.0,) * len(mean.sine))
        scale = math.pi / 180
        return Corridor(zero.combined(mean, scale), zero.combined(sd, scale), width)


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
