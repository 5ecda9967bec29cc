"""Solves what the explanations quote, and puts the tables into the pages: ``<!-- study: NAME -->``.

``python scripts/studies.py [NAME ...]`` takes minutes for each table. All but the bodies with the
printed rhythm, which leaves one phase order and the fewest local optima.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure

import ergowalk
import ergowalk.solving
from blocks import ROOT, table, write_studies
from ergowalk.anthropometry import Person
from ergowalk.plots import style
from ergowalk.problem import GaitProblem, JointBounds, Objective
from ergowalk.problem.scaling import for_person

PRINTED = ergowalk.preset("berbyuk2002-rhythm")


@cache
def solution(problem: GaitProblem) -> ergowalk.Solution:
    """A solved problem; says so on standard error."""
    found = ergowalk.solve(problem)
    print(f"{problem.name}: {found.status}", file=sys.stderr, flush=True)
    return found


def with_rate(limit: float, metatarsal: float | str = "off") -> GaitProblem:
    """The printed rhythm with other bounds on the rates of the moments [N m/(kg s)]."""
    rates = JointBounds(hip=limit, knee=limit, ankle=limit, metatarsal=metatarsal)
    return PRINTED.replace(limits=PRINTED.limits.replace(moment_rate_nm_per_kg_s=rates))


def moment_rate() -> str:
    """E against the bound on the rate of the moments at hip, knee and ankle."""
    rows = []
    for limit in (18.0, 25.0, 35.0, 50.0):
        found = solution(with_rate(limit))
        rows.append((f"{limit:g}", *_energies(found), _verdict(found)))
    return table(("bound [N m/(kg s)]", "E [J/m]", "on a finer mesh", "acceptable"), rows)


def caps() -> str:
    """E on three meshes with limits on forces and moments, but none on the rate of the moments."""
    off = JointBounds()
    moments = JointBounds(hip=2.0, knee=2.0, ankle=2.5)
    cases = {
        "R_y and friction": PRINTED.limits.replace(moment_rate_nm_per_kg_s=off),
        "R_y, friction, moments of 2, 2, 2.5 N m/kg": PRINTED.limits.replace(
            moment_rate_nm_per_kg_s=off, moment_nm_per_kg=moments
        ),
        "R_y, friction, moment rates of 25 N m/(kg s)": PRINTED.limits,
    }
    rows = [
        (name, _on_meshes(solution(PRINTED.replace(limits=limits))))
        for name, limits in cases.items()
    ]
    return table(("limits", "E [J/m] on elements"), rows)


def landing() -> str:
    """E on three meshes, the metatarsal moment free to jump when the other heel lands, or not."""
    cases = {
        "may jump (no bound on its rate)": with_rate(25.0),
        "continuous (bound of 1000 N m/(kg s))": with_rate(25.0, metatarsal=1000.0),
    }
    rows = [(name, _on_meshes(solution(problem))) for name, problem in cases.items()]
    return table(("metatarsal moment when the other heel lands", "E [J/m] on elements"), rows)


def objectives() -> str:
    """E and the value of other objectives where they are least."""
    table_of = {
        "E (10)": Objective(),
        "muscle work": Objective(absolute_work=0.0, muscle_work=1.0),
        "squared moments": Objective(absolute_work=0.0, moment_squared_s_per_m2=1.0),
        "E and squared rates": Objective(moment_rate_squared_s3_per_m2=0.0005),
    }
    rows = []
    for name, objective in table_of.items():
        found = solution(PRINTED.replace(objective=objective))
        value = f"{found.objective_per_metre:.1f}"
        rows.append((name, objective.sentence(), value, _energies(found)[0], _verdict(found)))
    return table(("least", "objective", "its value [J/m]", "E [J/m]", "acceptable"), rows)


def foot_length() -> str:
    """E against |HM|, which the paper does not give."""
    rows = []
    for length in (0.17, 0.20, 0.23):
        body = PRINTED.body.replace(heel_to_metatarsal_m=length)
        found = solution(PRINTED.replace(body=body))
        height = f"{body.leg(0).ankle_height:.3f}"
        rows.append((f"{length:.2f}", height, _energies(found)[0], _verdict(found)))
    return table(("l_h [m]", "ankle height [m]", "E [J/m]", "acceptable"), rows)


def bodies() -> str:
    """E of people of several sizes, as ``ergowalk init`` states their problems."""
    people = (
        Person(height_m=1.55, mass_kg=50, sex="female"),
        Person(height_m=1.75, mass_kg=72, sex="male"),
        Person(height_m=1.75, mass_kg=72),
        Person(height_m=1.95, mass_kg=100, sex="male"),
    )
    rows = []
    for person in people:
        found = solution(for_person(ergowalk.preset("berbyuk2002"), person))
        problem = found.problem
        rows.append(
            (
                person.words,
                f"{problem.step_length_m:g}",
                f"{problem.stride_time_s:g}",
                _energies(found)[0],
                f"{found.cost_of_transport:.3f}",
                "accepted" if found.audit().accepted else "failed",
            )
        )
    return table(("person", "L [m]", "T [s]", "E [J/m]", "E / M g", "audit"), rows)


STIFFNESS = "devices.ankle.stiffness_nm_per_rad"
SCANNED = (*(200.0 + 50.0 * k for k in range(8)), *(600.0 + 25.0 * k for k in range(7)))
"""Stiffnesses [N m/rad] that are tried one by one."""


def ankle_stiffness() -> str:
    """The stiffness of an elastic ankle as a free number, and E at fifteen that are held."""
    base = ergowalk.preset("ankle-exoskeleton")
    start = solution(base)
    free = base.replace(design={STIFFNESS: (100.0, 1500.0)})
    found = ergowalk.solve(free, start=start)
    print(f"free: {found.status}", file=sys.stderr, flush=True)
    return stiffness_told(found, ergowalk.follow(start, STIFFNESS, SCANNED))


def stiffness_told(found: ergowalk.Solution, scan: Sequence[ergowalk.solving.Waypoint]) -> str:
    """The table of that study; its picture goes to docs/assets."""
    stiffness = np.array([waypoint.value for waypoint in scan])
    energy = np.array([waypoint.solution.energy_per_metre for waypoint in scan])
    (number,) = found.design
    best, least = vertex(stiffness, energy)
    optimum = (number["value"], found.energy_per_metre)
    style.save(draw_scan(stiffness, energy, optimum), ROOT / "docs" / "assets" / "design.png")
    rows = [(f"{w.value:g}", *_energies(w.solution), _verdict(w.solution)) for w in scan]
    rows.append((f"**free: {optimum[0]:.1f}**", *_energies(found), _verdict(found)))
    rows.append((f"vertex of the scan: {best:.1f}", f"{least:.1f}", "", ""))
    return table(("stiffness [N m/rad]", "E [J/m]", "on a finer mesh", "acceptable"), rows)


def vertex(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Where the parabola through the lowest point and its neighbours is least, and its value."""
    k = min(max(int(np.argmin(y)), 1), len(x) - 2)
    a, b, c = np.polyfit(x[k - 1 : k + 2] - x[k], y[k - 1 : k + 2], 2)
    return float(x[k] - b / (2 * a)), float(c - b**2 / (4 * a))


def draw_scan(x: np.ndarray, y: np.ndarray, optimum: tuple[float, float]) -> Figure:
    """E over the stiffness, and the optimum as a free number."""
    with style.styled():
        figure = Figure(figsize=(6.0, 3.6), layout="constrained")
        axes = figure.add_subplot()
        axes.plot(x, y, "o-", color=style.FAINT, ms=4, lw=1, label="held, one solve each")
        axes.plot(*optimum, "o", color=style.LEG_2, ms=8, label="found with the gait")
        axes.axvline(optimum[0], color=style.LEG_2, lw=0.6, ls=":")
        axes.set_xlabel("stiffness of the ankle spring [N m/rad]")
        axes.set_ylabel("E [J/m]")
        axes.set_title("Elastic ankle: fifteen stiffnesses, and the one that is found")
        axes.legend()
    return figure


def _on_meshes(found: ergowalk.Solution) -> str:
    cells = [f"{m['energy_per_metre']:.1f} on {m['elements']}" for m in found.mesh_history]
    return ", ".join(cells)


def _energies(found: ergowalk.Solution) -> tuple[str, str]:
    finer = [m["energy_per_metre"] for m in found.mesh_history if m.get("finer")]
    return f"{found.energy_per_metre:.1f}", f"{finer[0]:.1f}" if finer else "-"


def _verdict(found: ergowalk.Solution) -> str:
    return "yes" if found.acceptable else "no"


STUDIES = {
    "caps": caps,
    "moment rate": moment_rate,
    "landing": landing,
    "foot length": foot_length,
    "bodies": bodies,
    "objectives": objectives,
    "ankle stiffness": ankle_stiffness,
}


if __name__ == "__main__":
    write_studies(STUDIES, sys.argv[1:])
