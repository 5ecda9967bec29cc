"""Figures 3-10: one curve of leg 1 over the stride, against the human mean and SD."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from ergowalk.comparison import (
    COMPARED,
    ComparedSignal,
    PhaseSpan,
    StrideCurves,
    contact_phases,
    curve,
    legs_with_curves,
    stride_curves,
    stride_fraction,
)
from ergowalk.corridors import SIGNALS, HumanGait
from ergowalk.plots import style
from ergowalk.plots.sheets import SCREEN, Hand

Array = NDArray[np.float64]

_DENSE = np.linspace(0.0, 1.0, 401)
_DIFFERENT = 0.05  # deg: from here on the problem's corridor is not the band of 1 SD


@dataclass(frozen=True)
class Material:
    """What the curves of a gait are drawn from.

    ``corridors`` by signal, where they are drawn; ``other`` are the curves of leg 2 where that does
    not mirror leg 1.
    """

    gait: StrideCurves
    human: HumanGait
    corridors: dict[str, tuple[Array, Array]]
    phases: tuple[PhaseSpan, ...]
    other: StrideCurves | None = None

    @classmethod
    def of(cls, dataset: xr.Dataset, human: HumanGait) -> Material:
        """The material of a gait file.

        Raises
        ------
        GaitFileError
            If a variable is missing or not finite.
        """
        found = {signal.name: problem_corridor(dataset, signal, human) for signal in COMPARED}
        return cls(
            stride_curves(dataset),
            human,
            {name: bounds for name, bounds in found.items() if bounds is not None},
            contact_phases(dataset),
            stride_curves(dataset, 2) if 2 in legs_with_curves(dataset) else None,
        )

    def legs(self) -> list[tuple[StrideCurves, str]]:
        """The curves of leg 1, and of leg 2 if it has its own, with their colours."""
        other = [] if self.other is None else [(self.other, style.LEG_2)]
        return [(self.gait, style.GAIT), *other]


def draw_curve(
    axes: Axes, material: Material, signal: ComparedSignal, hand: Hand = SCREEN.hand
) -> None:
    """Draw one curve: human band and mean, corridor of the problem, optimum, phases of leg 1."""
    if signal.name in material.human.curves:
        band = material.human.corridor(signal.name)
        mean, half = band.mean(_DENSE), np.maximum(band.sd(_DENSE), 0.0)
        low, high = mean - half, mean + half
        axes.fill_between(100 * _DENSE, low, high, color=style.BAND, linewidth=0, zorder=1)
        axes.plot(100 * _DENSE, mean, "--", color=style.HUMAN, linewidth=hand.mean, zorder=3)
    percent = 100 * material.gait.fraction
    for bound in material.corridors.get(signal.name, ()):
        axes.plot(percent, bound, color=style.CORRIDOR, linewidth=hand.corridor, zorder=2.5)
    values = material.gait.values[signal.name]
    axes.plot(percent, values, color=style.GAIT, linewidth=hand.optimum, zorder=4)
    if material.other is not None:
        other = material.other
        percent, values = 100 * other.fraction, other.values[signal.name]
        axes.plot(percent, values, color=style.LEG_2, linewidth=hand.optimum, zorder=3.5)
    for leg, colour in material.legs():
        if signal.name in leg.borne:
            x, part = 100 * leg.fraction, leg.borne[signal.name]
            axes.plot(x, part, ":", color=colour, linewidth=hand.optimum, zorder=3.8)
    axes.axhline(0.0, color="black", linewidth=0.5, zorder=2)
    axes.set_xlim(0, 100)
    axes.set_xticks(range(0, 101, 20))
    whose = "leg 1" if material.other is None else "each leg; phases of leg 1"
    axes.set_xlabel(f"stride of {whose} [%]")
    axes.set_ylabel(axis_label(signal, hand))
    _mark_phases(axes, material.phases, hand.phases)


def axis_label(signal: ComparedSignal, hand: Hand = SCREEN.hand) -> str:
    """What the ordinate shows, its unit, and what its positive sign means."""
    name = SIGNALS[signal.name].label
    name = {"full": f"{name} ", "short": "", "stacked": f"{name}\n"}[hand.label]
    return f"{name}{plain(signal.symbol)} [{signal.unit}], {signal.positive} +"


def plain(symbol: str) -> str:
    """A symbol such as "mu^o" or "R_x/M" in single characters.

    Typeset formulas become one letter after the other in an SVG file, which no search finds.
    """
    for written, character in _CHARACTERS.items():
        symbol = symbol.replace(written, character)
    return symbol


_CHARACTERS = {"mu": "\N{GREEK SMALL LETTER MU}", "^o": "ᵒ", "^k": "ᵏ", "^a": "ᵃ", "_": ""}


def problem_corridor(
    dataset: xr.Dataset, signal: ComparedSignal, human: HumanGait
) -> tuple[Array, Array] | None:
    """Lower and upper bound [deg] of an angle where they are not the band of 1 SD.

    None for signals without a corridor. Bounds are (n,), NaN where there is none.
    """
    if signal.unit != "deg" or "corridor_lower" not in dataset:
        return None
    joint = signal.name.split("_")[0]
    lower, upper = (
        np.degrees(curve(dataset, f"corridor_{side}", {"leg": 1, "joint": joint}, gaps=True))
        for side in ("lower", "upper")
    )
    if np.all(np.isnan(lower)) and np.all(np.isnan(upper)):
        return None
    if signal.name in human.curves:
        band = human.corridor(signal.name)
        s = stride_fraction(dataset)
        off = [np.abs(lower - band.lower(s)), np.abs(upper - band.upper(s))]
        if np.nanmax(off) <= _DIFFERENT:
            return None
    return lower, upper


def _mark_phases(axes: Axes, phases: tuple[PhaseSpan, ...], fontsize: float) -> None:
    """Thin lines at the phase changes, and the names of the phases above the axes."""
    for span in phases[1:]:
        axes.axvline(100 * span.start, color=style.FAINT, linewidth=0.6, zorder=1.5)
    figure = axes.get_figure(root=True)
    assert figure is not None
    across = axes.get_position().width * figure.get_size_inches()[0]
    # a letter of DejaVu Sans is about 0.6 em wide; one letter's room keeps neighbours apart
    widths = [0.6 * fontsize / 72 * (len(span.name) + 1) / across for span in phases]
    centres = spread([(span.start + span.end) / 2 for span in phases], widths)
    for span, centre in zip(phases, centres, strict=True):
        axes.text(
            centre,
            1.015,
            span.name,
            transform=axes.transAxes,
            ha="center",
            va="bottom",
            fontsize=fontsize,
            color="#606060",
        )


def spread(centres: list[float], widths: list[float]) -> list[float]:
    """Move labels on the unit interval as little as needed for none to overlap its neighbour.

    Labels keep their order. Those that collide are joined to a block around their mean place
    (the least-squares answer), which stays inside the interval if there is room for it.
    """
    blocks: list[tuple[float, float, int]] = []  # mean centre, width, labels
    for centre, width in zip(centres, widths, strict=True):
        block = _inside(centre, width, 1)
        while blocks and _overlap(blocks[-1], block):
            (a, wa, na), (b, wb, nb) = blocks.pop(), block
            block = _inside((na * a + nb * b) / (na + nb), wa + wb, na + nb)
        blocks.append(block)
    placed, rest = [], iter(widths)
    for centre, width, count in blocks:
        left = centre - width / 2
        for _ in range(count):
            own = next(rest)
            placed.append(left + own / 2)
            left += own
    return placed


def _inside(centre: float, width: float, count: int) -> tuple[float, float, int]:
    return max(width / 2, min(centre, 1 - width / 2)), width, count


def _overlap(left: tuple[float, float, int], right: tuple[float, float, int]) -> bool:
    return left[0] + left[1] / 2 > right[0] - right[1] / 2


def curve_keys(
    material: Material, *signals: ComparedSignal, hand: Hand = SCREEN.hand
) -> list[Line2D | Patch]:
    """Legend entries of what is drawn of these signals."""
    names = [signal.name for signal in signals]
    keys: list[Line2D | Patch] = [
        Line2D([], [], color=style.GAIT, linewidth=hand.optimum, label="optimum, leg 1")
    ]
    if material.other is not None:
        keys.append(
            Line2D([], [], color=style.LEG_2, linewidth=hand.optimum, label="optimum, leg 2")
        )
    for leg, colour in material.legs():
        if any(name in leg.borne for name in names):
            line = Line2D([], [], color=colour, linewidth=hand.optimum, linestyle=":")
            line.set_label("borne by the device")
            keys.append(line)
    if any(name in material.human.curves for name in names):
        name = material.human.name.replace("\\", "/").rsplit("/", 1)[-1]
        label = f"human mean ({name if len(name) <= 24 else name[:23] + '…'})"
        keys += [
            Line2D([], [], color=style.HUMAN, linewidth=hand.mean, linestyle="--", label=label),
            Patch(color=style.BAND, linewidth=0, label="mean ± 1 SD"),
        ]
    if any(name in material.corridors for name in names):
        keys.append(Line2D([], [], color=style.CORRIDOR, linewidth=hand.corridor, label="corridor"))
    return keys
