"""Heel contacts and toe-offs: from the plates, or from the movement of the feet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from ergowalk.measured.filtering import differences
from ergowalk.measured.trial import Trial

Array = NDArray[np.float64]

SWING = 0.05
"""Least way [m] by which a foot passes the hip back and forth in a step."""

FALL_SHARE = 0.75
"""Heel contact lies between the instant at which the heel is farthest ahead of the hip, and that
at which the middle of the foot falls fastest: at this share of the way. On four recordings of three
laboratories (ten contacts) this is within 17 ms of the plates."""

PUSH_SHARE = 1 / 3
"""Toe-off lies between the instant at which the metatarsals are farthest behind the hip, and that
at which they are accelerated forward most: at this share of the way. On the same recordings
(seven toe-offs) within 14 ms of the plates."""

WINDOW = 0.12
"""How long around the first of the two instants the second is looked for [s]."""

EDGE = 0.03
"""An event nearer than this to an end of the record is not believed [s]: the extremum may lie
outside."""

MATCH = 0.1
"""A plate's event within this of one of the feet is the same [s]."""


@dataclass(frozen=True)
class Events:
    """Heel contacts and toe-offs of a leg [s], in order."""

    contacts: tuple[float, ...]
    toe_offs: tuple[float, ...]

    def toe_off_in(self, start: float, end: float) -> float | None:
        """The toe-off of the stride from ``start`` to ``end``, None if there is none or many."""
        inside = [t for t in self.toe_offs if start < t < end]
        return inside[0] if len(inside) == 1 else None


def events_by_feet(trial: Trial, side: str) -> Events:
    """Events of a leg from its markers alone.

    Farthest ahead and farthest behind follow Zeni, Richards & Higginson (2008), the fall of the
    foot O'Connor et al. (2007).
    """
    leg, rate, time = trial.rough[side], trial.rate, trial.time
    hip = np.mean([leg["hip"][:, 0] for leg in trial.rough.values()], axis=0)
    fall = -differences((leg["heel"] + leg["metatarsal"])[:, 1] / 2, rate)
    behind = hip - leg["metatarsal"][:, 0]
    push = differences(differences(-behind, rate), rate)
    window = int(WINDOW * rate)
    contacts = [
        _between(first, time[0] + _peak(fall, i, i + window) / rate, FALL_SHARE)
        for i, first in _peaks(leg["heel"][:, 0] - hip, time)
    ]
    toe_offs = [
        _between(first, time[0] + _peak(push, i - window // 2, i + window) / rate, PUSH_SHARE)
        for i, first in _peaks(behind, time)
    ]
    return Events(_inside(contacts, time), _inside(toe_offs, time))


def _between(first: float, second: float, share: float) -> float:
    return float(first + share * (second - first))


def _inside(instants: list[float], time: Array) -> tuple[float, ...]:
    return tuple(t for t in instants if time[0] + EDGE < t < time[-1] - EDGE)


def _peaks(values: Array, time: Array) -> list[tuple[int, float]]:
    """Frames and instants of the maxima of one step each."""
    frames = find_peaks(values, prominence=SWING)[0]
    return [(int(i), float(time[0] + _vertex(values, i) * (time[1] - time[0]))) for i in frames]


def _peak(values: Array, first: int, last: int) -> float:
    """Frame, between frames by a parabola, of the largest of ``values[first:last + 1]``."""
    first = max(first, 0)
    return _vertex(values, first + int(np.argmax(values[first : last + 1])))


def _vertex(values: Array, i: int) -> float:
    if not 0 < i < len(values) - 1:
        return float(i)
    before, at, after = values[i - 1 : i + 2]
    bend = before - 2 * at + after
    return float(i + (np.clip((before - after) / (2 * bend), -1, 1) if bend < 0 else 0.0))


def merged(by_feet: Events, by_plates: Mapping[str, list[float]]) -> tuple[Events, str]:
    """The events of a leg, those of the plates where there are any, and what was done.

    Where both are known, the feet's events that have no plate are moved by the mean difference of
    those that have one.
    """
    contacts, n_contacts, shift_c = _merge(by_feet.contacts, by_plates["contacts"])
    toe_offs, n_toe_offs, shift_t = _merge(by_feet.toe_offs, by_plates["toe_offs"])
    total = len(contacts) + len(toe_offs)
    text = f"{n_contacts + n_toe_offs} of {total} events by the plates"
    if n_contacts + n_toe_offs < total:
        text += (
            f", the others by the feet, moved by {1e3 * shift_c:+.0f} ms (contacts) and "
            f"{1e3 * shift_t:+.0f} ms (toe-offs) as the plates have it"
        )
    return Events(contacts, toe_offs), text


def _merge(feet: tuple[float, ...], plates: list[float]) -> tuple[tuple[float, ...], int, float]:
    shifts = [p - f for p in plates for f in feet if abs(p - f) < MATCH]
    shift = float(np.mean(shifts)) if shifts else 0.0
    others = [f + shift for f in feet if all(abs(p - f) >= MATCH for p in plates)]
    return tuple(sorted([*plates, *others])), len(plates), shift
