"""Rosenbrock's method of rotating orthogonal directions, in two forms.

The method of section 4 of the paper for problem (19), described in M. S. Bazaraa and
C. M. Shetty, Nonlinear Programming: Theory and Algorithms (1979), and first in
H. H. Rosenbrock, An automatic method for finding the greatest or least value of a function,
Computer Journal 3 (1960), 175-184.

>>> import numpy as np
>>> def valley(x):
...     return 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2
>>> found = Rosenbrock().minimise(valley, np.array([-1.2, 1.0]))
>>> found.message, bool(np.allclose(found.x, 1.0, atol=1e-6))
('converged: a stage brought less than the tolerances', True)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from ergowalk.solvers.descent import RotatingDirections, Search

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Rosenbrock(RotatingDirections):
    """Discrete steps, the original form.

    A step along each direction in turn is kept if the function falls, and the next one is
    ``expansion`` times as long; otherwise it is taken back, and the next one is ``contraction``
    times as long, to the other side. 3 and -1/2 are Rosenbrock's choice. A stage ends when every
    direction has had a success followed by a failure; a direction whose step has shrunk below the
    tolerance without any success is not waited for.
    """

    expansion: float = 3.0
    contraction: float = 0.5

    def _stage(self, search: Search, moves: Array, steps: Array) -> tuple[Array, Array]:
        n = len(steps)
        step: list[float] = steps.tolist()  # plain numbers: a third of the cost of array entries
        progress = [0.0] * n
        succeeded = [False] * n
        waiting = set(range(n))
        attempt, shrink = search.attempt, -self.contraction
        best = search.objective
        while waiting:
            for i in range(n):
                value = attempt(search.x + step[i] * moves[i])
                if value < best:
                    best = value
                    progress[i] += step[i]
                    step[i] *= self.expansion
                    succeeded[i] = True
                    continue
                step[i] *= shrink
                if succeeded[i] or abs(step[i]) < self.step_tolerance:
                    waiting.discard(i)
        return np.array(progress), np.array(step)


@dataclass(frozen=True, kw_only=True)
class RosenbrockLineSearch(RotatingDirections):
    """A minimum along each direction in turn, the form of Bazaraa & Shetty; a stage is one round.

    Each line search brackets a minimum by steps that grow by ``expansion``, and closes in on it
    by golden sections and parabolas. On the whole it takes more evaluations than discrete steps,
    up to eight times as many (Beale's function, where its stages converge but linearly).

    Attributes
    ----------
    line_tolerance : float
        Error of a line search, as a part of its bracket. Smaller ones down to 1e-5 save nothing
        on the classical functions of the tests.
    """

    expansion: float = 3.0
    line_tolerance: float = 1e-2

    def _stage(self, search: Search, moves: Array, steps: Array) -> tuple[Array, Array]:
        progress = np.zeros(len(steps))
        left = np.zeros(len(steps))
        for i, move in enumerate(moves):
            progress[i], left[i] = self._line(search, move, float(steps[i]))
        return progress, left

    def _line(self, search: Search, move: Array, step: float) -> tuple[float, float]:
        """Where along ``move`` the best point was found (0: nowhere), and the error of it."""
        origin, best, place = search.x, search.objective, 0.0

        def along(length: float) -> float:
            nonlocal best, place
            value = search.attempt(origin + length * move)
            if value < best:
                best, place = value, float(length)
            return value

        low, high = _bracket(along, best, step, self.expansion)
        error = max(self.line_tolerance * (high - low), self.step_tolerance)
        if high - low > 2.0 * error:
            minimize_scalar(along, bounds=(low, high), method="bounded", options={"xatol": error})
        return place, error


def _bracket(
    along: Callable[[float], float], here: float, step: float, expansion: float
) -> tuple[float, float]:
    """An interval with a minimum inside: the function rises towards both of its ends."""
    value = along(step)
    if not value < here:
        step = -step
        value = along(step)
        if not value < here:
            return step, -step
    before = 0.0
    while True:
        further = along(expansion * step)
        if not further < value:
            return min(before, expansion * step), max(before, expansion * step)
        before, step, value = step, expansion * step, further
