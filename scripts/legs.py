"""Legs that differ: ``python scripts/legs.py FOLDER``.

Solves the cases of the page "Legs that differ" from the gait of equal legs, keeps them in FOLDER
(those already there are not solved again), fills ``<!-- study: legs -->`` and
``<!-- study: legs, steps -->``, and draws ``docs/assets/legs.png``.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import ergowalk
from blocks import ROOT, publish, table
from ergowalk.plots import style
from ergowalk.problem import GaitProblem
from ergowalk.problem.legs import Stride
from ergowalk.quantities import JOINTS

PAPER = ergowalk.preset("berbyuk2002")
BODY = PAPER.body


def _changed(name: str, **changes: object) -> GaitProblem:
    changed: GaitProblem = PAPER.replace(name=name, **changes)
    return changed


LOCK = {"leg_2": {"ankle": {"kind": "locked", "own_moment": False}}}
WIDE = {"leg_2": {"width_sd": 2.0, "ankle_width_sd": "off"}}

CASES = {
    "equal legs": _changed("equal legs", stride=Stride(legs="each")),
    "foot of leg 2 heavier by 1 kg": _changed(
        "heavier foot", body=BODY.replace(foot_mass_kg=(1.24, 2.24))
    ),
    "shank of leg 2 shorter by 2 cm": _changed(
        "shorter shank", body=BODY.replace(shank_length_m=(0.53, 0.51))
    ),
    "the same, corridors of 2 SD": _changed(
        "shorter shank, wide",
        body=BODY.replace(shank_length_m=(0.53, 0.51)),
        corridors=PAPER.corridors.replace(width_sd=2.0),
    ),
    "equal legs, corridors of leg 2 wide": _changed("wide", corridors={"leg_2": WIDE["leg_2"]}),
    "the same, ankle of leg 2 locked at 0°": _changed("lock", corridors=WIDE, devices=LOCK),
    **{
        name: ergowalk.preset(name)
        for name in ("ankle-foot-orthosis", "below-knee-prosthesis", "above-knee-prosthesis")
    },
}


def solved(folder: Path) -> dict[str, ergowalk.Solution]:
    """The gaits of all cases, from the gait of equal legs where that can be used."""
    folder.mkdir(parents=True, exist_ok=True)
    found: dict[str, ergowalk.Solution] = {}
    start = _kept(folder / "start.nc", PAPER, None)
    for i, (name, problem) in enumerate(CASES.items()):
        begin = None if any(problem.devices.everything()) else start
        found[name] = _kept(folder / f"{i}.nc", problem, begin)
        print(f"{name}: {found[name].status}", file=sys.stderr, flush=True)
    return found


def _kept(path: Path, problem: GaitProblem, start: ergowalk.Solution | None) -> ergowalk.Solution:
    if path.exists():
        gait = ergowalk.Solution.load(path)
        if gait.problem.replace(folder=None) == problem:
            return gait
    gait = ergowalk.solve(problem, start=start)
    gait.save(path)
    return gait


def energies(found: dict[str, ergowalk.Solution]) -> str:
    """E, and its part of each joint of the sound leg 1 and of leg 2."""
    rows = []
    for name, gait in found.items():
        legs = gait.energy_by_leg
        parts = [f"{leg[joint]:.1f}" for leg in legs for joint in JOINTS]
        verdict = "" if gait.acceptable else ", not acceptable"
        rows.append((name + verdict, f"{gait.energy_per_metre:.2f}", *parts))
    heads = [f"{joint} {leg}" for leg in (1, 2) for joint in JOINTS]
    return table(("leg 2", "E [J/m]", *heads), rows)


def steps(found: dict[str, ergowalk.Solution]) -> str:
    """Steps, and contact instants of both legs in percent of the stride."""
    rows = []
    for name, gait in found.items():
        (l_1, l_2), (t_1, t_2) = gait.step_lengths, gait.step_times
        instants = [
            " / ".join(f"{100 * getattr(rhythm, i):.1f}" for rhythm in gait.rhythms)
            for i in ("heel_end", "heel_off", "toe_off")
        ]
        rows.append(
            (
                name,
                f"{100 * (l_1 - l_2) / (l_1 + l_2):+.1f}",
                f"{100 * (t_1 - t_2) / (t_1 + t_2):+.1f}",
                *instants,
            )
        )
    heads = ("asymmetry of length [%]", "of time [%]", "foot flat", "heel-off", "toe-off")
    return table(("leg 2", *heads), rows)


def draw(found: dict[str, ergowalk.Solution], target: Path) -> None:
    """Parts of E by leg and joint, one pair of bars a case."""
    colours = dict(zip(JOINTS, ("#0072B2", "#E69F00", "#009E73", "#CC79A7"), strict=True))
    figure = Figure(figsize=(9.0, 0.62 * len(found) + 1.2))
    axes = figure.add_axes((0.33, 0.12, 0.65, 0.8))
    for row, gait in enumerate(found.values()):
        for leg, parts in enumerate(gait.energy_by_leg):
            left = 0.0
            for joint in JOINTS:
                at = row + (leg - 0.5) * 0.38
                label = joint if row == leg == 0 else None
                axes.barh(at, parts[joint], 0.34, left, color=colours[joint], label=label)
                left += parts[joint]
            axes.text(left + 0.4, at, f"leg {leg + 1}", va="center", fontsize=7)
    axes.set_yticks(np.arange(len(found)), list(found), fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("absolute work of the own moments [J/m]")
    axes.legend(loc="upper right", frameon=False, fontsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(target, dpi=150)


def main(arguments: list[str]) -> int:
    """Solve, fill the blocks, draw."""
    if len(arguments) != 1:
        print(__doc__)
        return 2
    found = solved(Path(arguments[0]))
    blocks = {"legs": energies(found), "legs, steps": steps(found)}
    with style.styled():
        draw(found, ROOT / "docs" / "assets" / "legs.png")
    publish("study", blocks)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
