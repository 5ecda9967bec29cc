"""How a search begins: from the human means, or from the gait of legs that are equal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ergowalk.problem import Design, GaitProblem
from ergowalk.problem.constraints import SHORTEST_PHASE
from ergowalk.solving.candidate import Candidate
from ergowalk.solving.easing import eased, needs_easing, without_devices
from ergowalk.solving.stages import OrderSearch, StageResult, Start
from ergowalk.transcription.curves import Samples
from ergowalk.transcription.halves import Orders
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.perturbation import Perturbation

Array = NDArray[np.float64]


AT_ITS_LIMIT = 1.2
"""A phase is at its limit if it lasts no longer than so many times the shortest allowed."""


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
        bare = without_devices(search)
        return Candidate(search, eased(search, bare, bare.fixed_rhythm(bare.fit(), perturbation)))
    held = search.fixed_rhythm(search.fit(), perturbation)
    all_held = search.problem.rhythm.fixed and not search.problem.design
    if not held.minimum.converged or all_held:
        return Candidate(search, held)
    return Candidate(search, search.free_rhythm(held, perturbation))


SHARES = (0.25, 0.5, 0.75, 1.0)
"""Shares of the difference between the legs, one search after the other, where all of it at once
is too much."""


def from_mirrored(
    search: Search, problem: GaitProblem, perturbation: Perturbation | None
) -> Candidate:
    """The gait of legs that differ, by continuation from that of legs that are equal.

    Bodies and bounds are set apart first, at once or step by step, then devices of one leg are
    fitted.
    """
    equal = problem.mirrored()
    candidates = in_all_orders(search, equal, perturbation)
    best = best_of(candidates)
    orders, mesh = best.search.orders * 2, best.result.collocation.mesh * 2
    fitted_later = needs_easing(problem)
    first = _with_common_devices(problem) if fitted_later else problem
    begun = search(first, orders)
    result = begun.stage("legs apart", mesh, Start.twice(best.result.trajectory, problem))
    if not result.minimum.converged and not problem.body.legs_equal:
        begun, result = _step_by_step(search, first, best, orders)
    for half in (0, 1):
        begun, result = _other_order(search, begun, result, candidates, half)
    if not fitted_later or not result.minimum.converged:
        return Candidate(begun, result)
    whole = search(problem, begun.orders)
    return Candidate(whole, eased(whole, begun, result))


def _with_common_devices(problem: GaitProblem) -> GaitProblem:
    """The problem without the devices of one leg, whose numbers no design can free then.

    Each leg keeps a rhythm of its own.
    """
    found: GaitProblem = problem.replace(
        devices=problem.mirrored().devices,
        stride=problem.stride.replace(legs="each"),
        design=Design(),
    )
    return found


def _other_order(
    search: Search,
    here: OrderSearch,
    result: StageResult,
    mirrored: Sequence[Candidate],
    half: int,
) -> tuple[OrderSearch, StageResult]:
    """The cheaper order of the phases of one half, where the present one is at its limit.

    That half begins anew with the gait of mirrored legs in the other order.
    """
    problem, order = here.problem, here.orders[half]
    times = here.halves[half].times(result.trajectory.times)
    early, late = sorted((times["heel_end"], times["other_toe_off"]))
    room = SHORTEST_PHASE * problem.stride_time_s
    others = [c for c in mirrored if c.search.order is not order and c.result.minimum.converged]
    if not result.minimum.converged or late - early > AT_ITS_LIMIT * room or not others:
        return here, result
    other = others[0].result
    count, own = len(other.trajectory.phases), result.trajectory.as_guess()
    curves, tag = other.trajectory.as_guess(), here.halves[half].tag
    inner = {n + tag: t for n, t in other.trajectory.times.items() if n != "half_stride"}
    mesh = tuple(
        other.collocation.mesh[i % count] if i // count == half else edges
        for i, edges in enumerate(result.collocation.mesh)
    )

    def guess(i: int, fractions: Array) -> Samples:
        return curves(i % count, fractions) if i // count == half else own(i, fractions)

    start = Start(guess, {**result.trajectory.times, **inner}, result.trajectory.shared)
    orders = tuple(others[0].search.order if i == half else o for i, o in enumerate(here.orders))
    there = search(problem, orders)
    exchanged = there.stage("other order", mesh, start)
    cheaper = exchanged.energy_at_nodes < result.energy_at_nodes
    return (there, exchanged) if exchanged.minimum.converged and cheaper else (here, result)


def _step_by_step(
    search: Search, problem: GaitProblem, best: Candidate, orders: Orders
) -> tuple[OrderSearch, StageResult]:
    """Bodies set apart by one share after the other; the last is the problem itself."""
    start, before = Start.twice(best.result.trajectory, problem), None
    mesh = best.result.collocation.mesh * 2
    for share in SHARES:
        nearer = {"body": problem.body.mirrored(share), "design": Design()}
        here = search(problem.replace(**nearer) if share < 1 else problem, orders)
        result = here.stage(f"legs apart by {share:g}", mesh, start, before=before)
        if not result.minimum.converged:
            break
        start, before = Start.at(result.trajectory), result
    return here, result
