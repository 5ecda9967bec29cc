"""What both forms of Rosenbrock's method share: counting, limits, stages, rotations, restarts."""

from __future__ import annotations

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import InputError
from ergowalk.solvers.descent_answer import Descent, DescentTrace, Monitor, Stage
from ergowalk.solvers.rotation import Rotation, rotate

Array = NDArray[np.float64]
Function = Callable[[Array], float]


@dataclass(frozen=True, kw_only=True)
class RotatingDirections(ABC):
    """Search along orthonormal directions that are rotated after each stage.

    Lengths are counted in starting steps: the search runs in x / steps, so that variables of
    different units are treated alike and the same problem in other units takes the same path.

    Attributes
    ----------
    step : float
        Starting step of every variable if ``minimise`` is given none.
    step_tolerance : float
        Step below which nothing is looked for, as a part of the starting steps. Near a smooth
        minimum a function cannot tell steps below sqrt(1e-16) apart.
    progress_tolerance : float
        A stage that lowers the function by less, relative to its value, brings too little.
    restarts : int
        How often the directions may go back to the axes, and the steps to the starting steps,
        after a stage that brings too little. One tells a minimum from directions that have
        collapsed; at kinks more help now and then. The search ends at once where the first
        stage after a restart brings too little, so that unused restarts cost nothing.
    reset_steps : bool
        Begin each stage with the starting steps, as in the textbook. Otherwise a stage begins
        with half the length of the progress that the last one made in the space of the
        direction and those after it: with discrete steps that takes a third to two thirds of
        the evaluations, on the classical functions of the tests and on ill-conditioned
        quadratics of 20 and 60 variables.
    max_evaluations : int
    max_seconds : float, optional
        CPU seconds of the process.
    """

    step: float = 0.1
    step_tolerance: float = 1e-8
    progress_tolerance: float = 1e-10
    restarts: int = 3
    reset_steps: bool = False
    max_evaluations: int = 100_000
    max_seconds: float | None = None

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            lowest = _LOWEST.get(item.name, 0.0)
            if value is None:
                continue
            if item.name in _PARTS and not 0.0 < value < 1.0:
                rule, remedy = "must lie above 0 and below 1", "give such a number"
                raise InputError(rule, remedy, field=item.name, value=value)
            if not (math.isfinite(value) and value >= lowest):
                rule = f"must be a finite number from {lowest:g} up"
                raise InputError(rule, "give such a number", field=item.name, value=value)

    def minimise(
        self,
        function: Function,
        start: Array,
        steps: float | Array | None = None,
        monitor: Monitor | None = None,
        target: float = -math.inf,
    ) -> Descent:
        """Minimise from ``start`` without derivatives; failing to converge is an answer.

        Parameters
        ----------
        function : (n,) array -> float
            Called with an array of its own each time, which it may keep and must not change.
            A value that is no finite number counts as a failure; NumPy's warnings of overflow
            and of invalid operations are silent.
        start : (n,) array
        steps : float or (n,) array, optional
            Starting steps, positive: the scale of each variable.
        monitor : callable, optional
            Given the :class:`Stage` after the start and after each stage.
        target : float
            Stop at a value not above this one.

        Raises
        ------
        InputError
            If start or steps cannot be used.
        Exception
            Whatever ``function`` and ``monitor`` raise, KeyboardInterrupt too.
        """
        x = finite_vector(start)
        search = Search(function, x, _scale(self.step if steps is None else steps, len(x)), self)
        search.target = target
        run = _Run(self, search, monitor)
        try:
            with np.errstate(over="ignore", invalid="ignore"):  # counted as failures instead
                converged, message = run.to_the_end()
        except Stopped as stop:
            converged, message = stop.converged, str(stop)
        if math.isinf(search.objective):
            converged, message = False, "the function has no finite value near the start"
        run.record(final=True)
        return Descent(
            x=search.x,
            objective=search.objective,
            evaluations=search.evaluations,
            stages=run.stages,
            rotations=run.rotations,
            restarts=run.restarts,
            converged=converged,
            message=message,
            solve_time=search.seconds,
            trace=DescentTrace.of(run.rows),
        )

    @abstractmethod
    def _stage(self, search: Search, moves: Array, steps: Array) -> tuple[Array, Array]:
        """One stage along the rows of ``moves``, from ``steps``.

        Returns the progress along each, and the step at which each has been left, both as
        multiples of the rows.
        """


_LOWEST = {"step": 1e-300, "step_tolerance": 1e-15, "max_evaluations": 1, "expansion": 1.01}
_PARTS = ("contraction", "line_tolerance")


class Stopped(Exception):
    """Raised inside a search to end it, with the sentence that tells why."""

    def __init__(self, message: str, converged: bool = False) -> None:
        super().__init__(message)
        self.converged = converged


class Search:
    """The best point so far, and the count of what it has cost."""

    def __init__(
        self, function: Function, start: Array, scale: Array, options: RotatingDirections
    ) -> None:
        self.function, self.scale = function, scale
        self.x, self.objective = start, math.inf
        self.evaluations, self.limit = 0, options.max_evaluations
        self.target = -math.inf
        self.began = time.process_time()
        self.deadline: float | None = None

    @property
    def seconds(self) -> float:
        """CPU seconds since the start."""
        return time.process_time() - self.began

    def attempt(self, x: Array) -> float:
        """The value at x, infinite if it is no finite number; x is kept if it is the best."""
        if self.evaluations >= self.limit:
            raise Stopped("ran out of evaluations")
        if self.deadline is not None and time.process_time() > self.deadline:
            raise Stopped("ran out of CPU seconds")
        self.evaluations += 1
        value = float(self.function(x))
        if not math.isfinite(value):
            return math.inf
        if value < self.objective:
            self.x, self.objective = x, value
            if value <= self.target:
                raise Stopped("reached the target", converged=True)
        return value


@dataclass
class _Run:
    """Stages, rotations and restarts of one search."""

    options: RotatingDirections
    search: Search
    monitor: Monitor | None
    stages: int = 0
    rotations: int = 0
    restarts: int = 0
    rows: list[Stage] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.directions = np.eye(len(self.search.x))
        self.steps = np.ones(len(self.search.x))

    def to_the_end(self) -> tuple[bool, str]:
        search = self.search
        search.attempt(search.x)  # made whatever the limit of time
        if self.options.max_seconds is not None:
            search.deadline = search.began + self.options.max_seconds
        self.record()
        fresh = True
        while True:
            before = search.objective
            progress, left = self.options._stage(search, self.directions * search.scale, self.steps)
            self.stages += 1
            if self._brought_enough(before, progress):
                self._rotate(progress, left)
                fresh = False
            elif fresh or self.restarts >= self.options.restarts:
                return True, "converged: a stage brought less than the tolerances"
            else:
                self.__post_init__()
                self.restarts += 1
                fresh = True
            self.record()

    def _brought_enough(self, before: float, progress: Array) -> bool:
        """False also where no value has been finite yet."""
        after, options = self.search.objective, self.options
        fallen = before - after > options.progress_tolerance * abs(after)
        return fallen and float(np.linalg.norm(progress)) > options.step_tolerance

    def _rotate(self, progress: Array, left: Array) -> None:
        rotation = rotate(self.directions, progress)
        self.directions = rotation.directions
        self.rotations += 1
        if not self.options.reset_steps:
            self.steps = _next_steps(rotation, left, self.options.step_tolerance)

    def record(self, final: bool = False) -> None:
        """Notes the present point; at the end only if the search has moved on since."""
        search = self.search
        if final and self.rows and self.rows[-1].evaluations == search.evaluations:
            return
        longest = float(np.max(self.steps))
        row = Stage(
            self.stages, search.evaluations, search.x, search.objective, longest, search.seconds
        )
        self.rows.append(row)
        if self.monitor is not None and not final:
            self.monitor(row)


def _next_steps(rotation: Rotation, left: Array, tolerance: float) -> Array:
    """Half the progress; where there was none, the step at which the search left off."""
    least = np.maximum(np.abs(left[rotation.order]), 4.0 * tolerance)
    return np.where(
        rotation.lengths > 0.0, np.maximum(0.5 * rotation.lengths, 4 * tolerance), least
    )


def finite_vector(start: Array) -> Array:
    """A copy of the start, refused unless it is a vector of finite numbers."""
    x = np.array(start, dtype=float)
    if x.ndim != 1 or len(x) == 0 or not np.all(np.isfinite(x)):
        raise InputError(
            "must be a non-empty vector of finite numbers", "give a start", field="start", value=x
        )
    return x


def _scale(steps: float | Array, n: int) -> Array:
    scale = np.asarray(steps, dtype=float)
    if scale.shape not in ((), (n,)) or not np.all(np.isfinite(scale) & (scale > 0.0)):
        raise InputError(
            f"must be one positive number or {n} of them",
            "give the starting step of each variable",
            field="steps",
            value=scale,
        )
    return np.broadcast_to(scale, (n,)).copy()
