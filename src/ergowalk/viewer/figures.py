"""The headline figures of a gait: what a reader of a report asks first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ergowalk.quantities import JOINTS
from ergowalk.solution import Solution

Rows = list[tuple[str, str]]

_INSTANTS = {
    "heel_end": "foot flat",
    "heel_off": "heel-off",
    "toe_tip_start": "toe tip",
    "toe_off": "toe-off",
}


@dataclass(frozen=True)
class Work:
    """Work of a joint, both legs together, per metre [J/m]: ``positive`` - ``negative`` is net.

    ``positive`` + ``negative`` is the joint's part of E.
    """

    positive: float
    negative: float

    @property
    def total(self) -> float:
        """The joint's part of E [J/m]."""
        return self.positive + self.negative


def work_by_joint(solution: Solution) -> dict[str, Work]:
    """Positive and negative part of E of each joint [J/m]."""
    dataset, absolute = solution.dataset, solution.energy_by_joint
    power = dataset["joint_power"].sum("leg")
    way = 2 * float(dataset.attrs["step_length"])
    time = dataset["time"].to_numpy()
    net = {j: float(np.trapezoid(power.sel(joint=j).to_numpy(), time)) / way for j in JOINTS}
    return {j: Work((absolute[j] + net[j]) / 2, (absolute[j] - net[j]) / 2) for j in JOINTS}


def headline(solution: Solution, acceptable: bool) -> Rows:
    """Label and text of each headline figure.

    ``acceptable`` is the verdict of the audit and of the solver.
    """
    problem, body = solution.problem, solution.problem.body
    energy, error = solution.energy_per_metre, solution.energy_error
    bar = "" if error is None else f" ± {error:.2f}"
    weight = body.total_mass * body.gravity_m_s2
    speed = 2 * problem.step_length_m / problem.stride_time_s
    verdict = "acceptable" if acceptable else "NOT ACCEPTABLE"
    limits = [("with the limits", problem.conditions())]
    status = f"{verdict}: {solution.status}"
    if solution.measured:
        limits, status = [], solution.status
    return [
        ("E", f"{energy:.2f}{bar} J/m"),
        *limits,
        ("cost of transport", f"{solution.cost_of_transport:.4f} (E / M g)"),
        (
            "walk",
            f"step {problem.step_length_m:g} m, stride {problem.stride_time_s:g} s, "
            f"{speed:.3g} m/s",
        ),
        ("body", f"{body.total_mass:g} kg"),
        ("rhythm", _rhythm(solution)),
        *_peaks(solution, weight),
        ("status", status),
    ]


def _rhythm(solution: Solution) -> str:
    instants = solution.rhythm.as_dict()
    parts = [f"{name} {100 * instants[key]:.1f} %" for key, name in _INSTANTS.items()]
    return f"{', '.join(parts)} of the stride"


def _peaks(solution: Solution, weight: float) -> Rows:
    """Largest reactions [body weights], moments [N m/kg] and powers [W/kg] of any leg."""
    dataset, mass = solution.dataset, solution.problem.body.total_mass
    force = abs(dataset["ground_reaction_force"]).max(("time", "leg")) / weight
    text = {
        kind: ", ".join(
            f"{joint} {float(abs(dataset[name].sel(joint=joint)).max()) / mass:.2f}"
            for joint in JOINTS
        )
        for kind, name in (("moment", "joint_moment"), ("power", "joint_power"))
    }
    return [
        (
            "peak reaction",
            f"vertical {float(force.sel(axis='y')):.3f}, horizontal "
            f"{float(force.sel(axis='x')):.3f} body weights",
        ),
        ("peak moment", f"{text['moment']} N m/kg"),
        ("peak power", f"{text['power']} W/kg"),
    ]
