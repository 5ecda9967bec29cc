"""The numbers of a gait that stand in the index and in the map."""

from __future__ import annotations

import math
from typing import Any

from ergowalk.comparison import compare, human_of
from ergowalk.errors import InputError
from ergowalk.quantities import JOINTS
from ergowalk.solution import Solution
from ergowalk.values import as_json

INSTANTS = ("heel_end", "heel_off", "toe_tip_start", "toe_off")

AXES = ("x", "y")


def measured(solution: Solution) -> dict[str, Any]:
    """E, its parts, rhythm, peaks and distance from human walking, as plain values.

    None where a number is not known. Joints, instants and signals are parts of the names:
    ``energy_hip``, ``rhythm_toe_off``, ``human_knee_angle``.
    """
    data, problem = solution.dataset, solution.problem
    mass, gravity = problem.body.total_mass, problem.body.gravity_m_s2
    parts, rhythm = solution.energy_by_joint, solution.rhythm.as_dict()
    force = abs(data["ground_reaction_force"]).max(("time", "leg")) / (mass * gravity)
    found: dict[str, Any] = {
        "acceptable": solution.acceptable,
        "energy_per_metre": solution.energy_per_metre,
        "energy_error": _error(solution),
        "cost_of_transport": solution.cost_of_transport,
        "speed_m_s": 2 * problem.step_length_m / problem.stride_time_s,
        "step_length_m": problem.step_length_m,
        "stride_time_s": problem.stride_time_s,
        "phase_order": str(data.attrs.get("phase_order", "")),
        "iterations": int(data.attrs.get("iterations", 0)),
        "ergowalk_version": str(data.attrs.get("ergowalk_version", "")),
    }
    found |= {f"energy_{joint}": parts[joint] for joint in JOINTS}
    found |= {f"rhythm_{name}": rhythm[name] for name in INSTANTS}
    found |= {f"peak_reaction_{a}": float(force.sel(axis=a)) for a in AXES}
    for kind, name in (("moment", "joint_moment"), ("power", "joint_power")):
        peak = abs(data[name]).max(("time", "leg")) / mass
        found |= {f"peak_{kind}_{joint}": float(peak.sel(joint=joint)) for joint in JOINTS}
    found |= _human(solution)
    plain: dict[str, Any] = as_json(found)
    return plain


def _error(solution: Solution) -> float | None:
    try:
        return solution.energy_error
    except (KeyError, ValueError, TypeError):  # no record of meshes
        return None


def _human(solution: Solution) -> dict[str, float]:
    """R.m.s. distance from the human mean in SDs, by signal and over all."""
    try:
        comparison = compare(solution.dataset, human_of(solution.dataset, solution.folder))
    except InputError:  # a gait that did not converge may not bear every look
        return {}
    found = {f"human_{signal.name}": signal.rms_sd for signal in comparison.signals}
    if found:
        mean = math.fsum(d * d for d in found.values()) / len(found)
        found["human_distance"] = math.sqrt(mean)
    return found
