"""What people choose and what is cheapest: ``python scripts/preferred.py FOLDER``.

The preferred step length at some speeds for three criteria, each gait with corridors of three
standard deviations, beside the 43 adults of Fukuchi et al. (2018), scaled to the walker's legs, and
beside Winter's three cadences. Each answer is kept in FOLDER as it is found, and not sought again.
Fills ``<!-- study: preferred -->`` and draws ``docs/assets/preferred.png``.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import ergowalk
from blocks import ROOT, publish, table
from ergowalk.errors import InputError
from ergowalk.plots import style
from ergowalk.problem import Corridors, GaitProblem, Objective
from ergowalk.study import steps_of_people
from ergowalk.study.people import leg_length
from ergowalk.study.preference import preferred

CRITERIA = {
    "absolute work (10)": Objective(),
    "work and squared moment rates": Objective(moment_rate_squared_s3_per_m2=0.0005),
    "squared moments": Objective(absolute_work=0.0, moment_squared_s_per_m2=1.0),
}
WINTER = {"slow": (0.69, 1.40), "natural": (0.755, 1.1396), "fast": (0.82, 0.97)}
"""Step length [m] and stride time [s] of Winter's cadences, as the presets state them."""

SPEEDS = tuple(round(2 * length / time, 4) for length, time in WINTER.values())
BASE = ergowalk.preset("winter-natural").replace(corridors=Corridors(width_sd=3.0))


def found(folder: Path, name: str, objective: Objective) -> list[dict[str, Any]]:
    """The preferred walk at each speed; natural first, the others begin with its gait."""
    kept, answers, start = folder / f"{list(CRITERIA).index(name)}.json", {}, None
    if kept.exists():
        answers = json.loads(kept.read_text("utf-8"))
    problem: GaitProblem = BASE.replace(name=name, objective=objective)
    gait = folder / f"{list(CRITERIA).index(name)}.nc"
    for speed in (SPEEDS[1], SPEEDS[0], SPEEDS[2]):
        if gait.exists():
            start = ergowalk.Solution.load(gait)
        if str(speed) in answers:
            continue
        try:
            best = preferred(problem, speed, start=start)
        except InputError as error:
            answers[str(speed)] = {"speed": speed, "status": str(error)}
        else:
            if speed == SPEEDS[1]:
                best.gait.save(gait)
            answers[str(speed)] = {
                "speed": speed,
                "step_length": best.step_length,
                "cadence": best.cadence,
                "energy": best.gait.energy_per_metre,
                "found": best.found,
                "gaits": len(best.trials),
                "status": best.status,
            }
        kept.write_text(json.dumps(answers, indent=1), "utf-8")
        print(f"{name}: {answers[str(speed)]}", file=sys.stderr, flush=True)
    return [answers[str(speed)] for speed in SPEEDS]


def compared(everything: dict[str, list[dict[str, Any]]]) -> str:
    """Predicted step length and cadence, and by how much they miss people's."""
    people = steps_of_people(SPEEDS, leg_length(BASE.body))
    rows = []
    for name, answers in everything.items():
        for k, (answer, (length, time)) in enumerate(zip(answers, WINTER.values(), strict=True)):
            if "step_length" not in answer:
                rows.append((name, f"{SPEEDS[k]:.2f}", answer["status"], "", "", "", ""))
                continue
            step, cadence = answer["step_length"], answer["cadence"]
            miss = [
                f"{100 * (step / other - 1):+.0f} % / {100 * (cadence / pace - 1):+.0f} %"
                for other, pace in (
                    (people.step_length[k], people.cadence[k]),
                    (length, 120 / time),
                )
            ]
            mark = "" if answer["found"] else " (no minimum)"
            words = (f"{step:.3f}{mark}", f"{cadence:.0f}", f"{answer['energy']:.1f}")
            rows.append((name, f"{SPEEDS[k]:.2f}", *words, *miss))
    header = ("least", "speed [m/s]", "step [m]", "steps/min", "E [J/m]")
    return table((*header, "from the 43, step / cadence", "from Winter"), rows)


def draw(everything: dict[str, list[dict[str, Any]]], target: Path) -> None:
    """Step length against speed: people's band, Winter's cadences, the criteria."""
    figure = Figure(figsize=(6.5, 4.2))
    axes = figure.add_axes((0.11, 0.13, 0.86, 0.84))
    speeds = np.linspace(0.8, 1.9, 60)
    people = steps_of_people(speeds, leg_length(BASE.body))
    low, high = (people.step_length + sign * people.step_length_sd for sign in (-1, 1))
    label = "43 adults, scaled, mean ± SD"
    axes.fill_between(speeds, low, high, color=style.BAND, linewidth=0, label=label)
    axes.plot(speeds, people.step_length, "--", color=style.HUMAN)
    lengths = [length for length, _ in WINTER.values()]
    axes.plot(SPEEDS, lengths, "k*", markersize=9, label="Winter's cadences")
    for (name, answers), colour in zip(
        everything.items(), ("#0072B2", "#D55E00", "#009E73"), strict=True
    ):
        known = [a for a in answers if "step_length" in a]
        x, y = [a["speed"] for a in known], [a["step_length"] for a in known]
        axes.plot(x, y, "o-", color=colour, label=f"least {name}")
    axes.set_xlabel("speed [m/s]")
    axes.set_ylabel("step length [m]")
    axes.legend(frameon=False, fontsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(target, dpi=150)


def main(arguments: list[str]) -> int:
    """Search, fill the block, draw."""
    if len(arguments) != 1:
        print(__doc__)
        return 2
    folder = Path(arguments[0])
    folder.mkdir(parents=True, exist_ok=True)
    everything = {name: found(folder, name, objective) for name, objective in CRITERIA.items()}
    with style.styled():
        draw(everything, ROOT / "docs" / "assets" / "preferred.png")
    text = compared(everything)
    print(text)
    publish("study", {"preferred": text})
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
