"""The answer of a comparison: numbers by signal, as a table and as plain values."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.comparison.signals import SD_FLOOR
from ergowalk.corridors import BUILT_IN, SIGNALS
from ergowalk.values import as_json

Array = NDArray[np.float64]


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

    ``missing`` names those that it lacks, or whose SD is zero all along. ``other`` is the
    comparison of the other leg, where that has curves of its own.
    """

    source: str
    signals: tuple[SignalComparison, ...]
    missing: tuple[str, ...] = ()
    leg: int = 1
    other: Comparison | None = None

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
        spread = " between people" if self.source in BUILT_IN else ""
        lines = [f"leg {self.leg} against {self.source}, mean +- SD{spread}"]
        for row in rows:
            cells = [row[0].ljust(widths[0])]
            cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
            lines.append("  ".join(cells))
        if any(signal.floored_share > 0 for signal in self.signals):
            lines.append(f"an SD under {SD_FLOOR:.0%} of the signal's largest SD counts as that")
        if self.missing:
            lines.append(f"no mean and SD in {self.source}: {', '.join(self.missing)}")
        if self.other is not None:
            lines.append(self.other.table())
        return "\n".join(lines)

    def as_dict(self) -> dict[str, Any]:
        """The comparison as plain values that ``json.dumps`` takes; None stands for NaN."""
        signals = {}
        for signal in self.signals:
            values = {k: v for k, v in asdict(signal).items() if k != "name"}
            signals[signal.name] = as_json(values)
        return {
            "source": self.source,
            "leg": self.leg,
            "sd_floor": SD_FLOOR,
            "signals": signals,
            "missing": list(self.missing),
            **({} if self.other is None else {"other_leg": self.other.as_dict()}),
        }


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
