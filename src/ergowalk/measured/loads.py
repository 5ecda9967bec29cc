"""Which foot stands on which plate when, and what loads it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.measured.choices import Choices
from ergowalk.measured.filtering import low_pass
from ergowalk.measured.trial import Trial

Array = NDArray[np.float64]

CONTACT = 20.0
"""Vertical force [N] from which a foot is on a plate."""

SHORTEST = 0.15
"""Shortest contact [s]; less is a knock or noise."""

LONGEST = 2.0
"""Longest contact [s]; more is more than one foot."""

DRIFT = 40.0
"""Vertical force [N] below which a plate may be unloaded and show its zero."""

TOLERATED = 5.0
"""A vertical zero that is off by more than this [N] is taken off, with those of the others."""

REACH = 0.15
"""How far behind the heel or ahead of the metatarsals the load may lie and be that foot's [m]."""

ASIDE = 0.20
"""How far beside the foot [m]."""

HOLDABLE = 0.4
"""What of its sampling rate a record of markers can hold of the forces."""


@dataclass(frozen=True)
class Contact:
    """A foot on a plate from ``start`` to ``end`` [s]; either is None where the record cuts it."""

    start: float | None
    end: float | None
    first: int
    last: int


@dataclass(frozen=True)
class FootLoad:
    """The load of a foot: forward and upward force and moment about the origin (n, 3) [N, N m].

    ``contacts`` are those that a plate has seen.
    """

    load: Array
    contacts: tuple[Contact, ...]

    def events(self) -> dict[str, list[float]]:
        """Instants of contacts and toe-offs [s]."""
        return {
            "contacts": [c.start for c in self.contacts if c.start is not None],
            "toe_offs": [c.end for c in self.contacts if c.end is not None],
        }

    def covers(self, time: Array, start: float, end: float) -> bool:
        """Whether one plate has seen the foot from ``start`` to ``end``, up to two frames."""
        slack = 2.5 * float(time[1] - time[0])
        return any(
            (c.start is None or c.start <= start + slack) and time[c.first] <= start + slack
            and (c.end is None or c.end >= end - slack) and time[c.last] >= end - slack
            for c in self.contacts
        )  # fmt: skip


def foot_loads(trial: Trial, choices: Choices) -> tuple[dict[str, FootLoad], list[str]]:
    """The load of each foot at the frames of the trial, and notes.

    A contact is that foot's over which the centre of pressure lies; one that lies over none
    (the other leg of a one-legged set) or is shared is left out.
    """
    n = len(trial.time)
    loads = {side: np.zeros((n, 3)) for side in trial.legs}
    contacts: dict[str, list[Contact]] = {side: [] for side in trial.legs}
    notes: list[str] = []
    for plate in trial.recording.plates:
        rate = (len(plate.time) - 1) / (plate.time[-1] - plate.time[0])
        raw = trial.plane.load(plate)
        zero = _zero(raw)
        if abs(zero[1]) > TOLERATED:
            raw = raw - zero
            notes.append(f"{plate.name} shows {zero[1]:.0f} N unloaded: taken off")
        limit = choices.force_cutoff_hz or HOLDABLE * trial.rate
        filtered = choices.force_cutoff_hz is not None or rate > 1.5 * trial.rate
        for start, end, i, j in _contacts(raw[:, 1], plate.time):
            frames = np.flatnonzero((trial.time >= plate.time[i]) & (trial.time <= plate.time[j]))
            if not len(frames):
                continue
            alone = np.zeros_like(raw)
            alone[i : j + 1] = raw[i : j + 1]
            if filtered:
                alone = low_pass(alone, rate, limit)
            at = np.stack([np.interp(trial.time, plate.time, c) for c in alone.T], axis=1)
            side = _side(trial, frames, at[frames])
            if side is None:
                when = f"{plate.time[i]:.2f} to {plate.time[j]:.2f} s"
                notes.append(f"{plate.name} from {when} is under no foot of the markers: left out")
                continue
            loads[side] += at[:, [0, 1, 5]]
            contacts[side].append(Contact(start, end, int(frames[0]), int(frames[-1])))
    ordered = {s: tuple(sorted(c, key=lambda k: k.first)) for s, c in contacts.items()}
    return {side: FootLoad(loads[side], ordered[side]) for side in trial.legs}, notes


def _zero(load: Array) -> Array:
    """What a plate shows unloaded (6,), zeros where it is never so."""
    idle = np.abs(load[:, 1]) < DRIFT
    return np.median(load[idle], axis=0) if idle.mean() > 0.1 else np.zeros(6)


def _contacts(force: Array, time: Array) -> list[tuple[float | None, float | None, int, int]]:
    """Instants at which the force passes :data:`CONTACT`, and first and last frame between."""
    on = force > CONTACT
    edges = np.flatnonzero(np.diff(np.concatenate([[0], on.astype(int), [0]])))
    found = []
    for i, j in edges.reshape(-1, 2):
        last = int(j) - 1
        whole = i > 0 and j < len(force)  # what the record cuts may be as short as it likes
        if time[last] - time[i] > LONGEST or (whole and time[last] - time[i] < SHORTEST):
            continue
        start = _crossing(force, time, int(i) - 1) if i > 0 else None
        end = _crossing(force, time, last) if j < len(force) else None
        found.append((start, end, int(i), last))
    return found


def _crossing(force: Array, time: Array, i: int) -> float:
    share = (CONTACT - force[i]) / (force[i + 1] - force[i])
    return float(time[i] + share * (time[i + 1] - time[i]))


def pressure(load: Array) -> Array:
    """Forward coordinate (n,) [m] at which a load (n, 3) passes the ground; NaN if unloaded."""
    vertical = np.where(load[:, 1] > CONTACT, load[:, 1], np.nan)
    found: Array = load[:, -1] / vertical
    return found


def _side(trial: Trial, frames: NDArray[np.int_], load: Array) -> str | None:
    """The foot over which a load (k, 6) lies, weighed by its vertical part."""
    weight = np.maximum(load[:, 1], 0.0)
    weight = weight / weight.sum()
    ahead = float(weight @ np.nan_to_num(pressure(load)))
    aside = float(weight @ np.nan_to_num(-load[:, 3] / np.maximum(load[:, 1], CONTACT)))
    best: tuple[float, str | None] = (np.inf, None)
    for side, leg in trial.legs.items():
        heel, toes = (weight @ leg[role][frames] for role in ("heel", "metatarsal"))
        if not heel[0] - REACH < ahead < toes[0] + REACH:
            continue
        off = 0.0 if trial.recording.planar else abs(aside - (heel[2] + toes[2]) / 2)
        if off > ASIDE and not _flat(load):
            continue
        distance = off + abs(ahead - (heel[0] + toes[0]) / 2)
        best = min(best, (distance, side), key=lambda item: item[0])
    return best[1]


def _flat(load: Array) -> bool:
    """Whether a plate tells nothing of sideways moments."""
    return not np.any(load[:, 3:5])
