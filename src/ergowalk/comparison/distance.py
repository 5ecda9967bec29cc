"""How far a gait's curves are from the human mean, in standard deviations between people.

All means over the stride are integrals over time by the trapezoidal rule. Samples need not be
equally spaced, and an instant that stands twice, with the limit from each side, has no weight of
its own.
"""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.comparison.reading import StrideCurves, legs_with_curves, stride_curves
from ergowalk.comparison.result import Comparison, Extremes, SignalComparison
from ergowalk.comparison.signals import ANGLE_TOLERANCE_DEG, COMPARED, SD_FLOOR, ComparedSignal
from ergowalk.corridors import HumanGait

Array = NDArray[np.float64]

_DENSE = np.linspace(0.0, 1.0, 1001)

_ROUNDING = 1e-9  # SDs: a curve exactly on a bound is inside


def compare(dataset: xr.Dataset, human: HumanGait) -> Comparison:
    """Leg 1 of a gait against human data, Figures 3-10; leg 2 too, where it does not mirror leg 1.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.
    human : HumanGait
        Human mean and SD; :func:`human_of` gives those that the gait's problem names.

    Raises
    ------
    GaitFileError
        If a variable is missing or not finite, or the times do not run forward.
    """
    known = [signal for signal in COMPARED if _has_spread(signal.name, human)]
    missing = tuple(signal.name for signal in COMPARED if signal not in known)
    found: Comparison | None = None
    for leg in reversed(legs_with_curves(dataset)):
        curves = stride_curves(dataset, leg)
        signals = tuple(_compare(signal, curves, human) for signal in known)
        found = Comparison(human.name, signals, missing, leg, found)
    assert found is not None
    return found


def stride_mean(fraction: Array, values: Array) -> float:
    """Mean of (n,) samples over the stride by the trapezoidal rule."""
    return float(np.trapezoid(values, fraction) / (fraction[-1] - fraction[0]))


def share_within_one(fraction: Array, ratio: Array) -> float:
    r"""Share of the stride in which \\|ratio\\| <= 1, the curve being linear between samples.

    Crossings inside an interval count with their exact share, so the answer hardly depends on
    the sampling. Both arrays are (n,).
    """
    low, high = np.minimum(ratio[:-1], ratio[1:]), np.maximum(ratio[:-1], ratio[1:])
    overlap = np.clip(np.minimum(high, 1.0) - np.maximum(low, -1.0), 0.0, None)
    level = high == low  # constant over the interval: inside or outside as a whole
    span = np.where(level, 1.0, high - low)
    share = np.where(level, np.abs(low) <= 1.0, overlap / span)
    return float(share @ np.diff(fraction) / (fraction[-1] - fraction[0]))


def _has_spread(name: str, human: HumanGait) -> bool:
    return name in human.curves and bool(np.any(human.curves[name][1](_DENSE) > 0))


def _compare(signal: ComparedSignal, curves: StrideCurves, human: HumanGait) -> SignalComparison:
    fraction, values = curves.fraction, curves.values[signal.name]
    mean_curve, sd_curve = human.curves[signal.name]
    mean, sd = mean_curve(fraction), sd_curve(fraction)
    floor = SD_FLOOR * float(sd_curve(_DENSE).max())
    yardstick = np.maximum(sd, floor)
    difference = values - mean
    slack = ANGLE_TOLERANCE_DEG if signal.unit == "deg" else 0.0

    def inside(width: float) -> float:
        reach = (width + _ROUNDING) * yardstick + slack
        return share_within_one(fraction, difference / reach)

    return SignalComparison(
        name=signal.name,
        symbol=signal.symbol,
        unit=signal.unit,
        rms_sd=math.sqrt(stride_mean(fraction, (difference / yardstick) ** 2)),
        inside_1sd=inside(1.0),
        inside_2sd=inside(2.0),
        correlation=_correlation(fraction, values, mean),
        gait=Extremes.of(fraction, values),
        human=Extremes.of(_DENSE, mean_curve(_DENSE)),
        floored_share=float(np.mean(sd_curve(_DENSE) < floor)),
    )


def _correlation(fraction: Array, first: Array, second: Array) -> float:
    a = first - stride_mean(fraction, first)
    b = second - stride_mean(fraction, second)
    product = stride_mean(fraction, a * a) * stride_mean(fraction, b * b)
    return stride_mean(fraction, a * b) / math.sqrt(product) if product > 0 else math.nan
