"""A stage of one phase order, and the gait that becomes of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import xarray as xr

from ergowalk.solving.answer import dense_energy, dense_gait, minimised
from ergowalk.solving.stages import OrderSearch, StageResult
from ergowalk.solving.verdict import conflict


@dataclass(frozen=True)
class Candidate:
    """A stage of one phase order; whether it continued that of a neighbour on the same mesh."""

    search: OrderSearch
    result: StageResult
    continued: bool = False


@dataclass(frozen=True)
class Gait:
    """The gait to be reported, with the record of its meshes."""

    candidate: Candidate
    dataset: xr.Dataset
    history: list[dict[str, Any]]
    status: str
    settled: bool


def record(result: StageResult, energy: float, **flags: bool) -> dict[str, Any]:
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


def dense(
    candidate: Candidate, history: list[dict[str, Any]], **flags: bool
) -> tuple[xr.Dataset, float]:
    """Dense curves of a stage and their E [J/m], with a line more in the history."""
    search, result = candidate.search, candidate.result
    problem = search.solved(result)
    dataset = dense_gait(problem, search.halves, result.trajectory)
    energy = dense_energy(dataset, search.problem.step_length_m)
    history.append(record(result, energy, **flags))
    if not search.problem.objective.is_eq10:
        history[-1]["objective_per_metre"] = minimised(dataset, problem)
    return dataset, energy


def failed(candidate: Candidate, history: list[dict[str, Any]], where: str) -> Gait:
    """What is shown of a search that did not converge, and which constraints are in conflict."""
    dataset, _ = dense(candidate, history, final=True)
    status = (
        f"not converged {where}: {candidate.result.minimum.message}{conflict(candidate.result)}"
    )
    return Gait(candidate, dataset, history, status, settled=False)
