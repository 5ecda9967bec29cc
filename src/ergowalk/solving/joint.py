"""Several programmes that have some unknowns in common, as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ergowalk.nlp import Block, Kernel, NonlinearProgramme
from ergowalk.solvers.ipopt import Minimum

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """One of the programmes, a minimum of it, and its place in the whole.

    Attributes
    ----------
    weight : float
        What its objective is multiplied with.
    common : (n_c,) integers
        Its variables that all parts have in common, in the same order and scale for each.
    """

    programme: NonlinearProgramme
    minimum: Minimum
    weight: float
    common: NDArray[np.int64]


@dataclass(frozen=True)
class Joint:
    """The weighted sum of all parts; their common variables come first."""

    programme: NonlinearProgramme
    start: Array
    multipliers: tuple[Array, Array]


def joined(parts: Sequence[Part]) -> Joint:
    """One programme of several, begun at their minima; the common variables are averaged.

    Raises
    ------
    ValueError
        If the common variables have no room in common.
    """
    count = len(parts[0].common)
    lower = np.max([part.programme.lower[part.common] for part in parts], axis=0)
    upper = np.min([part.programme.upper[part.common] for part in parts], axis=0)
    if np.any(lower > upper):
        raise ValueError("no common room")
    weights = np.array([part.weight for part in parts])
    values = np.array([part.minimum.x[part.common] for part in parts])
    bounds, x, pressing = [(lower, upper)], [weights @ values / weights.sum()], [np.zeros(count)]
    blocks: list[Block] = []
    first = count
    for part in parts:
        own = np.ones(part.programme.size, dtype=bool)
        own[part.common] = False
        place = np.empty(part.programme.size, dtype=np.int64)
        place[part.common] = np.arange(count)
        place[own] = first + np.arange(own.sum())
        first += int(own.sum())
        bounds.append((part.programme.lower[own], part.programme.upper[own]))
        x.append(part.minimum.x[own])
        pressing.append(part.weight * part.minimum.variable_multipliers[own])
        blocks += [_placed(block, place, part.weight) for block in part.programme.blocks]
    rows = np.concatenate([part.weight * part.minimum.row_multipliers for part in parts])
    low, high = (np.concatenate([b[k] for b in bounds]) for k in (0, 1))
    programme = NonlinearProgramme(low, high, blocks)
    return Joint(programme, np.concatenate(x), (np.concatenate(pressing), rows))


def _placed(block: Block, place: NDArray[np.int64], weight: float) -> Block:
    """A block in the variables of the whole, its cost weighted."""
    kernel: Kernel = replace(block.kernel, cost=weight * block.kernel.cost)
    return replace(block, kernel=kernel, indices=place[block.indices])
