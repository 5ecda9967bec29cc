"""The command ``map``: E over what was swept, as figures and as a page."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ergowalk.cli.output import result_folder, write_text
from ergowalk.cli.streams import emit, emit_json, note
from ergowalk.errors import InputError, SweepError

if TYPE_CHECKING:
    import xarray as xr

FIGURE, PAGE = "map", "map.html"

MOST_GAITS = 400
"""Gaits that a page takes: each is about 60 kB."""


def run_map(arguments: Namespace) -> None:
    """Draw a sweep in its folder, or in the one asked for, and print what was found.

    Raises
    ------
    SweepError
        If there is no such sweep, or it is not one that a map can show.
    OutputError
        If the files cannot be written.
    """
    from ergowalk.plots import style
    from ergowalk.plots.maps import draw_map
    from ergowalk.study import collect
    from ergowalk.study.landscape import chosen, landscape, payload

    folder: Path = arguments.folder
    target: Path = arguments.output or folder
    try:
        dataset = chosen(collect(folder, arguments.sweep), _choices(arguments.at))
        found = landscape(dataset)
    except InputError as error:
        raise error.located(str(folder)) from None
    title = f"{dataset.attrs['title']}: {int(found.accepted.sum())} of {found.x.size} cases"
    files = [f"{FIGURE}.{kind}" for kind in style.FORMATS]
    with result_folder(target, [*files, PAGE]):
        figure = draw_map(found, title)
        written = [style.save(figure, target / file) for file in files]
        if not arguments.no_page:
            from ergowalk.viewer import map_html

            page = map_html(payload(found, dataset), _gaits(dataset, folder), title)
            write_text(target / PAGE, page)
            written.append(target / PAGE)
    valley = [dict(zip(_VALLEY, map(float, row), strict=True)) for row in found.valley]
    if arguments.json:
        emit_json(
            {
                "sweep": dataset.attrs["sweep"],
                "cases": int(found.x.size),
                "accepted": int(found.accepted.sum()),
                "valley": valley,
                "files": [str(path) for path in written],
            }
        )
    else:
        names = ", ".join(path.name for path in written)
        emit("\n".join([title, *_table(valley), f"map: {target}: {names}"]))


_VALLEY = (
    "speed_m_s",
    "step_length_m",
    "stride_time_s",
    "energy_per_metre",
    "shortest_alike_m",
    "longest_alike_m",
)


def _choices(given: list[str]) -> dict[str, str]:
    found = {}
    for text in given:
        field, equals, value = text.partition("=")
        if not equals or not field:
            raise SweepError(
                "names no field and value", "write FIELD=VALUE", field="--at", value=text
            )
        found[field] = value
    return found


def _gaits(dataset: xr.Dataset, folder: Path) -> dict[str, str]:
    """The gaits of the page by key; of very many, an even selection."""
    from ergowalk.comparison import human_of
    from ergowalk.solution import Solution
    from ergowalk.viewer import gait_payload, packed

    kept = dataset["acceptable"].to_numpy().ravel() == 1
    keys = [str(key) for key in dataset["key"].to_numpy().ravel()[kept]]
    if len(keys) > MOST_GAITS:
        note(f"ergowalk: the page shows {MOST_GAITS} of {len(keys)} gaits in motion")
        keys = [keys[i * len(keys) // MOST_GAITS] for i in range(MOST_GAITS)]
    found, lost = {}, 0
    for key in keys:
        path = folder / "cases" / key[:2] / f"{key}.nc"
        try:
            gait = Solution.load(path)
            label = f"{_name(gait)}, E = {gait.energy_per_metre:.2f} J/m"
            human = human_of(gait.dataset, path.parent)
            found[key] = packed(gait_payload(gait.dataset, human, label))
        except InputError:
            lost += 1
    if lost:
        note(f"ergowalk: {lost} gaits cannot be read, and are not in the page")
    return found


def _name(gait: Any) -> str:
    return f"L = {gait.problem.step_length_m:g} m, T = {gait.problem.stride_time_s:g} s"


def _table(valley: list[dict[str, float]]) -> list[str]:
    """The valley at round speeds."""
    if not valley:
        return []
    lines = ["cheapest at a speed:  step length  stride time  cadence      E"]
    for row in valley:
        speed, time = row["speed_m_s"], row["stride_time_s"]
        if abs(10 * speed - round(10 * speed)) < 1e-6:
            lines.append(
                f"{speed:12.2f} m/s  {row['step_length_m']:12.3f} m  {time:9.3f} s  "
                f"{120 / time:3.0f}/min  {row['energy_per_metre']:.2f} J/m"
            )
    return lines
