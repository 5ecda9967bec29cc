"""Solves what the explanations quote, and puts the tables into the pages: ``<!-- study: NAME -->``.

``python scripts/studies.py [NAME ...]`` takes minutes for each table. All but the bodies with the
printed rhythm, which leaves one phase order and the fewest local optima.
"""

from __future__ import annotations

import sys
from functools import cache

import ergowalk
from blocks import table, write_studies
from ergowalk.anthropometry import Person
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
}


if __name__ == "__main__":
    write_studies(STUDIES, sys.argv[1:])
