"""A recorded walk as it stands in its files: markers and force plates, in the axes of the files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError

Array = NDArray[np.float64]

UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
"""Units of length of markers, in m."""

MOST_NUMBERS = 50_000_000
"""Numbers that a recording may hold: an hour of fifty markers at 100 Hz."""

SLOWEST, FASTEST = 20.0, 100_000.0
"""Range of a sampling rate [Hz]; slower than that no event of a step can be placed."""

FEWEST_FRAMES = 10
FARTHEST = 1e4
"""Largest coordinate [m]."""

STRONGEST = 1e6
"""Largest force [N] or moment [N m]."""


@dataclass(frozen=True)
class Plate:
    """What a force plate gave: the load on the foot over time.

    ``time`` (k,) [s]; ``force`` (k, 3) [N] of the ground on the foot; ``moment`` (k, 3) [N m]
    about ``point`` (k, 3), which is the centre of pressure or, where None, the origin. ``unit`` is
    that of ``point``, None where the file does not state it.
    """

    name: str
    time: Array
    force: Array
    moment: Array
    point: Array | None = None
    unit: str | None = None

    def in_metres(self, unit: str) -> Plate:
        """The same with its point in metres; ``unit`` counts where the plate states none."""
        if self.point is None:
            return self
        return replace(self, point=UNITS[self.unit or unit] * self.point, unit="m")

    def moment_about_origin(self) -> Array:
        """The moment of the load about the origin (k, 3) [N m]; lengths must be metres."""
        if self.point is None:
            return self.moment
        return self.moment + np.cross(self.point, self.force)


@dataclass(frozen=True)
class Recording:
    """Markers and force plates of one trial.

    ``time`` (n,) [s] in equal steps; ``markers`` (n, 3) by name, NaN where a marker was not seen;
    ``unit`` of their lengths, None where the file does not state it. ``planar`` marks files that
    have x and y alone (z = 0).
    """

    file: str
    time: Array
    markers: Mapping[str, Array]
    unit: str | None
    plates: tuple[Plate, ...] = ()
    planar: bool = False

    @property
    def rate(self) -> float:
        """Sampling rate of the markers [Hz]."""
        return float((len(self.time) - 1) / (self.time[-1] - self.time[0]))

    def in_metres(self, unit: str) -> Recording:
        """The same with all lengths in metres, ``unit`` being that of the markers."""
        scale = UNITS[unit]
        plates = tuple(plate.in_metres(unit) for plate in self.plates)
        markers = {name: scale * values for name, values in self.markers.items()}
        return replace(self, markers=markers, plates=plates, unit="m")

    def with_plates(self, plates: tuple[Plate, ...]) -> Recording:
        """The same with more force plates."""
        return replace(self, plates=(*self.plates, *plates))

    def flipped(self) -> Recording:
        """The same with the loads of the plates turned round: of the foot on the ground in, of the
        ground on the foot out."""
        plates = tuple(replace(p, force=-p.force, moment=-p.moment) for p in self.plates)
        return replace(self, plates=plates)


def even_time(time: Array, file: str, field: str) -> Array:
    """Times in exactly equal steps; files round them.

    Raises
    ------
    RecordingError
        If there are too few, they do not run forward in equal steps, or the rate is no rate of a
        motion capture.
    """
    if len(time) < FEWEST_FRAMES:
        raise RecordingError(
            f"needs {FEWEST_FRAMES} frames or more",
            "give a recording of a whole stride",
            field=field,
            value=len(time),
            file=file,
        )
    if not np.all(np.isfinite(time)) or not time[-1] > time[0]:
        raise RecordingError(
            "must be finite and run forward", "mend the times", field=field, file=file
        )
    even = np.linspace(time[0], time[-1], len(time))
    step = even[1] - even[0]
    off = np.abs(time - even)
    if off.max() > 0.75 * step:
        at = int(np.argmax(off))
        raise RecordingError(
            f"must run in equal steps (row {at + 1} is {off[at] / step:.1f} steps off)",
            "resample the recording, or cut it where frames are lost",
            field=field,
            value=float(time[at]),
            file=file,
        )
    if not SLOWEST <= 1 / step <= FASTEST:
        raise RecordingError(
            f"the sampling rate must lie between {SLOWEST:g} and {FASTEST:g} Hz",
            "give times in seconds",
            field=field,
            value=round(float(1 / step), 3),
            file=file,
        )
    return even


def checked(recording: Recording) -> Recording:
    """The recording, its numbers within what a walk in a room can be.

    Raises
    ------
    RecordingError
        For coordinates, forces or moments beyond any laboratory.
    """
    scale = UNITS[recording.unit] if recording.unit else UNITS["mm"]
    for name, values in recording.markers.items():
        _within(scale * values, FARTHEST, "m", name, recording.file)
    for plate in recording.plates:
        _within(plate.force, STRONGEST, "N", f"{plate.name} force", recording.file)
        _within(plate.moment, STRONGEST, "N m", f"{plate.name} moment", recording.file)
    return recording


def _within(values: Array, limit: float, unit: str, field: str, file: str) -> None:
    bad = np.isinf(values) | (np.abs(np.nan_to_num(values)) > limit)
    if np.any(bad):
        row = int(np.argwhere(bad)[0][0])
        raise RecordingError(
            f"must stay below {limit:g} {unit} (frame {row + 1})",
            "check the units and the file",
            field=field,
            value=float(values[bad][0]),
            file=file,
        )
