"""E of (10) from sampled powers: quadrature that knows where a power changes sign."""

from __future__ import annotations

import itertools

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PPoly

Array = NDArray[np.float64]


def smooth_pieces(time: Array) -> list[slice]:
    """Slices of the smooth pieces of a record in which jumps stand twice."""
    breaks = np.flatnonzero(np.diff(time) <= 0) + 1
    edges = [0, *breaks.tolist(), len(time)]
    return [slice(a, b) for a, b in itertools.pairwise(edges) if b - a > 1]


def absolute_integral(time: Array, power: Array) -> float:
    """Integral of |power| [J] over a record [s, W] with jumps standing twice.

    Each smooth piece is interpolated by a cubic spline, which is integrated exactly between its
    sign changes. Where the power is not a number, as in a motion that its search left out of
    reach, nothing is counted: the audit rejects such a record.
    """
    total = 0.0
    for piece in smooth_pieces(time):
        for run in _runs_of_numbers(power[piece]):
            t, p = time[piece][run], power[piece][run]
            curve = CubicSpline(t, p, bc_type="not-a-knot")
            integral = curve.antiderivative()
            roots = PPoly.roots(curve, extrapolate=False) if np.ptp(p) > 0 else np.array([])
            cuts = np.concatenate([[t[0]], np.sort(roots[np.isfinite(roots)]), [t[-1]]])
            total += float(np.sum(np.abs(np.diff(integral(cuts)))))
    return total


def _runs_of_numbers(values: Array) -> list[slice]:
    """Slices of two or more consecutive finite values."""
    edges = [-1, *np.flatnonzero(~np.isfinite(values)).tolist(), len(values)]
    return [slice(a + 1, b) for a, b in itertools.pairwise(edges) if b - a > 2]


def joint_energies(dataset: xr.Dataset) -> dict[str, float]:
    """Integral of absolute power [J] over the stride, both legs together, by joint."""
    time = dataset["time"].to_numpy()
    power = dataset["joint_power"].to_numpy()
    return {
        str(joint): sum(absolute_integral(time, power[:, leg, j]) for leg in (0, 1))
        for j, joint in enumerate(dataset["joint"].to_numpy())
    }
