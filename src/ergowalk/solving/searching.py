"""How a search begins: from the human means, or from the gait of legs that are equal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ergowalk.problem import GaitProblem
from ergowalk.solving.candidate import Candidate
from ergowalk.solving.easing import eased, needs_easing
from ergowalk.solving.stages import OrderSearch, Start
from ergowalk.transcription.curves import Samples, Trajectory
from ergowalk.transcription.halves import Orders, times_twice
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.steps import STEP_1

Array = NDArray[np.float64]


class Search(Protocol):
    """The search for the gait of a problem in the orders of its halves.

    Searches of one problem may share a store of kernels.
    """

    def __call__(
        self, problem: GaitProblem, orders: Orders, store: KernelStore | None = None
    ) -> OrderSearch:
        """Of a problem with one half or two."""
        ...


def in_all_orders(
    search: Search, problem: GaitProblem, perturbation: Perturbation | None
) -> list[Candidate]:
    """The gait of mirrored legs in each phase order on few elements, from the human means."""
    store = KernelStore()
    searches = [search(problem, (order,), store) for order in problem.rhythm.orders()]
    return [_from_human_means(s, perturbation) for s in searches]


def best_of(candidates: Sequence[Candidate]) -> Candidate:
    """The cheapest of those that have converged."""
    return min(candidates, key=lambda c: (not c.result.minimum.converged, c.result.energy_at_nodes))


def _from_human_means(search: OrderSearch, perturbation: Perturbation | None) -> Candidate:
    if needs_easing(search.problem):
        return Candidate(search, eased(search, perturbation))
    held = search.fixed_rhythm(search.fit(), perturbation)
    if not held.minimum.converged or search.problem.rhythm.fixed:
        return Candidate(search, held)
    return Candidate(search, search.free_rhythm(held, perturbation))


def from_mirrored(
    search: Search, problem: GaitProblem, perturbation: Perturbation | None
) -> Candidate:
    """The gait of legs that differ, by continuation from that of legs that are equal."""
    best = best_of(in_all_orders(search, problem.mirrored(), perturbation))
    both = search(problem, best.search.orders * 2)
    start = twice(best.result.trajectory, problem)
    result = both.stage("legs apart", best.result.collocation.mesh * 2, start)
    return Candidate(both, result)


def twice(trajectory: Trajectory, problem: GaitProblem) -> Start:
    """The gait of legs that mirror each other as the start of both halves of a stride."""
    curves, count = trajectory.as_guess(), len(trajectory.phases)

    def guess(i: int, fractions: Array) -> Samples:
        return curves(i % count, fractions)

    return Start(guess, times_twice(trajectory.times), {STEP_1: problem.step_length_m})
