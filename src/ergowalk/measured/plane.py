"""The plane of progression: which way is up, which way the person walks, and where the floor is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError
from ergowalk.recording import Plate, Recording

Array = NDArray[np.float64]

AXES = "xyz"

WALKED = 0.5
"""Least way of the hips [m] that shows where the person goes; less is a treadmill, where the feet
show it."""

STEEPEST = 0.35
"""Largest share of its length by which the line of forces may lean off the vertical."""

DEEPEST, HIGHEST_MARKER = -0.05, 0.20
"""Where the lowest foot marker may be over the floor of the laboratory [m]; else it makes it."""

LOWEST_MARKER = 0.02
"""Height of the lowest foot marker [m] where the floor has to be taken from it."""


@dataclass(frozen=True)
class Plane:
    """The plane of progression in the axes of the laboratory: unit vectors and the floor [m]."""

    forward: Array
    up: Array
    floor: float

    @property
    def right(self) -> Array:
        """The walker's right, forward x up: the axis of positive (counter-clockwise) angles."""
        return np.cross(self.forward, self.up)

    def project(self, points: Array) -> Array:
        """Forward, up over the floor, and right coordinate (n, 3) of points (n, 3)."""
        found: Array = points @ np.stack([self.forward, self.up, self.right], axis=1)
        found[:, 1] -= self.floor
        return found

    def load(self, plate: Plate) -> Array:
        """Force and moment of a plate (k, 6) along forward, up, right; the moment is about the
        origin of :meth:`project`."""
        axes = np.stack([self.forward, self.up, self.right], axis=1)
        force, moment = plate.force @ axes, plate.moment_about_origin() @ axes
        moment -= np.cross(np.array([0.0, self.floor, 0.0]), force)
        return np.concatenate([force, moment], axis=1)


Points = Mapping[str, Mapping[str, Array]]
"""Points of a leg (n, 3) by side and role."""


def find_plane(recording: Recording, legs: Points, sway: Array) -> Plane:
    """The plane of progression from the legs, and from where the person goes.

    Parameters
    ----------
    recording : Recording
        The trial in metres, with its plates.
    legs : mapping
        Points of each leg in the laboratory.
    sway : (n, 3) array
        The middle of the hips.

    Raises
    ------
    RecordingError
        If the legs do not hang below the hips, or the plates do not push up.
    """
    up = _up(recording, legs)
    _check_plates(recording, up)
    forward = _forward(recording, legs, sway, up)
    return Plane(forward, up, _floor(legs, up))


def _up(recording: Recording, legs: Points) -> Array:
    if recording.planar:
        up = np.array([0.0, 1.0, 0.0])
    else:
        rise = np.mean(
            [np.nanmean(leg["hip"] - leg["ankle"], axis=0) for leg in legs.values()], axis=0
        )
        axis = int(np.argmax(np.abs(rise)))
        up = np.zeros(3)
        up[axis] = np.sign(rise[axis])
    for side, leg in legs.items():
        if not np.nanmean((leg["hip"] - leg["ankle"]) @ up) > 0:
            raise RecordingError(
                "the hip must be above the ankle",
                "check the axes (y up in the plane) and the map of the markers",
                field=f"{side} leg",
                file=recording.file,
            )
    return up


def _check_plates(recording: Recording, up: Array) -> None:
    for plate in recording.plates:
        size = np.linalg.norm(plate.force, axis=1)
        loaded = size > 0.5 * size.max(initial=0.0)
        if not loaded.any() or size.max() <= 0:
            continue
        push = plate.force[loaded].mean(axis=0)
        length = float(np.linalg.norm(push))
        rise = float(push @ up)
        if rise < -(1 - STEEPEST) * length:
            raise RecordingError(
                "pushes the foot down: the plate is upside down, or gives the force of the foot "
                "on the ground",
                "give --flip-forces, or mend the corners of the plate",
                field=f"{plate.name}, mean force under load [N]",
                value=round(rise, 1),
                file=recording.file,
            )
        if rise < (1 - STEEPEST) * length:
            raise RecordingError(
                f"pushes along {np.round(push, 1).tolist()} N, and up is "
                f"{'-' if up.min() < 0 else '+'}{AXES[int(np.argmax(np.abs(up)))]}",
                "give markers and forces in the same axes",
                field=plate.name,
                file=recording.file,
            )


def _forward(recording: Recording, legs: Points, sway: Array, up: Array) -> Array:
    flat = np.eye(3) - np.outer(up, up)
    seen = sway[np.isfinite(sway).all(axis=1)]
    way = flat @ (seen[-1] - seen[0]) if len(seen) else np.zeros(3)
    feet = flat @ np.mean(
        [np.nanmean(leg["metatarsal"] - leg["heel"], axis=0) for leg in legs.values()], axis=0
    )
    if float(np.linalg.norm(way)) < WALKED:
        way = feet
    elif float(way @ feet) < 0:
        raise RecordingError(
            "the toes point away from where the hips go: no forward walk",
            "check the map of heel and metatarsal",
            field="markers",
            file=recording.file,
        )
    length = float(np.linalg.norm(way))
    if not length > 1e-3:
        raise RecordingError(
            "the feet have no direction", "check the markers of heel and metatarsal",
            field="markers", file=recording.file,
        )  # fmt: skip
    if recording.planar:
        return np.array([np.sign(way[0]), 0.0, 0.0])
    return np.asarray(way / length)


def _floor(legs: Points, up: Array) -> float:
    low = min(
        float(np.nanpercentile(leg[role] @ up, 5))
        for leg in legs.values()
        for role in ("heel", "metatarsal")
    )
    return 0.0 if DEEPEST < low < HIGHEST_MARKER else low - LOWEST_MARKER
