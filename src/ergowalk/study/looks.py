"""Second looks at a map: cases searched again, because a cheaper gait is known next to them.

Continuation stays on the branch of gaits that it began with, and E has several. So some cases,
spread over the map, are searched from the human means too, and a gait that is cheap for its place
is tried as the start of its neighbours, round after round, until none of them promises anything.

A look is a result of its own, named after the case and the gait at which it begins; none replaces
another, and the cheapest accepted one stands for the case. So which looks follow is decided by
what is on disk alone, and a sweep that was killed among them goes on where it was.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.study.cases import KEY_LENGTH, Record

Array = NDArray[np.float64]

GAIN = 0.01
"""Share of E that a neighbour must promise: twice what a finer mesh may change in a gait."""

ASIDE = 1.5
"""Distance up to which cases are neighbours, in steps of the grid: diagonals are."""

AROUND = 3.5
"""Distance up to which cases tell the trend of E."""

_PER_COEFFICIENT = 2
"""Gaits that a coefficient of the trend needs."""

Known = Callable[[Iterable[str]], dict[str, Record]]
"""Records that are there, by key."""


@dataclass(frozen=True)
class Look:
    """One more search of a case.

    Attributes
    ----------
    case : str
        Key of the case.
    start : str
        Key of the gait at which it begins; empty for the human means.
    """

    case: str
    start: str

    @property
    def key(self) -> str:
        """Name of its result."""
        text = f"{self.case} begun at {self.start or 'the human means'}"
        return hashlib.sha256(text.encode()).hexdigest()[:KEY_LENGTH]


class Looks:
    """The cases of a sweep, and for each the best result so far.

    Parameters
    ----------
    definition : mapping
        The sweep as :meth:`~ergowalk.study.store.Store.definition` has it.
    known : callable
        Which records there are.
    """

    def __init__(self, definition: Mapping[str, Any], known: Known) -> None:
        self.known = known
        # sweeps from before there were second looks say nothing of them
        self.probes = definition.get("probes", 0)
        self.rounds = definition.get("second_looks", 0)
        self.keys = [case["key"] for case in definition["cases"]]
        self.best = known(self.keys)
        """The record that stands for each case."""
        self.searches = dict.fromkeys(self.best, 1)
        """How often each case was searched."""
        self.cpu_s = {key: record.get("cpu_s") or 0.0 for key, record in self.best.items()}
        """Processor time [s] of all searches of each case."""
        self._complete = len(self.best) == len(self.keys)
        self._places = {
            case["key"]: np.array(case["place"])
            for case in definition["cases"]
            if case.get("place") is not None
        }
        self._tried = {(key, record["begun_at"]) for key, record in self.best.items()}

    def each_round(self) -> Iterator[tuple[Look, ...]]:
        """The looks of each round, when those before are done; ends where one was not finished."""
        if not self._complete:
            return
        for number in range(1 + self.rounds):
            looks = self._promising() if number else self._spread()
            if number and not looks:
                return
            yield looks
            records = self.known(look.key for look in looks)
            if len(records) < len(looks):
                return
            for look in looks:
                self._take(look, records[look.key])

    def finished(self) -> Looks:
        """After all rounds that are on disk."""
        for _ in self.each_round():
            pass
        return self

    def _take(self, look: Look, record: Record) -> None:
        self._tried.add((look.case, look.start))
        self.searches[look.case] += 1
        self.cpu_s[look.case] += record.get("cpu_s") or 0.0
        if _rank(record) < _rank(self.best[look.case]):
            self.best[look.case] = record

    def _spread(self) -> tuple[Look, ...]:
        """Cases as far as can be from each other and from those begun at the human means."""
        keys = list(self._places)
        if not keys:
            return ()
        places = np.array(list(self._places.values()))
        cold = [not self.best[key]["begun_at"] for key in keys]
        away = np.full(len(keys), math.inf)
        for here in places[cold]:
            away = np.minimum(away, np.linalg.norm(places - here, axis=1))
        found: list[Look] = []
        while len(found) < self.probes and (away > 0).any():
            # of two as far the first one, whatever the last digit of a distance
            farthest = int(np.flatnonzero(away >= away.max() - 1e-9)[0])
            found.append(Look(keys[farthest], ""))
            away = np.minimum(away, np.linalg.norm(places - places[farthest], axis=1))
        return tuple(found)

    def _promising(self) -> tuple[Look, ...]:
        """For each case the neighbour's gait that promises most, if that is enough."""
        from scipy.spatial import KDTree

        good = [key for key in self._places if self.best[key]["status"] == "accepted"]
        if not good:
            return ()
        places = np.array([self._places[key] for key in good])
        height = np.log([self.best[key]["energy_per_metre"] for key in good])
        tree, found = KDTree(places), []
        for key, here in self._places.items():
            near = tree.query_ball_point(here, AROUND, return_sorted=True)
            trend, own = _trend(places[near] - here, height[near]), None
            if self.best[key]["status"] == "accepted":
                if trend is None:
                    continue
                own = math.log(self.best[key]["energy_per_metre"]) - trend(0 * here)
            choices: list[tuple[float, int, str]] = []
            for i in tree.query_ball_point(here, ASIDE, return_sorted=True):
                start = self.best[good[i]]["key"]
                if good[i] == key or (key, start) in self._tried:
                    continue
                excess = height[i] - (trend(places[i] - here) if trend else 0.0)
                if own is None or own - excess > GAIN:
                    choices.append((excess, len(choices), start))
            if choices:
                found.append(Look(key, min(choices)[2]))
        return tuple(found)


def _trend(places: Array, height: Array) -> Callable[[Array], float] | None:
    """The parabola, else the plane, through log E around a case; None if there are too few gaits.

    A direction in which these do not differ plays no part.
    """
    used = np.ptp(places, axis=0) > 0 if len(places) else np.zeros(places.shape[1], dtype=bool)
    for squares in (True, False):
        basis = _basis(places[:, used], squares)
        if used.any() and len(places) >= _PER_COEFFICIENT * basis.shape[1]:
            coefficients = np.linalg.lstsq(basis, height, rcond=None)[0]
            return lambda at: float((_basis(at[None, used], squares) @ coefficients)[0])
    return None


def _basis(places: Array, squares: bool) -> Array:
    n, k = places.shape
    columns = [np.ones(n), *places.T]
    if squares:
        columns += [places[:, i] * places[:, j] for i in range(k) for j in range(i, k)]
    basis: Array = np.array(columns).T
    return basis


def _rank(record: Record) -> tuple[int, float]:
    """Accepted before rejected before no gait; then by E."""
    place = ("accepted", "rejected").index(record["status"]) if record["gait"] else 2
    energy = record.get("energy_per_metre")
    return place, math.inf if energy is None else float(energy)
