"""What the penalty method records on its way, and its answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PenaltyPoint:
    """One recorded point: the start of a round, an inner stage or the end of a round.

    ``measures`` and ``weights`` have one entry per block; ``evaluations`` and CPU ``seconds``
    count from the start of the first round.
    """

    round: int
    ends_round: bool
    evaluations: int
    seconds: float
    x: Array
    penalised: float
    objective: float
    measures: Array
    weights: Array


Monitor = Callable[[PenaltyPoint], object]


@dataclass(frozen=True)
class PenaltyTrace:
    """All recorded points as plain arrays: (m,) each, (m, L) measures and weights.

    See :class:`PenaltyPoint`; the points themselves are left out.
    """

    names: tuple[str, ...]
    round: NDArray[np.int64]
    ends_round: NDArray[np.bool_]
    evaluations: NDArray[np.int64]
    seconds: Array
    penalised: Array
    objective: Array
    measures: Array
    weights: Array

    @classmethod
    def of(cls, names: tuple[str, ...], points: Sequence[PenaltyPoint]) -> PenaltyTrace:
        """The recorded points, column by column."""
        columns = (f.name for f in fields(cls) if f.name != "names")
        return cls(names, *(np.array([getattr(p, name) for p in points]) for name in columns))


@dataclass(frozen=True)
class PenaltyMinimum:
    """Where the penalty method stopped, and what it says of it.

    Attributes
    ----------
    x : (n,) array
        The accepted end of a round with the least objective; if none was, the last point.
    objective : float
        Q there, without penalties.
    measures, weights : dict
        G_l there and lambda_l of that round, by block.
    accepted : bool
        Every measure is within its tolerance.
    converged : bool
        Accepted, and the inner method had converged.
    message : str
        A sentence.
    evaluations, rounds : int
    solve_time : float
        CPU seconds.
    """

    x: Array
    objective: float
    measures: dict[str, float]
    weights: dict[str, float]
    accepted: bool
    converged: bool
    message: str
    evaluations: int
    rounds: int
    solve_time: float
    trace: PenaltyTrace
