"""What a collocation leaves in a gait file beside the curves: its point and its multipliers.

With them a stored gait can be priced, or continued, without solving it again.
"""

from __future__ import annotations

import json

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
    }
    return dataset.assign(variables).assign_attrs({MESH: json.dumps(mesh)})


def recall(solution: Solution) -> tuple[OrderSearch, StageResult]:
    """The search and the stage that a stored gait came from.

    Raises
    ------
    GaitFileError
        If the gait was not found by collocation, or its file keeps no multipliers.
    """
    data = solution.dataset
    if MESH not in data.attrs or any(name not in data for name in (POINT, AT_BOUNDS, AT_ROWS)):
        raise GaitFileError(
            "keeps no multipliers",
            "solve it by collocation with this version, then ask again",
            field=AT_ROWS,
        )
    mesh = json.loads(data.attrs[MESH])
    order, smoothing = PhaseOrder(mesh["order"]), Smoothing(**mesh["smoothing"])
    search = OrderSearch(solution.problem, order, smoothing, Effort(), None)
    edges = tuple(np.array(part) for part in mesh["fractions"])
    collocation = Collocation(search.phased, edges, mesh["points"], search.store)
    x, bounds, rows = (data[name].to_numpy() for name in (POINT, AT_BOUNDS, AT_ROWS))
    if len(x) != collocation.layout.size or len(rows) != len(collocation.programme.labels):
        raise GaitFileError(
            "the multipliers do not belong to the stored problem",
            "solve it again with this version",
            field=AT_ROWS,
            value=len(rows),
        )
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
    energy = energy_per_metre(minimum.objective * search.walker.mass, search.problem.step_length_m)
    return search, StageResult(collocation, collocation.unpack(x), minimum, energy)
