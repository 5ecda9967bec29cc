"""By collocation: stages, choice of the phase order, check on a finer mesh, audit."""

from __future__ import annotations

import json
from dataclasses import replace

from ergowalk.problem import GaitProblem
from ergowalk.solution import Solution
from ergowalk.solution.progress import Report
from ergowalk.solving.answer import describe, judged, rhythm_of
from ergowalk.solving.candidate import Candidate, Gait
from ergowalk.solving.check import MeshCheck
from ergowalk.solving.design_prices import as_json, found_design
from ergowalk.solving.easing import eased, needs_easing
from ergowalk.solving.impulses import show_impulses
from ergowalk.solving.memory import recall_for, remember
from ergowalk.solving.multipliers import with_fixed_multipliers
from ergowalk.solving.refinement import refine, taken_over
from ergowalk.solving.stages import COARSE, POINTS, Effort, OrderSearch, Start
from ergowalk.solving.start import StartingGait
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.walker import Smoothing

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
    effort, store = Effort(), KernelStore()
    weights = smoothing or (Smoothing() if problem.well_posed else FAINT)
    searches = [
        OrderSearch(problem, order, weights, effort, progress, store)
        for order in problem.rhythm.orders()
    ]
    begun = None if start is None else _begin(searches, start)
    candidates = [begun] if begun else [_searched(s, perturbation) for s in searches]
    best = min(candidates, key=lambda c: (not c.result.minimum.converged, c.result.energy_at_nodes))
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


def _searched(search: OrderSearch, perturbation: Perturbation | None) -> Candidate:
    """The gait of one phase order on few elements."""
    if needs_easing(search.problem):
        return Candidate(search, eased(search, perturbation))
    held = search.fixed_rhythm(search.fit(), perturbation)
    all_held = search.problem.rhythm.fixed and not search.problem.design
    if not held.minimum.converged or all_held:
        return Candidate(search, held)
    return Candidate(search, search.free_rhythm(held, perturbation))


def _begin(searches: list[OrderSearch], start: Solution) -> Candidate | None:
    """The first stage from a solved gait; None where it cannot begin or does not converge.

    A gait that remembers its point and multipliers is continued on its own mesh: what a small
    change of the problem takes. Any other is a guess on the coarse mesh.
    """
    begun = StartingGait(start)
    for search in searches:
        times = begun.times(search.problem)
        if search.order is begun.order and times is not None:
            shared = begun.design(search.problem)
            start_at = Start(begun.guess(search.problem), times, shared)
            before = recall_for(start, search, POINTS)
            if before is not None:
                result = search.continued(before, start_at)
                if result.minimum.converged:
                    return Candidate(search, result, continued=True)
            result = search.started(start_at)
            return Candidate(search, result) if result.minimum.converged else None
    return None


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
    problem = search.solved(gait.candidate.result)
    tried = {
        str(c.search.order): {
            "energy_at_nodes": c.result.energy_at_nodes,
            "converged": c.result.minimum.converged,
        }
        for c in candidates
    }
    extra = {
        "phase_order": str(search.order),
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
        rhythm_of(gait.candidate.result.trajectory, problem.stride_time_s),
        energy=next(e["energy_per_metre"] for e in gait.history if e.get("final")),
        method="collocation",
        status=gait.status,
        history=gait.history,
        extra=extra,
    )
    dataset = remember(dataset, search, gait.candidate.result)
    return judged(dataset, gait.settled, problem.folder)
