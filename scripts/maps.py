"""The map of the documentation: ``python scripts/maps.py FOLDER [NAME]``.

FOLDER is that of the sweep ``scripts/sweeps/NAME.toml`` (natural by default), as
``ergowalk sweep scripts/sweeps/natural.toml -o FOLDER`` leaves it. Draws
``docs/assets/map-NAME.png`` and fills the blocks ``<!-- study: map NAME, valley -->`` and
``<!-- study: map NAME, cases -->`` of the pages.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

from blocks import ROOT, fill, pages, table
from ergowalk.plots import style
from ergowalk.plots.maps import Landscape, draw_map
from ergowalk.study import collect
from ergowalk.study.landscape import landscape

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


def cases(dataset: xr.Dataset) -> str:
    """What became of the cases, and what they cost."""
    status = Counter(dataset["status"].to_numpy().ravel().tolist())
    words = ", ".join(f"{count} {name}" for name, count in sorted(status.items()))
    cpu, way = dataset["cpu_s"].to_numpy().ravel(), dataset["way"].to_numpy().ravel()
    rows = [
        (str(name), str(int((way == name).sum())), f"{np.nanmedian(cpu[way == name]):.0f}")
        for name in np.unique(way[way != ""])
    ]
    costs = table(("begun at", "cases", "median CPU [s]"), rows)
    return f"{dataset['status'].size} cases: {words}.\n\n{costs}"


def main() -> None:
    folder, name = Path(sys.argv[1]), (sys.argv[2:] or ["natural"])[0]
    dataset = collect(folder, name)
    found = landscape(dataset)
    style.save(draw_map(found), ROOT / "docs" / "assets" / f"map-{name}.png")
    texts = {f"map {name}, valley": valley(found), f"map {name}, cases": cases(dataset)}
    for page in pages():
        if fill(page, "study", texts):
            print(f"wrote {page.name}")
    for title, text in texts.items():
        print(f"-- {title}\n{text}\n")


if __name__ == "__main__":
    main()
