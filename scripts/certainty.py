"""Tables of "How sure is this number?": ``python scripts/certainty.py [NAME ...]``.

Meshes halved everywhere; a path of gaits against its prices; searches from
seeded starts. Minutes each. The environment variable STARTS sets how many starts there are; with
KEPT, a folder, each gait is left there as it is found, and not sought again.
"""

from __future__ import annotations

import json
import os
import sys
from functools import cache
from pathlib import Path

import numpy as np

import ergowalk
from blocks import table, write_studies
from ergowalk.solving.answer import dense_energy, dense_gait
from ergowalk.solving.memory import recall
from ergowalk.solving.stages import OrderSearch, StageResult
from ergowalk.solving.starts import catalogued, solve_start
from ergowalk.transcription.mesh import finer

HALVINGS = 2
STARTS, SEED = int(os.environ.get("STARTS", "10")), 1
KEPT = Path(os.environ["KEPT"]) if "KEPT" in os.environ else None


@cache
def solution(name: str) -> ergowalk.Solution:
    """A solved preset; says so on standard error."""
    found = ergowalk.solve(ergowalk.preset(name))
    print(f"{name}: {found.status}", file=sys.stderr, flush=True)
    return found


def halved() -> str:
    """E when every element is halved, and halved again, beside the error bar of the answer."""
    rows = []
    for name in ("berbyuk2002", "berbyuk2002-rhythm"):
        found = solution(name)
        search, stage = recall(found)
        cells = [f"{found.energy_per_metre:.2f} on {stage.elements}"]
        for _ in range(HALVINGS):
            stage = _halved(search, stage)
            energy = _energy(search, stage)
            change = 100 * (energy / found.energy_per_metre - 1)
            mark = "" if stage.minimum.converged else ", not converged"
            cells.append(f"{energy:.2f} ({change:+.2f} %) on {stage.elements}{mark}")
        error = found.energy_error
        bar = "-" if error is None else f"{error:.2f} ({error / found.energy_per_metre:.2%})"
        rows.append((f"`{name}`", *cells, bar))
    header = ("preset", "E [J/m], elements", "all halved", "all halved twice", "error bar [J/m]")
    return table(header, rows)


def _halved(search: OrderSearch, stage: StageResult) -> StageResult:
    """The same gait with every element halved."""
    errors = [np.ones(len(edges) - 1) for edges in stage.collocation.mesh]
    return search.refined(stage, finer(stage.collocation.mesh, errors, share=1.0), 1.0)


def _energy(search: OrderSearch, stage: StageResult) -> float:
    dataset = dense_gait(search.problem, search.halves, stage.trajectory)
    return dense_energy(dataset, search.problem.step_length_m)


def path() -> str:
    """E along a path, found and foretold by the price at the gait before."""
    start = solution("berbyuk2002")
    rows = []
    for name, values in (
        ("step_length_m", (0.78, 0.80)),
        ("corridors.width_sd", (1.1, 1.25)),
        ("limits.vertical_reaction_body_weights", (1.25, 1.2)),
    ):
        for waypoint in ergowalk.follow(start, name, values):
            found = waypoint.solution
            rows.append(
                (
                    f"`{name}`",
                    f"{waypoint.value:g}",
                    f"{waypoint.predicted:.2f}",
                    f"{found.energy_per_metre:.2f}",
                    str(found.dataset.attrs["iterations"]),
                    "yes" if found.acceptable else "no",
                )
            )
    header = ("number", "value", "E foretold [J/m]", "E found [J/m]", "iterations", "acceptable")
    return table(header, rows)


def starts() -> str:
    """Distinct optima from seeded starts of the default problem."""
    problem = ergowalk.preset("berbyuk2002")
    if KEPT is None:
        found = ergowalk.solve(problem, starts=STARTS, seed=SEED)
        catalogue = json.loads(str(found.dataset.attrs["starts"]))
    else:
        catalogue = json.loads(catalogued(_kept_starts(problem, KEPT), SEED).as_json())
    best = catalogue["optima"][0]["energy_per_metre"]
    print(catalogue, file=sys.stderr, flush=True)
    rows = [
        (
            f"{o['energy_per_metre']:.2f} ({100 * (o['energy_per_metre'] / best - 1):+.1f} %)",
            str(o["hits"]),
            o["phase_order"],
            f"{o['distance_deg']:.1f}",
        )
        for o in catalogue["optima"]
    ]
    header = ("E [J/m], best of its kind", "starts that end there", "phase order")
    summary = (
        f"{catalogue['starts']} starts with seed {catalogue['seed']}: "
        f"{catalogue['converged']} converge, {catalogue['accepted']} are accepted by the audit."
    )
    return f"{summary}\n\n" + table((*header, "distance from the first [deg r.m.s.]"), rows)


def _kept_starts(problem: ergowalk.GaitProblem, folder: Path) -> list[ergowalk.Solution]:
    """The gaits of all starts, one after the other; those that are there already are read."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for i in range(STARTS):
        path = folder / f"{i}.nc"
        if not path.exists():
            solve_start(problem, SEED, i, None, str(folder))
        found.append(ergowalk.Solution.load(path))
    return found


STUDIES = {
    "halved meshes": halved,
    "path": path,
    "starts": starts,
}


if __name__ == "__main__":
    write_studies(STUDIES, sys.argv[1:])
