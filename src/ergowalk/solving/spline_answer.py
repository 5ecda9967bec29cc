"""What a solver of the spline programme hands back, and the trace of the penalty as variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.solution.stride import Piece, stride_dataset
from ergowalk.solvers.penalty_answer import PenaltyPoint
from ergowalk.solving.answer import dense_energy
from ergowalk.transcription.spline.programme import SplineProgramme
from ergowalk.transcription.spline.semi_inverse import MEASURES

Array = NDArray[np.float64]

MEASURE_UNITS = dict(zip(MEASURES, ("m s", *3 * ("rad s",), "m s", "N s", "m s"), strict=True))
"""Units of G_0 ... G_6."""


@dataclass(frozen=True)
class SplineAnswer:
    """Unknowns of a programme, with the record of how they were found.

    ``said`` tells how the solver ended; ``settled`` is whether it converged, the check with more
    samples included; ``trace`` is empty where there were no penalties.
    """

    programme: SplineProgramme
    unknowns: Array
    history: list[dict[str, Any]]
    said: str
    settled: bool
    iterations: int
    evaluations: int
    solve_time: float
    build_time: float
    trace: Sequence[PenaltyPoint] = field(default=())


def dense_curves(programme: SplineProgramme, unknowns: Array) -> tuple[xr.Dataset, float]:
    """The stride on a dense grid and its E [J/m]."""
    pieces = [
        Piece(p.time, p.contacts, p.motion, p.sharing)
        for p in programme.pieces(unknowns, programme.problem.stride_time_s / 800)
    ]
    dataset = stride_dataset(programme.problem, [pieces])
    return dataset, dense_energy(dataset, programme.problem.step_length_m)


def record(
    programme: SplineProgramme, energy: float, iterations: int, converged: bool, **flags: bool
) -> dict[str, Any]:
    """One line of the mesh history: the mesh is the grid of samples in the half stride."""
    knots = len(programme.curves.grid) - 1
    return {
        "elements": knots * programme.samples,
        "knots": knots,
        "points": programme.samples,
        "energy_per_metre": energy,
        "iterations": iterations,
        "converged": converged,
        **flags,
    }


def with_measures(dataset: xr.Dataset, answer: SplineAnswer) -> xr.Dataset:
    """The dataset with G_0 ... G_6, their tolerances and, if there is one, the trace of (19)."""
    programme, points = answer.programme, answer.trace
    tolerances, values = programme.tolerances(), programme.value(answer.unknowns)[1]
    units = ", ".join(MEASURE_UNITS.values())

    def about(words: str, unit: str, symbol: str) -> dict[str, str]:
        return {"units": unit, "long_name": words, "symbol": symbol}

    found: dict[str, Any] = {
        "measure_value": ("measure", values, about("measures of (19)", units, "G")),
        "measure_tolerance": ("measure", tolerances, about("counts as zero", units, "-")),
    }
    if points:
        each, one = ("trace_point", "measure"), "trace_point"
        measures = np.stack([p.measures for p in points]) * tolerances
        weights = np.stack([p.weights for p in points])
        count = np.array([p.evaluations for p in points], dtype=np.int64)
        rounds = np.array([p.round for p in points], dtype=np.int32)
        penalised = np.array([p.penalised for p in points])
        energy = np.array([p.objective for p in points])
        found |= {
            "trace_penalised": (one, penalised, about("penalised energy (19)", "J m-1", "Q_1")),
            "trace_energy": (one, energy, about("energy per metre by samples", "J m-1", "Q")),
            "trace_measure": (each, measures, about("measures of (19)", units, "G")),
            "trace_weight": (each, weights, about("weights of (19)", "J m-1", "lambda")),
            "trace_evaluations": (one, count, about("evaluations so far", "1", "-")),
            "trace_round": (one, rounds, about("round of the penalty", "1", "-")),
        }
    return dataset.assign(found).assign_coords(measure=np.array(MEASURES, dtype=object))
