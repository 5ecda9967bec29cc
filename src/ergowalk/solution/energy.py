"""E of (10) from sampled powers: quadrature that knows where a power changes sign."""

from __future__ import annotations

import itertools

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PPoly

from ergowalk.quantities import DEVICE_MOMENT

Array = NDArray[np.float64]


def smooth_pieces(time: Array) -> list[slice]:
    """Slices of the smooth pieces of a record in which jumps stand twice."""
    breaks = np.flatnonzero(np.diff(time) <= 0) + 1
    edges = [0, *breaks.tolist(), len(time)]
    return [slice(a, b) for a, b in itertools.pairwise(edges) if b - a > 1]


def absolute_integrals(time: Array, powers: Array) -> Array:
    """Integrals of |power| [J] over a record with jumps standing twice.

    Parameters
    ----------
    time : (n,) array [s]
    powers : (n, k) array [W]

    Each smooth piece is interpolated by a cubic spline, which is integrated exactly between its
    sign changes. Where a power is not a number, as in a motion that its search left out of
    reach, nothing is counted: the audit rejects such a record.
    """
    total: Array = np.zeros(powers.shape[1])
    for piece in smooth_pieces(time):
        t, p = time[piece], powers[piece]
        numbers = np.flatnonzero(np.all(np.isfinite(p), axis=0))
        splines = _spline(t, p[:, numbers])
        hull = _bernstein(splines)
        one_sign = np.all(hull >= 0, axis=(0, 1)) | np.all(hull <= 0, axis=(0, 1))
        simple = numbers[one_sign]
        areas = np.diff(t) @ hull[..., one_sign].mean(axis=0)  # exact for a cubic
        total[simple] += np.abs(areas)
        for column in np.flatnonzero(~one_sign):
            total[numbers[column]] += _changing(PPoly(splines.c[..., column], t))
        for k in np.setdiff1d(np.arange(len(total)), numbers):
            for run in _runs_of_numbers(p[:, k]):
                total[k] += _changing(_spline(t[run], p[run, k]))
    return total


def _spline(time: Array, power: Array) -> CubicSpline:
    return CubicSpline(time, power, bc_type="not-a-knot")


def _bernstein(splines: CubicSpline) -> Array:
    """Bernstein coefficients of the splines, (4, intervals, k): the curves lie in their hull."""
    cubic, square, slope, value = splines.c
    h = np.diff(splines.x)[:, None]
    middle = value + h * slope / 3, value + 2 * h * slope / 3 + h**2 * square / 3
    end = value + h * (slope + h * (square + h * cubic))
    return np.stack([value, *middle, end])


def _changing(curve: PPoly) -> float:
    """Integral of the absolute value of a power that may change its sign."""
    integral = curve.antiderivative()
    roots = PPoly.roots(curve, extrapolate=False) if curve.c.any() else np.array([])
    cuts = np.concatenate([[curve.x[0]], np.sort(roots[np.isfinite(roots)]), [curve.x[-1]]])
    return float(np.sum(np.abs(np.diff(integral(cuts)))))


def _runs_of_numbers(values: Array) -> list[slice]:
    """Slices of two or more consecutive finite values."""
    edges = [-1, *np.flatnonzero(~np.isfinite(values)).tolist(), len(values)]
    return [slice(a + 1, b) for a, b in itertools.pairwise(edges) if b - a > 2]


def joint_energies(dataset: xr.Dataset) -> dict[str, float]:
    """Integral of absolute power [J] over the stride, both legs together, by joint."""
    by_joint = leg_energies(dataset).sum(axis=0)
    return {str(j): float(e) for j, e in zip(dataset["joint"].to_numpy(), by_joint, strict=True)}


def leg_energies(dataset: xr.Dataset) -> Array:
    """Integral of absolute power [J] over the stride, (legs, joints)."""
    power = dataset["joint_power"].transpose("time", "leg", "joint").to_numpy()
    each = absolute_integrals(dataset["time"].to_numpy(), power.reshape(len(power), -1))
    return each.reshape(power.shape[1:])


def device_works(dataset: xr.Dataset) -> dict[str, tuple[float, float]]:
    """What the devices at each joint give and take [J] over the stride, both legs together.

    Joints without a device, and those whose device does no work, are left out.
    """
    if DEVICE_MOMENT not in dataset:
        return {}
    time = dataset["time"].to_numpy()
    moment = dataset[DEVICE_MOMENT].transpose("time", "leg", "joint").to_numpy()
    power = (moment * relative_rates(dataset)).reshape(len(time), -1)
    power = np.nan_to_num(power)
    both, net = absolute_integrals(time, power), np.zeros(power.shape[1])
    for piece in smooth_pieces(time):
        t = time[piece]
        net += CubicSpline(t, power[piece]).integrate(t[0], t[-1])
    gives, takes = (((both + sign * net) / 2).reshape(2, -1).sum(axis=0) for sign in (1, -1))
    joints = [str(j) for j in dataset["joint"].to_numpy()]
    works = zip(joints, gives, takes, strict=True)
    return {j: (float(g), float(k)) for j, g, k in works if g + k > 0}


def relative_rates(dataset: xr.Dataset) -> Array:
    """Rates that the joint moments work on in (10), (n, 2, 4) [rad/s]."""
    trunk = dataset["trunk_angular_velocity"].to_numpy()
    segments = dataset["segment_angular_velocity"].transpose("time", "leg", "segment").to_numpy()
    first = np.broadcast_to(trunk[:, None, None], (*segments.shape[:2], 1))
    return np.diff(np.concatenate([first, segments], axis=2), axis=2)
