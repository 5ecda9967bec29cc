"""Maps of gaits: E over what was swept, and over speed and cadence with its valley."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation, UniformTriRefiner
from numpy.typing import NDArray

from ergowalk.plots import style

Array = NDArray[np.float64]

COLOURS = "viridis"
LEVELS = 14
FINER = 3
"""How often triangles are halved for contours, E being a cubic in each."""
ROOM = 0.04
"""Margin around the cases, as a part of their range."""
SPEEDS = (0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4)
"""Walking speeds whose lines are drawn [m/s]."""


@dataclass(frozen=True)
class Landscape:
    """E over two swept numbers, or over one.

    Attributes
    ----------
    x, y : (n,) arrays
        The numbers; without a second one ``y`` is None.
    x_name, y_name : str
        What they are called, with units.
    energy : (n,) array [J/m]
        NaN where there is no gait.
    accepted : (n,) array of bool
    triangles : (m, 3) array of int
        Triangles of accepted neighbours.
    speed, cadence : (n,) arrays [m/s, steps/min], or None
        None where the sweep varies only one of step length and stride time.
    valley : (k, 6) array
        Speed [m/s], step length [m], stride time [s] and E [J/m] of the cheapest walk at each
        speed that lies inside the map, and the step lengths [m] between which E is nearly as low.
    people, plain : (k, 3) arrays
        Speed [m/s], cadence and its SD between people [steps/min]: scaled to the legs of the
        walker, and as they are.
    people_name, plain_name : str
    """

    x: Array
    y: Array | None
    x_name: str
    y_name: str
    energy: Array
    accepted: NDArray[np.bool_]
    triangles: NDArray[np.int_]
    speed: Array | None
    cadence: Array | None
    valley: Array
    people: Array
    people_name: str
    plain: Array
    plain_name: str


def draw_map(landscape: Landscape, title: str = "") -> Figure:
    """The map of a sweep: one panel over what was swept, one over speed and cadence."""
    with style.styled():
        if landscape.y is None:
            figure = Figure(figsize=(5.4, 3.6), layout="constrained")
            _curve(figure.subplots(), landscape)
        else:
            both = landscape.speed is not None
            figure = Figure(figsize=(9.6 if both else 5.4, 4.6), layout="constrained")
            panels: Any = figure.subplots(1, 2 if both else 1, squeeze=False)[0]
            filled = _swept(panels[0], landscape)
            if both:
                _speeds(panels[1], landscape)
            if filled is not None:
                figure.colorbar(filled, ax=list(panels), label="E [J/m]", shrink=0.9, format="%.1f")
        if title:
            figure.suptitle(title, fontsize=10.0)
    return figure


def _curve(axes: Axes, found: Landscape) -> None:
    order = np.argsort(found.x)
    kept = order[found.accepted[order]]
    axes.plot(found.x[kept], found.energy[kept], "o-", color=style.GAIT, markersize=3.5)
    lost = found.x[~found.accepted]
    if len(lost):
        low = axes.get_ylim()[0]
        axes.plot(lost, np.full(len(lost), low), "x", color=style.WARNING, clip_on=False)
    axes.set_xlabel(found.x_name)
    axes.set_ylabel("E [J/m]")
    axes.set_title("Energy per metre")


def _swept(axes: Axes, found: Landscape) -> Any:
    assert found.y is not None
    filled = _fill(axes, found, found.x, found.y)
    axes.set_xlabel(found.x_name)
    axes.set_ylabel(found.y_name)
    axes.set_title("E over what was swept" if found.speed is None else "E(L, T)", pad=14)
    if found.speed is None:
        return filled
    low, high = np.array(axes.get_xlim()), np.array(axes.get_ylim())
    for speed in SPEEDS:
        _line_of_speed(axes, speed, low, high)
    if len(found.valley):
        speed, length, time, _, short, long = found.valley.T
        around = np.concatenate([short, long[::-1]])
        times = 2 * around / np.concatenate([speed, speed[::-1]])
        axes.fill(times, around, color=style.LEG_2, alpha=0.25, lw=0)
        axes.plot(time, length, color="white", linewidth=2.6)
        axes.plot(time, length, color=style.LEG_2, linewidth=1.6)
    axes.set_xlim(*low)
    axes.set_ylim(*high)
    return filled


def _line_of_speed(axes: Axes, speed: float, times: Array, lengths: Array) -> None:
    """L = v T / 2 across the panel, named where it leaves it."""
    ends = speed * times / 2
    if ends[1] <= lengths[0] or ends[0] >= lengths[1]:
        return
    axes.plot(times, ends, color="black", linewidth=0.5, linestyle=(0, (4, 3)), zorder=2)
    time = min(times[1], 2 * lengths[1] / speed)
    inside = ends[1] <= lengths[1]
    axes.annotate(
        f"{speed:g} m/s",
        (time, speed * time / 2),
        xytext=(3, 0) if inside else (0, 2),
        textcoords="offset points",
        fontsize=6.0,
        va="center" if inside else "bottom",
        ha="left" if inside else "center",
        annotation_clip=False,
    )


def _speeds(axes: Axes, found: Landscape) -> None:
    assert found.speed is not None
    assert found.cadence is not None
    _fill(axes, found, found.speed, found.cadence)
    span = axes.get_xlim(), axes.get_ylim()
    if len(found.people):
        speed, cadence, sd = found.people.T
        axes.fill_between(speed, cadence - sd, cadence + sd, color=style.BAND, alpha=0.45, lw=0)
        kind: Any = {"color": style.HUMAN, "label": found.people_name}
        axes.plot(speed, cadence, linewidth=1.4, linestyle="--", **kind)
    if len(found.plain):
        kind = {"color": style.HUMAN, "label": found.plain_name}
        axes.plot(found.plain[:, 0], found.plain[:, 1], linewidth=1.2, linestyle=":", **kind)
    if len(found.valley):
        speed, _, time, _, short, long = found.valley.T
        cadence = 120 / time
        low, high = 60 * speed / long, 60 * speed / short
        axes.fill_between(speed, low, high, color=style.LEG_2, alpha=0.25, lw=0)
        axes.plot(speed, cadence, color="white", linewidth=2.6)
        axes.plot(
            speed,
            cadence,
            color=style.LEG_2,
            linewidth=1.6,
            label="cheapest at each speed; within 0.5 % of it",
        )
    axes.set_xlim(*span[0])
    axes.set_ylim(*span[1])
    axes.set_xlabel("walking speed [m/s]")
    axes.set_ylabel("cadence [steps/min]")
    axes.set_title("E(speed, cadence)", pad=14)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16))


def _fill(axes: Axes, found: Landscape, x: Array, y: Array) -> Any:
    """Filled contours of E over the triangles, a dot at each gait, a cross where there is none."""
    filled, kept = None, found.accepted
    if len(found.triangles):
        used, corners = np.unique(found.triangles, return_inverse=True)
        mesh = Triangulation(x[used], y[used], corners.reshape(-1, 3))
        mesh, values = UniformTriRefiner(mesh).refine_field(found.energy[used], subdiv=FINER)
        energy = found.energy[used]
        # from the cheapest on, levels grow closer: the valley is what is looked for
        parts = np.linspace(0.0, 1.0, LEVELS + 1) ** 1.5
        levels = np.unique(energy.min() + parts * max(float(np.ptp(energy)), 1e-6))
        values = np.clip(values, levels[0], levels[-1])
        shade = Normalize(levels[0], levels[-1])
        filled = axes.tricontourf(mesh, values, levels=levels, cmap=COLOURS, norm=shade)
        axes.tricontour(mesh, values, levels=levels, colors="white", linewidths=0.25)
    axes.plot(x[kept], y[kept], ".", color="black", markersize=2.2)
    axes.plot(x[~kept], y[~kept], "x", color=style.WARNING, markersize=4.0, markeredgewidth=0.8)
    axes.set_xlim(*_with_room(x))
    axes.set_ylim(*_with_room(y))
    return filled


def _with_room(values: Array) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    return low - ROOM * (high - low), high + ROOM * (high - low)
