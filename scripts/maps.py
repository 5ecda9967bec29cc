"""The map of the documentation: ``python scripts/maps.py FOLDER [NAME]``.

FOLDER is that of the sweep ``scripts/sweeps/NAME.toml`` (natural by default), as
``ergowalk sweep scripts/sweeps/natural.toml -o FOLDER`` leaves it. Draws
``docs/assets/map-NAME.png`` and fills the blocks ``<!-- study: map NAME, valley -->`` and
``<!-- study: map NAME, cases -->`` of the pages, the second with how smooth E is.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from blocks import ROOT, publish, table
from ergowalk.plots import style
from ergowalk.plots.maps import Landscape, draw_map
from ergowalk.study import collect
from ergowalk.study.landscape import landscape
from ergowalk.study.looks import Looks
from ergowalk.study.store import Store

Array = NDArray[np.float64]

EVERY = 0.1
"""Between the speeds of the table [m/s]."""


def valley(found: Landscape) -> str:
    """The cheapest walk at round speeds, and the steps of people there."""
    rows = []
    for speed, length, time, energy, short, long in found.valley:
        if abs(speed / EVERY - round(speed / EVERY)) > 1e-6:
            continue
        people = "-"
        if len(found.people):
            at, cadence, sd = found.people.T
            if at[0] <= speed <= at[-1]:
                people = f"{np.interp(speed, at, cadence):.0f} ± {np.interp(speed, at, sd):.0f}"
        rows.append(
            (
                f"{speed:.1f}",
                f"{length:.3f}",
                f"{short:.2f} to {long:.2f}",
                f"{time:.3f}",
                f"{120 / time:.0f}",
                people,
                f"{energy:.2f}",
            )
        )
    head = (
        "speed [m/s]",
        "L [m]",
        "within 0.5 %",
        "T [s]",
        "cadence [1/min]",
        "people, scaled",
        "E [J/m]",
    )
    return table(head, rows)


def cases(folder: Path, dataset: xr.Dataset) -> str:
    """What became of the cases, what the searches cost, and how smooth E is."""
    status = Counter(dataset["status"].to_numpy().ravel().tolist())
    words = ", ".join(f"{count} {name}" for name, count in sorted(status.items()))
    store = Store(folder)
    definition = store.definition(dataset.attrs["sweep"])
    first = store.done(case["key"] for case in definition["cases"])
    probes, *rounds = [
        store.done(look.key for look in looks).values()
        for looks in Looks(definition, store.done).each_round()
    ] or [[]]
    kinds = {
        "first searches, from the gait of a neighbour": [
            r for r in first.values() if r["begun_at"]
        ],
        "first case and probes, from the human means": [
            *(r for r in first.values() if not r["begun_at"]),
            *probes,
        ],
        "second looks, from the gait of a neighbour": [r for those in rounds for r in those],
    }
    rows = []
    for name, records in kinds.items():
        cpu = [r["cpu_s"] for r in records if "cpu_s" in r]
        if cpu:
            low, middle, high = np.percentile(cpu, [25, 50, 75])
            rows.append((name, str(len(cpu)), f"{middle:.0f}", f"{low:.0f} to {high:.0f}"))
    costs = table(("searches", "number", "median CPU [s]", "half of them"), rows)
    found = dataset["energy_per_metre"].to_numpy()
    energies = [first.get(case["key"], {}).get("energy_per_metre") for case in definition["cases"]]
    whole = smoothness(np.array(energies, dtype=float).reshape(found.shape), found)
    return f"{dataset['status'].size} cases: {words}.\n\n{costs}\n\n{whole}"


def bends(energy: Array) -> Array:
    """How far each log E is above the middle of its neighbours, along rows and columns."""
    height = np.log(energy)
    both = [h[1:-1] - (h[:-2] + h[2:]) / 2 for h in (height, height.T)]
    return np.concatenate([found.ravel() for found in both])


def smoothness(first: Array, last: Array) -> str:
    """The bends of E along rows and columns of the map, as first found and after second looks."""
    rows = []
    for name, energy in (("as first found", first), ("at the end", last)):
        sizes = 100 * np.abs(bends(energy))
        figures = (np.nanmedian(sizes), np.nanpercentile(sizes, 95), np.nanmax(sizes))
        rows.append((name, *(f"{figure:.2f} %" for figure in figures)))
    lower = 100 * (1 - last / first)
    better = lower[lower > 0.01]
    words = f"Probes and second looks lowered E of {len(better)} cases"
    if len(better):
        words += f", by {np.median(better):.1f} % in the median and at most {better.max():.1f} %"
    head = ("log E above the middle of its neighbours", "median", "95 % below", "at most")
    return f"{words}.\n\n{table(head, rows)}"


def main() -> None:
    folder, name = Path(sys.argv[1]), (sys.argv[2:] or ["natural"])[0]
    dataset = collect(folder, name)
    found = landscape(dataset)
    style.save(draw_map(found), ROOT / "docs" / "assets" / f"map-{name}.png")
    texts = {f"map {name}, valley": valley(found), f"map {name}, cases": cases(folder, dataset)}
    publish("study", texts)
    for title, text in texts.items():
        print(f"-- {title}\n{text}\n")


if __name__ == "__main__":
    main()
