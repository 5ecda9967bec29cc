"""Edges of the corridors (6) as given functions of time, for the kernels of the collocation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.corridors import Corridor
from ergowalk.transcription.phases import TimeCurves

Array = NDArray[np.float64]

BAND = ("middle", "half width")
"""What is asked of a corridor."""


def corridor_edges(
    corridors: Sequence[Mapping[str, Corridor]], stride: float, shifts: Mapping[int, float]
) -> TimeCurves:
    """Middle and half width [rad] of the corridors of legs over a stride of so many seconds.

    They are called "hip_1 middle", "hip_1 half width", and so on. ``corridors`` are those of leg 1
    and 2; ``shifts`` say of which legs the edges are wanted, and by which share of the stride each
    is ahead.
    """
    names, table = [], []
    for joint in corridors[0]:
        for edge in BAND:
            for leg, shift in shifts.items():
                corridor = corridors[leg - 1][joint]
                middle = edge == BAND[0]
                curve, width = (corridor.mean, 1.0) if middle else (corridor.sd, corridor.width)
                names.append(f"{joint}_{leg} {edge}")
                table.append(width * curve.coefficients(shift))
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
