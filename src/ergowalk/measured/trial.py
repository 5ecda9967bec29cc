"""A recording becomes a trial in the plane: named points of each leg over time, smoothed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError
from ergowalk.measured.choices import Choices
from ergowalk.measured.filtering import fill_gaps, longest_gap, low_pass
from ergowalk.measured.marker_sets import ROLES, MarkerSet, choose_marker_set
from ergowalk.measured.plane import Plane, find_plane
from ergowalk.measured.rigid import hip_centres, rebuilt
from ergowalk.recording import UNITS, Recording

Array = NDArray[np.float64]

LONGEST_GAP = 0.2
"""Longest time [s] for which an unseen marker is put in by interpolation."""

SHORTEST_TRIAL = 0.5
"""Least time [s] that must remain between gaps."""

SHANK = (0.2, 0.65)
"""Range of the length of a shank [m]: tells the unit, and a wrong one."""

RIGID = 0.15
"""Largest standard deviation of the length of a segment, as a share of it."""


@dataclass(frozen=True)
class Trial:
    """Points of the legs in the plane of progression.

    ``legs`` gives by side and role (n, 3) coordinates forward, up over the floor, right [m],
    smoothed; ``rough`` the same with a cut-off of their own for events; ``trunk`` (n, 3) or None.
    """

    recording: Recording
    marker_set: MarkerSet
    plane: Plane
    time: Array
    legs: Mapping[str, Mapping[str, Array]]
    rough: Mapping[str, Mapping[str, Array]]
    trunk: Array | None
    notes: tuple[str, ...]

    @property
    def rate(self) -> float:
        """Frames per second."""
        return float((len(self.time) - 1) / (self.time[-1] - self.time[0]))

    @property
    def hips(self) -> Array:
        """The middle of the hips (n, 3)."""
        middle: Array = np.mean([leg["hip"] for leg in self.legs.values()], axis=0)
        return middle


ROUGH_CUTOFF = 8.0
"""Cut-off [Hz] of the points in which events are looked for."""


def trial_of(recording: Recording, choices: Choices, static: Recording | None = None) -> Trial:
    """The trial of a recording.

    Raises
    ------
    RecordingError
        If markers are missing or lost for too long, the unit is wrong, or the plates do not fit.
    """
    names = {*recording.markers, *(static.markers if static else ())}
    marker_set = choose_marker_set(names, choices.markers)
    static_markers = _static(recording, static, choices)
    recording, notes = _metres(recording, static_markers, marker_set, choices)
    if choices.flip_forces:
        recording = recording.flipped()
        notes.append("the loads of the plates were turned round")
    markers = rebuilt(recording.markers, static_markers, marker_set)
    _check_there(markers, marker_set, recording.file)
    points, more = _whole(markers, marker_set, recording)
    notes += more
    legs = {s: {r: p for (side, r), p in points.items() if side == s} for s in marker_set.sides}
    sway = np.mean([leg["hip"] for leg in legs.values()], axis=0)
    plane = find_plane(recording, legs, sway)
    if plane.floor:
        notes.append(f"the floor is taken {plane.floor:.3f} m up, from the lowest foot marker")
    start, end = _longest_piece(points)
    time = recording.time[start:end]
    if len(time) < 20 or time[-1] - time[0] < SHORTEST_TRIAL:
        raise _lost(points, recording)
    if end - start < len(recording.time):
        notes.append(f"all points are there from {time[0]:.3f} to {time[-1]:.3f} s alone")
    if not marker_set.trunk:
        notes.append("no marker of the trunk: it is taken as upright")

    def projected(cutoff: float) -> dict[str, dict[str, Array]]:
        return {
            side: {
                role: low_pass(plane.project(p)[start:end], recording.rate, cutoff)
                for role, p in leg.items()
            }
            for side, leg in legs.items()
        }

    smooth, trunk = projected(choices.cutoff_hz), points.get(("trunk", "top"))
    if trunk is not None:
        trunk = low_pass(plane.project(trunk)[start:end], recording.rate, choices.cutoff_hz)
    trial = Trial(
        recording, marker_set, plane, time, smooth, projected(ROUGH_CUTOFF), trunk, tuple(notes)
    )
    _check_rigid(trial)
    return trial


def _static(walk: Recording, static: Recording | None, choices: Choices) -> dict[str, Array]:
    if static is None:
        return {}
    unit = static.unit or choices.units or walk.unit or "m"
    return dict(static.in_metres(unit).markers)


def _metres(
    recording: Recording, static: Mapping[str, Array], marker_set: MarkerSet, choices: Choices
) -> tuple[Recording, list[str]]:
    """The recording in metres; a unit that makes no leg is refused, one that is missing found."""
    stated = choices.units or recording.unit
    candidates = [stated] if stated else list(UNITS)
    for unit in candidates:
        metres = recording.in_metres(unit)
        shank = _shank(rebuilt(metres.markers, static, marker_set), marker_set, recording.file)
        if SHANK[0] <= shank <= SHANK[1]:
            note = f"the file states no unit of length: {unit}, by a shank of {shank:.2f} m"
            return metres, [] if stated else [note]
    length = f"{shank:.3g} m" + (f" in {stated}" if stated else "")
    raise RecordingError(
        f"is {length}, which is no leg's: the unit is wrong, or the map of the markers",
        "give --units mm, cm or m, or another --markers",
        field="knee to ankle",
        file=recording.file,
    )


def _shank(markers: Mapping[str, Array], marker_set: MarkerSet, file: str) -> float:
    lengths = []
    for side in marker_set.sides:
        leg = marker_set.leg(side)
        _check_there(markers, marker_set, file, (*leg.knee, *leg.ankle))
        knee, ankle = (
            np.mean([markers[n] for n in names], axis=0) for names in (leg.knee, leg.ankle)
        )
        length = np.linalg.norm(knee - ankle, axis=1)
        lengths += (
            [float(np.median(length[np.isfinite(length)]))] if np.isfinite(length).any() else []
        )
    if not lengths:
        raise RecordingError(
            "are never seen together", "check the map of the markers", field="knee and ankle",
            file=file,
        )  # fmt: skip
    return float(np.mean(lengths))


def _check_there(
    markers: Mapping[str, Array],
    marker_set: MarkerSet,
    file: str,
    names: tuple[str, ...] | None = None,
) -> None:
    wanted = marker_set.used() if names is None else names
    missing = [name for name in wanted if name not in markers]
    if missing:
        static = ", or a --static trial that has them" if marker_set.clusters else ""
        raise RecordingError(
            f"of the set {marker_set.name} are missing: {', '.join(missing)}",
            f"give another set or map with --markers{static}",
            field="markers",
            file=file,
        )


def _whole(
    markers: Mapping[str, Array], marker_set: MarkerSet, recording: Recording
) -> tuple[dict[tuple[str, str], Array], list[str]]:
    """Points by side and role (n, 3), short gaps filled; ("trunk", "top") among them."""
    filled, notes = {}, []
    most = int(LONGEST_GAP * recording.rate)
    needed = marker_set.used()
    toes = [name for side in marker_set.sides for name in marker_set.leg(side).toe]
    for name in dict.fromkeys([*needed, *(t for t in toes if t in markers)]):
        seen = _seen(markers[name])
        if seen.sum() < 4:
            if name in needed:
                raise RecordingError(
                    "is hardly ever seen", "give another trial", field=name, file=recording.file
                )
            continue
        lost = longest_gap(seen)
        filled[name] = _filled(markers[name], seen, most)
        if lost > 0:
            done = "filled in" if lost <= most else "too long to be filled in"
            notes.append(f"{name} is lost for {lost} frames at most: {done}")
    points: dict[tuple[str, str], Array] = {}
    for side in marker_set.sides:
        for role in ROLES:
            names = getattr(marker_set.leg(side), role)
            if names and all(name in filled for name in names):
                points[side, role] = np.mean([filled[name] for name in names], axis=0)
    if marker_set.pelvis is not None:
        centres = hip_centres(filled, marker_set.pelvis)
        for side in marker_set.sides:
            points.setdefault((side, "hip"), centres[side])
    if marker_set.trunk:
        points["trunk", "top"] = np.mean([filled[name] for name in marker_set.trunk], axis=0)
    return points, notes


def _seen(values: Array) -> NDArray[np.bool_]:
    return np.asarray(np.isfinite(values).all(axis=1), dtype=bool)


def _filled(values: Array, seen: NDArray[np.bool_], most: int) -> Array:
    """Gaps of up to ``most`` frames filled; longer ones stay."""
    filled = fill_gaps(np.where(seen[:, None], values, np.nan))
    at = np.flatnonzero(seen)
    for first, last in pairwise(at):
        if last - first - 1 > most:
            filled[first + 1 : last] = np.nan
    return filled


def _longest_piece(points: Mapping[tuple[str, str], Array]) -> tuple[int, int]:
    """Start and end of the longest run of frames in which every point is there."""
    there = np.isfinite(np.concatenate(list(points.values()), axis=1)).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], there.astype(int), [0]])))
    if not len(edges):
        return 0, 0
    runs = edges.reshape(-1, 2)
    start, end = runs[np.argmax(runs[:, 1] - runs[:, 0])]
    return int(start), int(end)


def _lost(points: Mapping[tuple[str, str], Array], recording: Recording) -> RecordingError:
    worst = min(points, key=lambda key: np.isfinite(points[key]).all(axis=1).sum())
    share = np.isfinite(points[worst]).all(axis=1).mean()
    return RecordingError(
        f"is seen in {share:.0%} of the frames; no {SHORTEST_TRIAL:g} s remain in which every "
        f"point is there (gaps of up to {LONGEST_GAP:g} s are filled)",
        "give another trial, or fill the gaps",
        field=" ".join(worst),
        file=recording.file,
    )


def _check_rigid(trial: Trial) -> None:
    for side, leg in trial.legs.items():
        for upper, lower in (("hip", "knee"), ("knee", "ankle"), ("heel", "metatarsal")):
            length = np.linalg.norm(leg[upper] - leg[lower], axis=1)
            spread = float(np.std(length) / np.mean(length)) if np.mean(length) > 0 else np.inf
            if spread > RIGID:
                raise RecordingError(
                    f"changes its length by {spread:.0%}: a segment is rigid",
                    "check the map of the markers, and markers that were exchanged",
                    field=f"{side} {upper} to {lower}",
                    file=trial.recording.file,
                )
