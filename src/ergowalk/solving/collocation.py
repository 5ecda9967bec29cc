"""By collocation: stages, choice of the phase order, check on a finer mesh, audit."""

from __future__ import annotations

import json
from dataclasses import replace

from ergowalk.problem import GaitProblem
from ergowalk.solution import Solution
from ergowalk.solution.progress import Report
from ergowalk.solving.answer import describe, judged, rhythms_of, step_lengths
from ergowalk.solving.candidate import Candidate, Gait
from ergowalk.solving.check import MeshCheck
from ergowalk.solving.design_prices import as_json, found_design
from ergowalk.solving.impulses import show_impulses
from ergowalk.solving.memory import recall_for, recall_twice, remember
from ergowalk.solving.multipliers import with_fixed_multipliers
from ergowalk.solving.refinement import refine, taken_over
from ergowalk.solving.searching import Search, best_of, from_mirrored, in_all_orders
from ergowalk.solving.stages import COARSE, POINTS, Effort, OrderSearch, Start
from ergowalk.solving.start import StartingGait
from ergowalk.transcription.halves import Orders
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.walker import Smoothing

NEAR = 1e-6
"""Barrier from which a gait with almost the same steps is continued."""

APART = 1e-5
"""Barrier from which legs that were equal are set apart."""

FAR = 1e-5
"""Barrier from which a gait with other steps is continued: on their bounds the curves would only
creep along."""

FAINT = Smoothing(moment_rate=1e-7, metatarsal_rate=1e-7)
"""Smoothing of a problem without moment-rate bound: too little to hide that it is impulsive."""


def solve_collocation(
    problem: GaitProblem,
    smoothing: Smoothing | None,
    start: Solution | None,
    progress: Report | None,
    perturbation: Perturbation | None = None,
    recheck: bool = False,
) -> Solution:
    """The cheapest gait of all phase orders that the problem allows; see :func:`~.verb.solve`."""
    effort = Effort()
    weights = smoothing or (Smoothing() if problem.well_posed else FAINT)

    def search(
        problem: GaitProblem, orders: Orders, store: KernelStore | None = None
    ) -> OrderSearch:
        return OrderSearch(problem, orders, weights, effort, progress, store)

    begun = None if start is None else _begin(search, problem, start)
    if begun:
        candidates = [begun]
    elif problem.full_stride:
        candidates = [from_mirrored(search, problem, perturbation)]
    else:
        candidates = in_all_orders(search, problem, perturbation)
    best = best_of(candidates)
    check = None if recheck or start is None else check_of(start, best)
    neighbour = taken_over(best, check, [])
    if neighbour is not None:
        found = _finished(neighbour, candidates, effort, weights)
        if found.acceptable:
            return found
    if not problem.well_posed:
        gait = show_impulses(best)
    else:
        if begun is None and best.result.minimum.converged:
            best = replace(best, result=best.search.remeshed(best.result, COARSE))
        gait = refine(best, check)
    if start is not None and begun is None:
        words = "; the start could not be used, so the search began from the human means"
        gait = replace(gait, status=gait.status + words)
    return _finished(gait, candidates, effort, weights)


def _begin(search: Search, problem: GaitProblem, start: Solution) -> Candidate | None:
    """The first stage from a solved gait; None where it cannot begin or does not converge.

    A gait that remembers its point and multipliers is continued on its own mesh: what a small
    change of the problem takes. Any other is a guess on the coarse mesh.
    """
    begun = StartingGait(start)
    orders = begun.orders(problem)
    if orders is None:
        return None
    here = search(problem, orders)
    times = begun.times(problem, here.halves)
    if times is None:
        return None
    start_at = Start(begun.guess(problem, here.halves), times, begun.shared(problem))
    before = recall_for(start, here, POINTS)
    if before is not None:
        barrier = NEAR if begun.has_steps_of(problem) else FAR
        result = here.continued(before, start_at, barrier)
        if result.minimum.converged:
            return Candidate(here, result, continued=True)
    before = recall_twice(start, here, POINTS) if problem.full_stride else None
    if before is not None:
        result = here.continued(before, start_at, APART)
        if result.minimum.converged:
            return Candidate(here, result)
    result = here.started(start_at)
    return Candidate(here, result) if result.minimum.converged else None


def check_of(start: Solution, found: Candidate) -> MeshCheck | None:
    """The check that a gait continued from another may take over."""
    problem = found.search.problem
    same = found.continued and start.problem.objective == problem.objective
    return MeshCheck.of(start) if same and problem.well_posed else None


def _finished(
    gait: Gait, candidates: list[Candidate], effort: Effort, smoothing: Smoothing
) -> Solution:
    """Attributes, audit, and the verdict."""
    search = gait.candidate.search
    problem, curves = search.solved(gait.candidate.result), gait.candidate.result.trajectory
    tried = {
        c.search.name: {
            "energy_at_nodes": c.result.energy_at_nodes,
            "converged": c.result.minimum.converged,
        }
        for c in candidates
    }
    extra = {
        "phase_order": search.name,
        "phase_orders_tried": json.dumps(tried),
        "smoothing": json.dumps(vars(smoothing)),
        "iterations": effort.iterations,
        "solve_time": effort.solve_time,
        "build_time": effort.build_time,
        # apart from the rest of the history: the same solve twice differs in its clocks alone
        "mesh_times": json.dumps([record.pop("solve_time", 0.0) for record in gait.history]),
    }
    if problem.design:
        minimum = with_fixed_multipliers(gait.candidate.result)
        extra["design"] = as_json(found_design(search, gait.candidate.result, minimum))
    dataset = describe(
        gait.dataset,
        problem,
        rhythms_of(search.halves, curves, problem.stride_time_s),
        step_lengths=step_lengths(problem, curves),
        energy=next(e["energy_per_metre"] for e in gait.history if e.get("final")),
        method="collocation",
        status=gait.status,
        history=gait.history,
        extra=extra,
    )
    dataset = remember(dataset, search, gait.candidate.result)
    return judged(dataset, gait.settled, problem.folder)
