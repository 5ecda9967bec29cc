"""Figure 2: the walker as a stick figure at equal time steps over the double step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator
from numpy.typing import NDArray

from ergowalk.body import LegParameters
from ergowalk.comparison import body_of, curve, stride_fraction
from ergowalk.plots import style
from ergowalk.quantities import TRUNK_DRAWN

Array = NDArray[np.float64]

INTERVALS = 22
"""Time steps of a double step: figures at 0, T/22, ..., T. Even, so that every figure of the
second half stands where the other leg stood half a stride before."""


@dataclass(frozen=True)
class Leg:
    """Points of one leg, each (n, 2) in m."""

    hip: Array
    knee: Array
    ankle: Array
    heel: Array
    metatarsal: Array
    toe_tip: Array

    @property
    def lines(self) -> Array:
        """O-K-A-H-M-A as one path, (n, 6, 2)."""
        return np.stack(
            [self.hip, self.knee, self.ankle, self.heel, self.metatarsal, self.ankle], axis=1
        )

    @property
    def toes(self) -> Array:
        """M-T, (n, 2, 2)."""
        return np.stack([self.metatarsal, self.toe_tip], axis=1)


@dataclass(frozen=True)
class Sticks:
    """The walker at n instants; ``trunk`` is the line O-G' along the trunk axis, (n, 2, 2)."""

    trunk: Array
    legs: tuple[Leg, Leg]


def sticks(dataset: xr.Dataset, fractions: Array) -> Sticks:
    """The walker's points at stride fractions (n,), linearly between the stored instants.

    Raises
    ------
    GaitFileError
        If positions, angles or body are missing or not usable.
    """
    body = body_of(dataset)
    own = stride_fraction(dataset)
    once = np.concatenate([[True], np.diff(own) > 0])  # positions are continuous at jumps

    def at(variable: str, labels: dict[str, int | str]) -> Array:
        samples: Array = np.interp(fractions, own[once], curve(dataset, variable, labels)[once])
        return samples

    hip = np.stack([at("hip_position", {"axis": axis}) for axis in "xy"], axis=1)
    angle = at("trunk_angle", {})
    up = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    trunk = np.stack([hip, hip + TRUNK_DRAWN * body.trunk_com_m * up], axis=1)
    legs = []
    for i in (0, 1):
        angles = [at("segment_angle", {"leg": i + 1, "segment": name}) for name in _SEGMENTS]
        legs.append(_leg(body.leg(i), hip, *angles))
    return Sticks(trunk, (legs[0], legs[1]))


_SEGMENTS = ("thigh", "shank", "foot", "toes")


def _leg(
    leg: LegParameters, hip: Array, thigh: Array, shank: Array, foot: Array, toes: Array
) -> Leg:
    knee = hip + leg.thigh_length * _down(thigh)
    ankle = knee + leg.shank_length * _down(shank)
    metatarsal = ankle + leg.ankle_to_metatarsal * _down(foot)
    heel = metatarsal - leg.heel_to_metatarsal * _down(foot + leg.foot_angle)
    return Leg(hip, knee, ankle, heel, metatarsal, metatarsal + leg.toe_length * _down(toes))


def _down(angle: Array) -> Array:
    """Unit vectors (n, 2) at angles from the downward vertical, forward positive."""
    return np.stack([np.sin(angle), -np.cos(angle)], axis=1)


def draw_cyclogram(axes: Axes, dataset: xr.Dataset, scale: float = 1.0) -> None:
    """Draw the cyclogram; ``scale`` multiplies line widths and the size of words.

    The first, middle and last figure (heel contacts of leg 1, leg 2, leg 1) are drawn strong,
    those between them pale.
    """
    figures = sticks(dataset, np.linspace(0.0, 1.0, INTERVALS + 1))
    strong = np.isin(np.arange(INTERVALS + 1), [0, INTERVALS // 2, INTERVALS])
    alpha = np.where(strong, 1.0, 0.55)
    width = scale * np.where(strong, 1.7, 1.0)

    def draw(lines: Array, colour: str, order: float) -> None:
        for picked, lift in ((~strong, 0.0), (strong, 0.5)):
            collection = LineCollection(
                list(lines[picked]),
                colors=colour,
                linewidths=width[picked],
                alpha=alpha[picked][0],
                capstyle="round",
                joinstyle="round",
                zorder=order + lift,
            )
            axes.add_collection(collection, autolim=False)

    for step in np.flatnonzero(strong):
        top, share = figures.trunk[step, 1], step / INTERVALS
        axes.annotate(
            f"{share:.0%}".replace("%", " %"),
            top,
            xytext=(0, 4),
            textcoords="offset points",
            ha="center",
            fontsize=8 * scale,
            color="#606060",
        )
    draw(figures.trunk, style.TRUNK, 2.0)
    for i, colour, order in ((1, style.LEG_2, 3.0), (0, style.LEG_1, 4.0)):
        draw(figures.legs[i].lines, colour, order)
        draw(figures.legs[i].toes, colour, order)
    axes.axhline(0.0, color="black", linewidth=0.8 * scale, zorder=1)
    _frame(axes, figures)


def _frame(axes: Axes, figures: Sticks) -> None:
    points = np.concatenate(
        [figures.trunk.reshape(-1, 2)]
        + [p.reshape(-1, 2) for leg in figures.legs for p in (leg.lines, leg.toes)]
    )
    (left, low), (right, high) = points.min(axis=0), points.max(axis=0)
    axes.set_xlim(left - 0.08, right + 0.08)
    axes.set_ylim(min(low, 0.0) - 0.04, high + 0.10)
    axes.set_aspect("equal")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MultipleLocator(0.5))
    axes.set_xlabel("distance x [m]")
    axes.set_ylabel("height y [m]")


def cyclogram_keys(scale: float = 1.0) -> list[Line2D]:
    """Legend entries of the cyclogram."""
    named = (("leg 1", style.LEG_1), ("leg 2", style.LEG_2), ("trunk", style.TRUNK))
    return [
        Line2D([], [], color=colour, linewidth=1.7 * scale, label=name) for name, colour in named
    ]
