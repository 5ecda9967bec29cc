"""The command ``price``: what every bound and every given number of a gait costs."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from ergowalk.cli.output import result_folder
from ergowalk.cli.streams import emit, emit_json
from ergowalk.errors import InputError
from ergowalk.solution import Solution

if TYPE_CHECKING:
    from ergowalk.solving.prices import Prices

FIGURE = "prices"


def run_price(arguments: Namespace) -> None:
    """Print the price list of a gait and draw it beside the gait, or in the folder asked for.

    Raises
    ------
    GaitFileError
        If the file is no gait that can be read, or keeps no multipliers.
    OutputError
        If the figures cannot be written.
    """
    from ergowalk.plots import style
    from ergowalk.plots.prices import draw_prices
    from ergowalk.solving.prices import prices

    path: Path = arguments.gait
    solution = Solution.load(path)
    try:
        found = prices(solution)
    except InputError as error:
        raise error.located(str(path)) from None
    folder = arguments.output or path.parent
    corridors = found.corridors
    figure = draw_prices(
        [(price.name, price.elasticity) for price in found.numbers],
        corridors.fraction,
        corridors.width,
        corridors.rows(),
    )
    files = [f"{FIGURE}.{kind}" for kind in style.FORMATS]
    with result_folder(folder, files):
        drawn = [style.save(figure, folder / file) for file in files]
    if arguments.json:
        emit_json({"file": str(path), **_as_dict(found), "figures": [str(p) for p in drawn]})
    else:
        names = ", ".join(p.name for p in drawn)
        emit(f"{path}: {_sentence(solution)}\n{_table(found)}\nfigures: {folder}: {names}")


def _sentence(solution: Solution) -> str:
    return f"E = {solution.energy_per_metre:.2f} J/m with {solution.problem.conditions()}"


def _as_dict(found: Prices) -> dict[str, object]:
    return {
        "energy_per_metre": found.energy_per_metre,
        "numbers": [vars(price) for price in found.numbers],
        "corridor_j_per_m_per_degree": {
            joint: found.corridors.total(joint) for joint in found.corridors.lower
        },
    }


def _table(found: Prices) -> str:
    width = max(len(price.name) for price in found.numbers)
    head = f"{'given number':<{width}}  {'value':>9}  {'dE per unit':>11}  {'%E per %':>8}"
    lines = [head] + [
        f"{p.name:<{width}}  {p.value:9.4g}  {p.slope:11.4g}  {p.elasticity:8.3f}"
        for p in found.numbers
    ]
    lines.append("both edges of a corridor one degree wider, over the whole stride, save")
    lines += [
        f"  {joint:<{width - 2}}  {found.corridors.total(joint):9.4g} J/m"
        for joint in found.corridors.lower
    ]
    return "\n".join(lines)
