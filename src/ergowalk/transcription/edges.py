"""Edges of the corridors (6) as given functions of time, for the kernels of the collocation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.corridors import Corridor
from ergowalk.transcription.phases import TimeCurves

Array = NDArray[np.float64]

BAND = ("middle", "half width")
"""What is asked of a corridor."""


def corridor_edges(corridors: Mapping[str, Corridor], stride: float) -> TimeCurves:
    """Middle and half width [rad] of the corridors of both legs over a stride of so many seconds.

    They are called "hip_1 middle", "hip_1 half width", and so on; leg 2 is half a stride later.
    """
    names, table = [], []
    for joint, corridor in corridors.items():
        for edge, curve, width in zip(
            BAND, (corridor.mean, corridor.sd), (1.0, corridor.width), strict=True
        ):
            for leg in (1, 2):
                names.append(f"{joint}_{leg} {edge}")
                table.append(width * curve.coefficients(0.5 * (leg - 1)))
    return fourier(tuple(names), np.array(table), stride)


def fourier(names: tuple[str, ...], table: Array, period: float) -> TimeCurves:
    """Curves from their cosine, then sine coefficients, (n, 2 degree + 2)."""
    rate = 2 * np.pi / period * np.arange(table.shape[1] // 2)
    tables = [table]
    for _ in range(2):  # (a cos + b sin)' = k (b cos - a sin)
        a, b = np.split(tables[-1], 2, axis=1)
        tables.append(np.concatenate([rate * b, -rate * a], axis=1))
    stacked, column = ca.DM(np.concatenate(tables)), ca.DM(rate)

    def evaluate(times: Any) -> Any:
        turns = column @ times
        return stacked @ ca.vertcat(ca.cos(turns), ca.sin(turns))

    return TimeCurves(names, evaluate)
