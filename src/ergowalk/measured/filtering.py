"""Smoothing without phase lag, gaps, and rates by differences."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt

Array = NDArray[np.float64]

TWO_PASSES = (2**0.5 - 1) ** 0.25
"""What two passes of a second-order Butterworth filter do to its cut-off, 0.802 (Winter 2009)."""

HIGHEST = 0.8
"""Highest cut-off of a single pass, as a share of half the sampling rate."""


def low_pass(values: Array, rate: float, cutoff: float) -> Array:
    """Butterworth filter of second order run forward and backward along axis 0.

    The passes together take off 3 dB at ``cutoff`` [Hz] and shift nothing in time. A cut-off that
    the sampling ``rate`` [Hz] cannot hold leaves the values as they are. The ends are continued by
    turning the record about its end points.
    """
    share = cutoff / TWO_PASSES / (rate / 2)
    if share >= HIGHEST:
        return values.copy()
    sections = butter(2, share, output="sos")
    padding = min(len(values) - 1, max(20, int(rate / cutoff)))
    smooth: Array = sosfiltfilt(sections, values, axis=0, padtype="odd", padlen=padding)
    return smooth


def differences(values: Array, rate: float) -> Array:
    """Rate of change along axis 0 by central differences over two steps, one-sided at the ends."""
    found: Array = np.gradient(values, 1 / rate, axis=0)
    return found


def longest_gap(seen: NDArray[np.bool_]) -> int:
    """Length of the longest run of frames without a value between two with one."""
    at = np.flatnonzero(seen)
    return int(np.diff(at).max() - 1) if len(at) > 1 else len(seen)


def fill_gaps(values: Array) -> Array:
    """(n, 3) values with NaN frames between others replaced by a cubic spline through those.

    Before the first and after the last seen frame NaN remains.
    """
    seen = np.isfinite(values).all(axis=1)
    if seen.all() or seen.sum() < 4:
        return values
    at = np.flatnonzero(seen)
    inside = np.arange(at[0], at[-1] + 1)
    filled = np.full_like(values, np.nan)
    filled[inside] = CubicSpline(at, values[at])(inside)
    filled[at] = values[at]
    return filled
