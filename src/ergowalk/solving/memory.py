"""What a collocation leaves in a gait file beside the curves: its point and its multipliers.

With them a stored gait can be priced, or its neighbour found, without solving it again.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.errors import GaitFileError
from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem.design import free_values
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Minimum
from ergowalk.solving.stages import Effort, OrderSearch, StageResult, Start
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.phases import PhaseModel
from ergowalk.transcription.walker import Smoothing

POINT, AT_BOUNDS, AT_ROWS = "nlp_variable", "nlp_variable_multiplier", "nlp_row_multiplier"
MESH = "nlp_mesh"


def remember(dataset: xr.Dataset, search: OrderSearch, result: StageResult) -> xr.Dataset:
    """The dataset with the point (1), its multipliers (1) and its mesh."""
    minimum, units = result.minimum, {"units": "1"}
    parts = {
        POINT: ("nlp_variables", minimum.x, "variables of the nonlinear programme, scaled", "x"),
        AT_BOUNDS: (
            "nlp_variables",
            minimum.variable_multipliers,
            "multipliers of their bounds",
            "lambda_x",
        ),
        AT_ROWS: ("nlp_rows", minimum.row_multipliers, "multipliers of its rows", "lambda_g"),
    }
    variables = {
        name: (dims, values, units | {"long_name": words, "symbol": symbol})
        for name, (dims, values, words, symbol) in parts.items()
    }
    mesh = {
        "points": result.points,
        "fractions": [edges.tolist() for edges in result.collocation.mesh],
        "order": search.name,
        "smoothing": vars(search.walker.smoothing),
        "objective": minimum.objective,
        "signature": result.collocation.signature,
    }
    return dataset.assign(variables).assign_attrs({MESH: json.dumps(mesh)})


def recall(solution: Solution) -> tuple[OrderSearch, StageResult]:
    """The search and the stage that a stored gait came from.

    Raises
    ------
    GaitFileError
        If the gait was not found by collocation, or its file keeps no multipliers.
    """
    mesh = _mesh(solution)
    if mesh is None:
        raise GaitFileError(
            "keeps no multipliers",
            "solve it by collocation with this version, then ask again",
            field=AT_ROWS,
        )
    orders = tuple(PhaseOrder(name) for name in mesh["order"].split(" and "))
    smoothing = Smoothing(**mesh["smoothing"])
    search = OrderSearch(solution.problem, orders, smoothing, Effort(), None)
    stage = _stage(solution, mesh, search)
    if stage is None:
        raise GaitFileError(
            "the multipliers do not belong to the stored problem",
            "solve it again with this version",
            field=AT_ROWS,
            value=len(solution.dataset[AT_ROWS]),
        )
    return search, stage


def recall_for(solution: Solution, search: OrderSearch, points: int) -> StageResult | None:
    """The stage that a stored gait came from, as one of another problem's search.

    None unless that problem has the same unknowns and rows, so that multipliers mean the same.
    """
    mesh = _mesh(solution)
    if mesh is None or mesh["order"] != search.name or mesh["points"] != points:
        return None
    stage = _stage(solution, mesh, search)
    same = stage is not None and stage.collocation.signature == mesh.get("signature")
    return stage if same else None


def recall_twice(solution: Solution, search: OrderSearch, points: int) -> StageResult | None:
    """The stage of a gait whose legs mirror each other, as one of a search for both halves.

    Multipliers come along where a phase has the same rows; None if the gait keeps none, or has
    another order or number of Gauss points.
    """
    mesh = _mesh(solution)
    orders = search.orders
    if mesh is None or mesh["points"] != points or solution.full_stride:
        return None
    if any(mesh["order"] != str(order) for order in orders):
        return None
    try:
        _, half = recall(solution)
    except GaitFileError:
        return None
    if not all(map(_has_unknowns_of, half.collocation.problem.phases * 2, search.phased.phases)):
        return None
    start = Start.twice(half.trajectory, search.problem)
    collocation = Collocation(search.phased, half.collocation.mesh * 2, points, search.store)
    shared = {**free_values(search.problem), **start.shared}
    x = collocation.pack(start.guess, start.times, shared)
    last = half.minimum
    variables, rows = collocation.repeat_multipliers(
        half.collocation, last.variable_multipliers, last.row_multipliers
    )
    minimum = replace(last, x=x, variable_multipliers=variables, row_multipliers=rows)
    return StageResult(collocation, collocation.unpack(x), minimum, half.energy_at_nodes)


def _has_unknowns_of(phase: PhaseModel, other: PhaseModel) -> bool:
    """Whether the curves of a phase tell all unknowns of another."""
    kinds = ("coordinates", "controls", "algebraics")
    here, there = ({x.name for k in kinds for x in getattr(p, k)} for p in (phase, other))
    return here >= there


def _mesh(solution: Solution) -> dict[str, Any] | None:
    """What the file says of the mesh, where point and multipliers are there too."""
    data = solution.dataset
    if MESH not in data.attrs or any(name not in data for name in (POINT, AT_BOUNDS, AT_ROWS)):
        return None
    mesh: dict[str, Any] = json.loads(data.attrs[MESH])
    return mesh


def _stage(solution: Solution, mesh: dict[str, Any], search: OrderSearch) -> StageResult | None:
    """The stored stage in the unknowns of a search; None where their numbers differ."""
    data = solution.dataset
    edges = tuple(np.array(part) for part in mesh["fractions"])
    collocation = Collocation(search.phased, edges, mesh["points"], search.store)
    x, bounds, rows = (data[name].to_numpy() for name in (POINT, AT_BOUNDS, AT_ROWS))
    if len(x) != collocation.layout.size or len(rows) != len(collocation.programme.labels):
        return None
    minimum = Minimum(
        x=x,
        objective=float(mesh["objective"]),
        row_multipliers=rows,
        variable_multipliers=bounds,
        converged=True,
        message=solution.status,
        iterations=int(data.attrs["iterations"]),
        violation=0.0,
        build_time=0.0,
        solve_time=0.0,
    )
    work = minimum.objective * search.walker.reference_mass
    energy = energy_per_metre(work, search.distance)
    return StageResult(collocation, collocation.unpack(x), minimum, energy)
