"""What a collocation leaves in a gait file beside the curves: its point and its multipliers.

With them a stored gait can be priced, or its neighbour found, without solving it again.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.errors import GaitFileError
from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Minimum
from ergowalk.solving.stages import Effort, OrderSearch, StageResult
from ergowalk.transcription.collocation import Collocation
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
        "order": str(search.order),
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
    order, smoothing = PhaseOrder(mesh["order"]), Smoothing(**mesh["smoothing"])
    search = OrderSearch(solution.problem, order, smoothing, Effort(), None)
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
    if mesh is None or mesh["order"] != str(search.order) or mesh["points"] != points:
        return None
    stage = _stage(solution, mesh, search)
    same = stage is not None and stage.collocation.signature == mesh.get("signature")
    return stage if same else None


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
    problem = solution.problem
    work = minimum.objective * search.walker.reference_mass
    energy = energy_per_metre(work, problem.step_length_m)
    return StageResult(collocation, collocation.unpack(x), minimum, energy)
