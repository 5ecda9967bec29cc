"""What it costs to walk like a person: prices of numbers as bars, of corridor edges as curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ergowalk.plots import style

Array = NDArray[np.float64]

SHOWN = 16
"""How many numbers are shown, dearest first."""


def draw_prices(
    numbers: Sequence[tuple[str, float]],
    fraction: Array,
    width: Array,
    edges: Mapping[str, Mapping[str, Array]],
) -> Figure:
    """The price list of a gait.

    Parameters
    ----------
    numbers : sequence of (name, elasticity)
        Relative change of E per relative change of each given number, dearest first.
    fraction, width : (n,) arrays
        Middles and lengths of the elements as fractions of the stride of one leg.
    edges : {joint: {"lower" | "upper": (n,) array}}
        J/m saved per degree by which that edge moves outward, per 1 % of the stride.
    """
    with style.styled():
        figure = Figure(figsize=(7.2, 6.2), layout="constrained")
        panels: Any = figure.subfigures(1, 2, width_ratios=(1.15, 1.0))
        _bars(panels[0], numbers[:SHOWN])
        _curves(panels[1], fraction, width, edges)
    return figure


def _bars(figure: Figure, numbers: Sequence[tuple[str, float]]) -> None:
    axes = figure.subplots()
    names = [name for name, _ in numbers]
    values = np.array([value for _, value in numbers])
    colours = [style.LEG_2 if value > 0 else style.LEG_1 for value in values]
    places = np.arange(len(names))
    axes.barh(places, values, color=colours, height=0.7)
    axes.set_yticks(places, names, fontsize=6.5)
    axes.invert_yaxis()
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.set_xlabel("% of E per % of the number")
    axes.set_title("What changes the energy")


def _curves(
    figure: Figure, fraction: Array, width: Array, edges: Mapping[str, Mapping[str, Array]]
) -> None:
    rows = figure.subplots(len(edges), 1, sharex=True, sharey=True)
    for axes, (joint, prices) in zip(np.atleast_1d(rows), edges.items(), strict=True):
        for edge, sign, colour in (("upper", 1, style.LEG_2), ("lower", -1, style.LEG_1)):
            axes.bar(
                100 * fraction, sign * prices[edge], 100 * width, color=colour, label=f"{edge} edge"
            )
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set_title(joint)
    np.atleast_1d(rows)[0].legend()
    np.atleast_1d(rows)[-1].set_xlabel("% of the stride")
    figure.supylabel("J/m per degree and % of the stride", fontsize=8.5)
