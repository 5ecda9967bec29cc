"""Which case begins at which: a tree from the base problem outward, decided before any work.

So the gait of a case depends on the sweep alone, not on how many workers there are or which of
them is quick.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.study.cases import Case
from ergowalk.study.definition import Sweep
from ergowalk.study.looks import Look

Array = NDArray[np.float64]

OTHER_KIND = 1e3
"""Distance of two values that are not both numbers, as a table of human data: farther than any
two numbers, so that there is one step from kind to kind."""

_ROUNDING = 1e-9


@dataclass(frozen=True)
class Step:
    """A case and the one that it begins at, or a second look at it; else it begins where the sweep
    does."""

    case: Case
    neighbour: Case | None
    look: Look | None = None

    @property
    def key(self) -> str:
        """Name of the result."""
        return self.look.key if self.look else self.case.key


def planned(sweep: Sweep, cases: Sequence[Case]) -> tuple[Step, ...]:
    """The cases that have a problem, nearest to the base problem first.

    Each begins at the nearest of those before it; of two as near, at the one nearer to the base
    problem. Of a grid numbers count by their places in the list, of other sweeps in parts of
    the range that they cover, times the number of values that this range would have in a grid of
    as many cases.
    """
    solvable = [case for case in cases if case.problem is not None]
    if not solvable:
        return ()
    places, base = _places(sweep, solvable)
    away = _distances(places, base)
    order = np.lexsort((np.arange(len(solvable)), np.round(away, 9)))
    first = Step(solvable[order[0]], None)
    steps = [first]
    for k in range(1, len(order)):
        i, before = order[k], order[:k]
        apart = _distances(places[before], places[i])
        nearest = before[int(np.flatnonzero(apart <= apart.min() + _ROUNDING)[0])]
        steps.append(Step(solvable[i], solvable[nearest] if sweep.solve.continuation else None))
    return tuple(steps)


def places_of(sweep: Sweep, cases: Sequence[Case]) -> list[list[float] | None]:
    """Where each case is, in steps of a grid; None of one without a problem."""
    solvable = [case for case in cases if case.problem is not None]
    rows = iter(_places(sweep, solvable)[0].round(9).tolist() if solvable else ())
    return [None if case.problem is None else next(rows) for case in cases]


def _distances(places: Array, point: Array) -> Array:
    distances: Array = np.sqrt(((places - point) ** 2).sum(axis=1))
    return distances


def _places(sweep: Sweep, cases: Sequence[Case]) -> tuple[Array, Array]:
    """Coordinates of the cases (n, k) and of the base problem (k,), in steps of a grid."""
    columns, base = [], []
    for field in sweep.fields:
        values = [case.values[field] for case in cases]
        given = sweep.value_in_base(field)
        for column, point in _columns(sweep, field, values, given, len(cases)):
            columns.append(column)
            base.append(point)
    return np.array(columns).T, np.array(base)


def _columns(
    sweep: Sweep, field: str, values: list[Any], given: Any, count: int
) -> list[tuple[Array, float]]:
    """Coordinates that a field gives: one if all its values are numbers, else one per kind too."""
    numbers = sorted({float(v) for v in values if is_number(v)})
    found = []
    if numbers:
        middle = numbers[len(numbers) // 2]
        if sweep.grid is not None:
            scale, ticks = np.arange(float(len(numbers))), np.array(numbers)
        else:
            steps = max(count ** (1 / len(sweep.fields)) - 1, 1.0)
            scale, ticks = np.array([0.0, steps]), np.array([numbers[0], numbers[-1]])
        if len(ticks) > 1 and ticks[0] == ticks[-1]:
            scale, ticks = scale[:1], ticks[:1]

        def place(value: Any) -> float:
            return float(np.interp(value if is_number(value) else middle, ticks, scale))

        found.append((np.array([place(v) for v in values]), place(given)))
    kinds = {_kind(v): None for v in values}
    if len(kinds) > 1:
        for kind in kinds:
            marks = np.array([OTHER_KIND * (_kind(v) == kind) for v in values])
            found.append((marks, OTHER_KIND * (_kind(given) == kind)))
    return found or [(np.zeros(len(values)), 0.0)]


def is_number(value: Any) -> bool:
    """Whether a value of a problem file is a number."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def _kind(value: Any) -> str:
    return "number" if is_number(value) else json.dumps(value)
