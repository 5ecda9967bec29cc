"""By collocation: stages, choice of the phase order, check on a finer mesh, audit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import xarray as xr

from ergowalk.errors import GaitFileError
from ergowalk.problem import GaitProblem
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Solution
from ergowalk.solution.progress import Report
from ergowalk.solving.answer import (
    dense_energy,
    dense_gait,
    describe,
    judged,
    minimised,
    rhythm_of,
)
from ergowalk.solving.easing import eased, needs_easing
from ergowalk.solving.memory import recall, remember
from ergowalk.solving.stages import (
    COARSE,
    POINTS,
    Effort,
    OrderSearch,
    StageResult,
    Start,
)
from ergowalk.solving.start import StartingGait
from ergowalk.solving.verdict import conflict
from ergowalk.solving.verdict import moved as far
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.mesh import cut, finer
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.walker import Smoothing

ROUNDS, MOST_ELEMENTS = 6, 250
"""How often elements are cut whose errors are too large, and how many there may be."""

MESH_TOLERANCE = 0.005
"""E may differ by this share between the reported and the next finer mesh."""

IMPULSIVE_SHARES = (1.0, 0.5)
"""A problem without moment-rate bound or cost is shown on a coarse mesh, on that with this share of
its elements halved, and so on."""


FAINT = Smoothing(moment_rate=1e-7, metatarsal_rate=1e-7)
"""Smoothing of a problem without moment-rate bound: too little to hide that it is impulsive."""


def solve_collocation(
    problem: GaitProblem,
    smoothing: Smoothing | None,
    start: Solution | None,
    progress: Report | None,
    perturbation: Perturbation | None = None,
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
    if not problem.well_posed:
        gait = _show_impulses(best)
    else:
        if begun is None and best.result.minimum.converged:
            best = replace(best, result=best.search.remeshed(best.result, COARSE))
        gait = _refine(best)
    if start is not None and begun is None:
        words = "; the start could not be used, so the search began from the human means"
        gait = replace(gait, status=gait.status + words)
    return _finished(gait, candidates, effort, weights)


@dataclass(frozen=True)
class Candidate:
    """A stage of one phase order."""

    search: OrderSearch
    result: StageResult


@dataclass(frozen=True)
class Gait:
    """The gait to be reported, with the record of its meshes."""

    candidate: Candidate
    dataset: xr.Dataset
    history: list[dict[str, Any]]
    status: str
    settled: bool


def _searched(search: OrderSearch, perturbation: Perturbation | None) -> Candidate:
    """The gait of one phase order on few elements."""
    if needs_easing(search.problem):
        return Candidate(search, eased(search, perturbation))
    held = search.fixed_rhythm(search.fit(), perturbation)
    if not held.minimum.converged or search.problem.rhythm.fixed:
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
            before = _remembered(start, search)
            if before is not None:
                result = search.continued(before, times)
                if result.minimum.converged:
                    return Candidate(search, result)
            result = search.started(Start(begun.guess(search.problem), times))
            return Candidate(search, result) if result.minimum.converged else None
    return None


def _remembered(start: Solution, search: OrderSearch) -> StageResult | None:
    """The stage that a gait came from, if a search can continue from its multipliers."""
    try:
        old, before = recall(start)
    except GaitFileError:
        return None
    same = old.order is search.order and before.points == POINTS and search.fits(before)
    return before if same else None


def _record(result: StageResult, energy: float, **flags: bool) -> dict[str, Any]:
    """One line of the mesh history."""
    return {
        "elements": result.elements,
        "points": result.points,
        "energy_per_metre": energy,
        "iterations": result.minimum.iterations,
        "converged": result.minimum.converged,
        "violation": result.minimum.violation,
        "stationarity": result.minimum.stationarity,
        "strict_minimum": result.minimum.strict,
        "solve_time": result.minimum.solve_time,
        **flags,
    }


def _dense(
    candidate: Candidate, history: list[dict[str, Any]], **flags: bool
) -> tuple[xr.Dataset, float]:
    """Dense curves of a stage and their E [J/m], with a line more in the history."""
    search, result = candidate.search, candidate.result
    dataset = dense_gait(search.walker, search.order, result.trajectory)
    energy = dense_energy(dataset, search.problem.step_length_m)
    history.append(_record(result, energy, **flags))
    if not search.problem.objective.is_eq10:
        history[-1]["objective_per_metre"] = minimised(dataset, search.problem)
    return dataset, energy


def _refine(coarse: Candidate) -> Gait:
    """The reported gait and the check of its mesh.

    Elements are cut until none has too large an error, then until E stands still: if it moves by
    more than :data:`MESH_TOLERANCE` on the mesh of the check, that mesh is the next to be checked.
    """
    search, final = coarse.search, coarse
    history: list[dict[str, Any]] = []
    if not coarse.result.minimum.converged:
        return _failed(coarse, history, "on the coarse mesh")
    residuals = search.residuals(coarse.result)
    for _ in range(ROUNDS):
        if residuals.largest <= 1.0 or final.result.elements > MOST_ELEMENTS:
            break
        energy = energy_per_metre(residuals.work, search.problem.step_length_m)
        history.append(_record(final.result, energy))
        mesh = cut(final.result.collocation.mesh, residuals.errors)
        final = Candidate(search, search.refined(final.result, mesh, residuals.largest))
        if not final.result.minimum.converged:
            return _failed(final, history, f"on {final.result.elements} elements")
        residuals = search.residuals(final.result)
    dataset, reported = _dense(final, history)
    while True:
        mesh = finer(final.result.collocation.mesh, residuals.errors)
        check = Candidate(search, search.refined(final.result, mesh, 1.0))
        checked, confirmed = _dense(check, history)
        change = confirmed / reported - 1
        moved = far(history[-2], history[-1])
        converged = check.result.minimum.converged
        if not converged or moved <= MESH_TOLERANCE:
            break
        if check.result.elements > MOST_ELEMENTS:
            break
        final, dataset, reported = check, checked, confirmed
        residuals = search.residuals(final.result)
    history[-2]["final"], history[-1]["finer"] = True, True
    if not converged:
        status = (
            f"converged on {final.result.elements} elements, but the check on "
            f"{check.result.elements} did not: {check.result.minimum.message}"
        )
        return Gait(final, dataset, history, status, settled=False)
    settled = moved <= MESH_TOLERANCE
    status = (
        f"{'converged' if settled else 'not converged with the mesh'}: "
        f"E = {reported:.2f} J/m on {final.result.elements} elements, "
        f"{100 * change:+.2f} % on {check.result.elements}"
    )
    if not search.problem.objective.is_eq10:
        value = history[-2]["objective_per_metre"]
        change = history[-1]["objective_per_metre"] / value - 1
        status += f"; objective {value:.2f} J/m, {100 * change:+.2f} %"
    return Gait(final, dataset, history, status, settled)


def _show_impulses(coarse: Candidate) -> Gait:
    """Three meshes of a problem whose moments may change without bound.

    There is no optimum to converge to: each finer mesh allows sharper peaks and a lower E.
    """
    search = coarse.search
    history: list[dict[str, Any]] = []
    results = [search.impulsive(coarse.result)]
    for share in IMPULSIVE_SHARES:
        last = results[-1]
        mesh = finer(last.collocation.mesh, search.residuals(last).errors, share)
        results.append(search.impulsive(last, mesh))
    shown = [Candidate(search, result) for result in results if result.minimum.converged]
    if not shown:
        return _failed(Candidate(search, results[-1]), [], f"on {results[-1].elements} elements")
    for current in shown:
        dataset, _ = _dense(current, history)
        history[-1] |= _sharpness(dataset, search)
    history[-1]["final"] = True

    def listed(key: str, form: str) -> str:
        return ", ".join(format(r[key], form) for r in history)

    status = (
        "no smooth minimiser: nothing bounds the rate of the joint moments, so the optimum is "
        f"impulsive; on {listed('elements', 'd')} elements E = "
        f"{listed('energy_per_metre', '.1f')} J/m with moment rates up to "
        f"{listed('peak_moment_rate', '.0f')} N m/(kg s) and reactions up to "
        f"{listed('peak_reaction', '.2f')} body weights"
    )
    return Gait(current, dataset, history, status, settled=False)


def _sharpness(dataset: xr.Dataset, search: OrderSearch) -> dict[str, float]:
    """Largest slope of a hip, knee or ankle moment per kg, and largest vertical reaction."""
    walker = search.walker
    moments = dataset["joint_moment"].to_numpy()[:, :, :3] / walker.mass
    time = dataset["time"].to_numpy()
    step = time[1:] - time[:-1]
    slopes = abs(moments[1:] - moments[:-1])[step > 0] / step[step > 0][:, None, None]
    weight = walker.mass * walker.gravity
    reaction = dataset["ground_reaction_force"].sel(axis="y").to_numpy()
    return {
        "peak_moment_rate": float(slopes.max()),
        "peak_reaction": float(reaction.max() / weight),
    }


def _failed(candidate: Candidate, history: list[dict[str, Any]], where: str) -> Gait:
    dataset, _ = _dense(candidate, history, final=True)
    status = (
        f"not converged {where}: {candidate.result.minimum.message}{conflict(candidate.result)}"
    )
    return Gait(candidate, dataset, history, status, settled=False)


def _finished(
    gait: Gait, candidates: list[Candidate], effort: Effort, smoothing: Smoothing
) -> Solution:
    """Attributes, audit, and the verdict."""
    search = gait.candidate.search
    problem = search.problem
    tried = {
        str(c.search.order): {
            "energy_at_nodes": c.result.energy_at_nodes,
            "converged": c.result.minimum.converged,
        }
        for c in candidates
    }
    extra = {
        "phase_order": str(search.order),
        "phase_orders_tried": _json(tried),
        "smoothing": _json(vars(smoothing)),
        "iterations": effort.iterations,
        "solve_time": effort.solve_time,
        "build_time": effort.build_time,
        # apart from the rest of the history: the same solve twice differs in its clocks alone
        "mesh_times": _json([record.pop("solve_time") for record in gait.history]),
    }
    dataset = describe(
        gait.dataset,
        problem,
        rhythm_of(gait.candidate.result.trajectory, problem.stride_time_s),
        method="collocation",
        status=gait.status,
        history=gait.history,
        extra=extra,
    )
    dataset = remember(dataset, search, gait.candidate.result)
    return judged(dataset, gait.settled, problem.folder)


def _json(value: object) -> str:
    import json

    return json.dumps(value)
