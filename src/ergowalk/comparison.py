"""A gait against human walking: the eight curves of the paper's Figures 3-10, leg 1.

The yardstick is the standard deviation (SD) between people at the same instant of the stride.
Where it nearly vanishes - reactions and ankle moment in swing - a distance in SDs means nothing,
so the SD is never taken below :data:`SD_FLOOR` of its largest value over the stride, and each
answer says for what share of the stride that floor applied.

All means over the stride are integrals over time by the trapezoidal rule. Samples need not be
equally spaced, and an instant that stands twice, with the limit from each side, has no weight of
its own.
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.corridors import SIGNALS, HumanGait, human_gait
from ergowalk.errors import GaitFileError

Array = NDArray[np.float64]

SD_FLOOR = 0.05
"""Smallest SD used, as a share of the largest SD of the same signal over the stride.

With Winter's natural cadence it applies in swing alone. RMS distances of the reactions hardly
feel it (1 % between floors of 2 and 10 %); at 10 % it would reach the knee moment in swing too.
"""

ANGLE_TOLERANCE_DEG = 0.1
"""How far an angle may stand outside a corridor and still count as inside: the tolerance that an
acceptable gait has. An optimum rides on its bounds, so without it rounding would decide."""

DEFAULT_SOURCE = "winter-natural"
"""Human data of a problem that names none."""

_DENSE = np.linspace(0.0, 1.0, 1001)

_ROUNDING = 1e-9  # SDs: a curve exactly on a bound is inside


@dataclass(frozen=True)
class ComparedSignal:
    """One curve of Figures 3-10; ``positive`` says in words what its sign means."""

    figure: int
    name: str
    symbol: str
    unit: str
    positive: str


COMPARED = (
    ComparedSignal(3, "hip_angle", "mu^o", "deg", "flexion"),
    ComparedSignal(4, "knee_angle", "mu^k", "deg", "flexion"),
    ComparedSignal(5, "ankle_angle", "mu^a", "deg", "dorsiflexion"),
    ComparedSignal(6, "reaction_x", "R_x/M", "N/kg", "forward"),
    ComparedSignal(7, "reaction_y", "R_y/M", "N/kg", "up"),
    ComparedSignal(8, "hip_moment", "q/M", "N m/kg", "flexion"),
    ComparedSignal(9, "knee_moment", "u/M", "N m/kg", "extension"),
    ComparedSignal(10, "ankle_moment", "p/M", "N m/kg", "dorsiflexion"),
)
"""The signals of Figures 3-10 in the paper's order, with the paper's signs."""


@dataclass(frozen=True)
class StrideCurves:
    """Leg 1's curves over the stride: ``fraction`` 0 ... 1 (n,), and (n,) values by signal."""

    fraction: Array
    values: dict[str, Array]


@dataclass(frozen=True)
class Extremes:
    """Smallest and largest value of a curve, and where in the stride they stand [%]."""

    min: float
    min_at_percent: float
    max: float
    max_at_percent: float

    @classmethod
    def of(cls, fraction: Array, values: Array) -> Extremes:
        """Extremes of samples at stride fractions, both (n,)."""
        low, high = int(np.argmin(values)), int(np.argmax(values))
        return cls(
            float(values[low]),
            100 * float(fraction[low]),
            float(values[high]),
            100 * float(fraction[high]),
        )


@dataclass(frozen=True)
class SignalComparison:
    """One curve against the human mean and SD.

    ``rms_sd`` is the root mean square distance from the mean in SDs; ``inside_1sd`` and
    ``inside_2sd`` are shares of the stride within that many SDs; ``correlation`` is Pearson's
    coefficient over the stride (NaN for a constant curve); ``floored_share`` is the share of the
    stride where :data:`SD_FLOOR` replaced the SD.
    """

    name: str
    symbol: str
    unit: str
    rms_sd: float
    inside_1sd: float
    inside_2sd: float
    correlation: float
    gait: Extremes
    human: Extremes
    floored_share: float


@dataclass(frozen=True)
class Comparison:
    """All signals that the table of human data has.

    ``missing`` names those that it lacks, or whose SD is zero all along.
    """

    source: str
    signals: tuple[SignalComparison, ...]
    missing: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> SignalComparison:
        """The comparison of one signal; KeyError if the table lacks it."""
        for signal in self.signals:
            if signal.name == name:
                return signal
        raise KeyError(name)

    def table(self) -> str:
        """The comparison as plain text, one line per signal."""
        rows = [_HEADER, *(_row(signal) for signal in self.signals)]
        widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADER))]
        lines = [f"leg 1 against {self.source}, mean +- SD between people"]
        for row in rows:
            cells = [row[0].ljust(widths[0])]
            cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
            lines.append("  ".join(cells))
        if any(signal.floored_share > 0 for signal in self.signals):
            lines.append(f"an SD under {SD_FLOOR:.0%} of the signal's largest SD counts as that")
        if self.missing:
            lines.append(f"no mean and SD in {self.source}: {', '.join(self.missing)}")
        return "\n".join(lines)

    def as_dict(self) -> dict[str, Any]:
        """The comparison as plain values that ``json.dumps`` takes; None stands for NaN."""
        signals = {}
        for signal in self.signals:
            values = {k: _finite(v) for k, v in asdict(signal).items() if k != "name"}
            signals[signal.name] = values
        return {
            "source": self.source,
            "leg": 1,
            "sd_floor": SD_FLOOR,
            "signals": signals,
            "missing": list(self.missing),
        }


def compare(dataset: xr.Dataset, human: HumanGait) -> Comparison:
    """Leg 1 of a gait against human data, Figures 3-10.

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
    curves = stride_curves(dataset)
    known = [signal for signal in COMPARED if _has_spread(signal.name, human)]
    return Comparison(
        human.name,
        tuple(_compare(signal, curves, human) for signal in known),
        tuple(signal.name for signal in COMPARED if signal not in known),
    )


def human_of(dataset: xr.Dataset, folder: Path | None = None) -> HumanGait:
    """The human data named in the gait's problem, ``[corridors] source``.

    ``folder`` is where a relative path starts.

    Raises
    ------
    GaitFileError
        If the attribute ``problem`` is missing or names no human data.
    CorridorError
        If the human data cannot be read.
    """
    try:
        corridors = tomllib.loads(str(dataset.attrs["problem"])).get("corridors", {})
        source = corridors.get("source", DEFAULT_SOURCE)
        if not isinstance(source, str):
            raise TypeError(f"corridors.source = {source!r} is no name")
    except (KeyError, AttributeError, TypeError, tomllib.TOMLDecodeError) as error:
        raise _unusable_attribute("problem", "TOML text with a table [corridors]", error) from None
    return human_gait(source, folder)


def body_of(dataset: xr.Dataset) -> Body:
    """The body of a gait, from the attribute ``body_parameters``.

    Raises
    ------
    GaitFileError
        If the attribute is missing, no JSON object of the paper's symbols, or no possible body.
    """
    try:
        symbols = json.loads(str(dataset.attrs["body_parameters"]))
        return Body.from_symbols(symbols)
    except (KeyError, AttributeError, ValueError) as error:
        rule = "a JSON object of the paper's symbols that make a possible body"
        raise _unusable_attribute("body_parameters", rule, error) from None


def stride_curves(dataset: xr.Dataset) -> StrideCurves:
    """The eight signals of leg 1 in degrees, N/kg and N m/kg, in the paper's signs.

    Raises
    ------
    GaitFileError
        If a variable is missing or not finite, or the times do not run forward from 0.
    """
    mass = body_of(dataset).total_mass
    values = {}
    for signal in COMPARED:
        if signal.name.startswith("reaction"):
            axis = signal.name[-1]
            force = curve(dataset, "ground_reaction_force", {"leg": 1, "axis": axis})
            values[signal.name] = force / mass
        else:
            joint, kind = signal.name.split("_")
            raw = curve(dataset, f"joint_{kind}", {"leg": 1, "joint": joint})
            values[signal.name] = np.degrees(raw) if kind == "angle" else raw / mass
    return StrideCurves(stride_fraction(dataset), values)


def curve(
    dataset: xr.Dataset, variable: str, labels: Mapping[str, int | str] = {}, gaps: bool = False
) -> Array:
    """A variable's samples (n,) over time at coordinate ``labels``, such as {"leg": 1}.

    Raises
    ------
    GaitFileError
        If it is missing, does not run over time alone, or, unless it may have ``gaps``, is not
        finite everywhere.
    """
    try:
        array = dataset[variable].sel(labels)
        if array.dims != ("time",):
            raise ValueError(f"has dimensions {array.dims}")
        values = np.asarray(array.values, dtype=float)
    except (KeyError, ValueError, TypeError):
        where = "".join(f", {dim} = {label}" for dim, label in labels.items())
        rule = f"must be there as numbers over time{where}"
        raise GaitFileError(rule, _REMEDY, field=variable) from None
    if not gaps and not np.all(np.isfinite(values)):
        raise GaitFileError("must be finite at every instant", _REMEDY, field=variable)
    return values


def stride_fraction(dataset: xr.Dataset) -> Array:
    """Times over the stride time, (n,), from 0 to 1.

    Raises
    ------
    GaitFileError
        If the times do not run forward from 0.
    """
    time = curve(dataset, "time")
    if len(time) < 2 or time[0] != 0 or time[-1] <= 0 or np.any(np.diff(time) < 0):
        raise GaitFileError(
            "must run from 0 to the stride time and never decrease", _REMEDY, field="time"
        )
    fraction: Array = time / time[-1]
    return fraction


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


def _unusable_attribute(name: str, rule: str, error: Exception) -> GaitFileError:
    reason = f"missing or unknown: {error}" if isinstance(error, KeyError) else str(error)
    return GaitFileError(f"must be {rule} ({reason})", _REMEDY, field=f"attribute {name}")


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _row(signal: SignalComparison) -> tuple[str, ...]:
    correlation = "-" if math.isnan(signal.correlation) else f"{signal.correlation:.2f}"
    digits = 1 if signal.unit == "deg" else 2

    def span(ends: Extremes) -> str:
        low, high = (round(value, digits) + 0.0 for value in (ends.min, ends.max))  # no -0.00
        return f"{low:.{digits}f} to {high:.{digits}f}"

    return (
        f"{SIGNALS[signal.name].label} {signal.symbol} [{signal.unit}]",
        f"{signal.rms_sd:.2f} SD",
        f"{signal.inside_1sd:.0%}",
        f"{signal.inside_2sd:.0%}",
        correlation,
        span(signal.gait),
        span(signal.human),
    )


_HEADER = ("signal", "RMS distance", "within 1 SD", "within 2 SD", "correlation", "gait", "human")

_REMEDY = "give a file written by 'ergowalk solve'"
