"""What a search along rotating directions records on its way, and its answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stage:
    """Where the search stands at the end of a stage; stage 0 is the start.

    ``longest_step`` is the largest step that the next stage begins with, as a part of the
    starting steps; ``seconds`` are CPU seconds since the start of the search.
    """

    number: int
    evaluations: int
    x: Array
    objective: float
    longest_step: float
    seconds: float


Monitor = Callable[[Stage], object]


@dataclass(frozen=True)
class DescentTrace:
    """The stages of a search as arrays of one length, the start first; see :class:`Stage`."""

    evaluations: NDArray[np.int64]
    objective: Array
    longest_step: Array
    seconds: Array

    @classmethod
    def of(cls, stages: Sequence[Stage]) -> DescentTrace:
        """The stages, column by column."""
        return cls(*(np.array([getattr(s, column.name) for s in stages]) for column in fields(cls)))


@dataclass(frozen=True)
class Descent:
    """Where the search stopped, and what it says of it.

    Attributes
    ----------
    x : (n,) array
        The best point seen; the start if no other was better.
    evaluations, stages, rotations, restarts : int
    converged : bool
        A stage brought too little and a restart from the axes did not help, or the target was
        reached; not so if a limit stopped the search.
    message : str
        A sentence.
    solve_time : float
        CPU seconds.
    """

    x: Array
    objective: float
    evaluations: int
    stages: int
    rotations: int
    restarts: int
    converged: bool
    message: str
    solve_time: float
    trace: DescentTrace
