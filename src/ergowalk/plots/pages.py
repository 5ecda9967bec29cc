"""The figures by name: one page each, and the overview with all of them."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterable
from pathlib import Path

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ergowalk.comparison import COMPARED, ComparedSignal, compare, human_of
from ergowalk.corridors import SIGNALS, HumanGait
from ergowalk.errors import GaitFileError, OutputError
from ergowalk.plots import style
from ergowalk.plots.curves import Material, curve_keys, draw_curve
from ergowalk.plots.cyclogram import cyclogram_keys, draw_cyclogram
from ergowalk.plots.sheets import SCREEN, Hand, Place, Sheet

Build = Callable[[xr.Dataset, Material, Sheet], Figure]


def figures(dataset: xr.Dataset, human: HumanGait, sheet: Sheet = SCREEN) -> dict[str, Figure]:
    """All figures of a gait by name (:data:`FIGURES`); for a journal without the overview.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.
    human : HumanGait
        Human data to draw beside it; signals that the table lacks are drawn alone.
    sheet : Sheet
        Where they will be seen.

    Raises
    ------
    GaitFileError
        If the dataset lacks a variable, or one is not finite.
    """
    material = Material.of(dataset, human)
    return {name: _page(FIGURES[name], dataset, material, sheet) for name in names_on(sheet)}


def names_on(sheet: Sheet) -> list[str]:
    """Names of the figures that are made for a kind of page."""
    return [name for name in FIGURES if name != OVERVIEW or not sheet.captioned]


OVERVIEW = "figure_00_overview"


def write_figures(
    dataset: xr.Dataset,
    folder: Path,
    formats: Iterable[str] = style.FORMATS,
    human: HumanGait | None = None,
    sheet: Sheet | None = None,
) -> list[Path]:
    """Write every figure as ``folder/NAME.FORMAT`` and return the paths.

    Without ``human`` the data that the gait's problem names are used, without ``sheet`` the size
    is that of a screen; ``ergowalk.plots.JOURNAL`` has those of a journal. The folder is made if it
    does not exist; a file is renamed into place only when it is complete.

    Raises
    ------
    GaitFileError
        As :func:`figures`.
    CorridorError
        If the human data cannot be read.
    OutputError
        If a format is unknown or a file cannot be written.
    """
    folder, kinds, sheet = Path(folder), list(formats), sheet or SCREEN
    for kind in kinds:
        style.check_format(kind)
    material = Material.of(dataset, human_of(dataset) if human is None else human)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot be made ({error.strerror or error})", "choose another folder", file=str(folder)
        ) from None
    paths = []
    for name in names_on(sheet):
        figure = _page(
            FIGURES[name], dataset, material, sheet
        )  # one at a time: a page's pixels take megabytes
        paths += [style.save(figure, folder / f"{name}.{kind}") for kind in kinds]
    return paths


MOST_KEYS = 4
"""Keys of a legend in one row, and in all as a rule."""

KEY_HEIGHT = 0.17
"""Height of a row of keys [inch]."""


def _page(build: Build, dataset: xr.Dataset, material: Material, sheet: Sheet) -> Figure:
    with style.styled(sheet):
        figure = build(dataset, material, sheet)
        if not dataset.attrs.get("acceptable", 1):
            figure.text(
                0.99,
                0.99,
                "not an acceptable gait",
                ha="right",
                va="top",
                fontweight="bold",
                color=style.WARNING,
            )
    return figure


def _cyclogram_page(dataset: xr.Dataset, material: Material, sheet: Sheet) -> Figure:
    figure, axes = _empty(sheet.cyclogram)
    draw_cyclogram(axes, dataset, sheet.sticks)
    if not sheet.captioned:
        _title(axes, f"Cyclogram of a double step, {_size(dataset)}")
    figure.legend(handles=cyclogram_keys(sheet.sticks), loc="lower center", ncols=3)
    return figure


def _empty(place: Place) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(place.width, place.height))
    return figure, figure.add_axes(place.axes)


def _curve_page(signal: ComparedSignal) -> Build:
    def build(dataset: xr.Dataset, material: Material, sheet: Sheet) -> Figure:
        figure, axes = _empty(sheet.curve)
        draw_curve(axes, material, signal, sheet.hand)
        if not sheet.captioned:
            _title(axes, f"{_name(signal)} of leg 1, {_size(dataset)}", pad=16)
        keys = curve_keys(material, signal, hand=sheet.hand)
        most = sheet.columns or MOST_KEYS
        columns = min(len(keys), most)
        _make_room(figure, axes, math.ceil(len(keys) / most) - math.ceil(MOST_KEYS / most))
        figure.legend(handles=keys, loc="lower center", ncols=columns)
        return figure

    return build


def _make_room(figure: Figure, axes: Axes, rows: int) -> None:
    """Lift the lower edge of the axes for more rows of a legend than usual."""
    place = axes.get_position()
    lift = max(rows, 0) * KEY_HEIGHT / figure.get_figheight()
    axes.set_position((place.x0, place.y0 + lift, place.width, place.height - lift))


def _overview_page(dataset: xr.Dataset, material: Material, sheet: Sheet) -> Figure:
    figure = Figure(figsize=(11.0, 13.0))
    axes = figure.add_axes((0.06, 0.64, 0.925, 0.325))
    draw_cyclogram(axes, dataset)
    _title(axes, f"Energy-optimal walking, {_size(dataset)}", size=12)
    distances = {s.name: s.rms_sd for s in compare(dataset, material.human).signals}
    for signal, (row, column) in zip(COMPARED, _CELLS, strict=True):
        axes = figure.add_axes(_cell(row, column))
        draw_curve(axes, material, signal, _CELL)
        distance = distances.get(signal.name)
        note = "" if distance is None else f", {distance:.2f} SD"
        _title(axes, _name(signal) + note, pad=12)
    left, bottom, _, height = _cell(*_FREE)
    figure.legend(
        handles=[*cyclogram_keys(), *curve_keys(material, *COMPARED)],
        loc="upper left",
        bbox_to_anchor=(left, bottom + height),
        borderaxespad=0,
    )
    text = _facts(dataset, bool(distances))
    figure.text(left, bottom + 0.24 * height, text, va="top", fontsize=7.5, linespacing=1.35)
    return figure


_CELL = Hand(optimum=1.4, phases=6.5, label="short")
"""How curves are drawn in the overview."""

_CELLS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2))
"""Row and column of each curve in the overview."""

_FREE = (1, 2)
"""The place in the overview that the curves leave to words."""


def _cell(row: int, column: int) -> tuple[float, float, float, float]:
    """Left, bottom, width and height of a place in the overview, in shares of the page."""
    return 0.06 + 0.333 * column, 0.430 - 0.196 * row, 0.26, 0.132


def _facts(dataset: xr.Dataset, compared: bool) -> str:
    energy = _number(dataset, "energy_per_metre")
    lines = []
    if math.isfinite(energy):  # E says nothing without the limits it was found under
        limits = str(dataset.attrs.get("limits", "the limits of its problem"))
        lines += textwrap.wrap(f"E = {energy:.1f} J/m with {limits}", 48)
    if compared:
        lines.append("SD: RMS distance from the human mean")
    return "\n".join(lines)


def _title(axes: Axes, text: str, pad: float = 6.0, size: float = 10.0) -> None:
    # a height given saves matplotlib its search for one: a fifth of all drawing time
    axes.set_title(text, y=1.0, pad=pad, fontsize=size)


def _name(signal: ComparedSignal) -> str:
    label = SIGNALS[signal.name].label
    return label[0].upper() + label[1:]


def _size(dataset: xr.Dataset) -> str:
    step, time = _number(dataset, "step_length"), _number(dataset, "stride_time")
    return f"L = {step:.3g} m, T = {time:.4g} s"


def _number(dataset: xr.Dataset, attribute: str) -> float:
    try:
        return float(dataset.attrs[attribute])
    except (KeyError, TypeError, ValueError):
        raise GaitFileError(
            "must be there as a number",
            "give a file written by 'ergowalk solve'",
            field=f"attribute {attribute}",
        ) from None


FIGURES: dict[str, Build] = {
    OVERVIEW: _overview_page,
    "figure_02_cyclogram": _cyclogram_page,
    "figure_03_hip_angle": _curve_page(COMPARED[0]),
    "figure_04_knee_angle": _curve_page(COMPARED[1]),
    "figure_05_ankle_angle": _curve_page(COMPARED[2]),
    "figure_06_horizontal_reaction": _curve_page(COMPARED[3]),
    "figure_07_vertical_reaction": _curve_page(COMPARED[4]),
    "figure_08_hip_moment": _curve_page(COMPARED[5]),
    "figure_09_knee_moment": _curve_page(COMPARED[6]),
    "figure_10_ankle_moment": _curve_page(COMPARED[7]),
}
"""How each figure is built, by its name; the numbers are the paper's."""
