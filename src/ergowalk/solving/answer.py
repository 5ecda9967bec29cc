"""From the curves of a stage to a Solution with all attributes of a gait file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.audit import audit
from ergowalk.gait.rhythm import PhaseOrder, Rhythm, half_stride_phases
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.solution.energy import joint_energies
from ergowalk.solution.objective import objective_per_metre
from ergowalk.solution.stride import Piece, stride_dataset
from ergowalk.transcription.curves import Trajectory, joined
from ergowalk.transcription.motion import body_motion, device_moments, load_sharing
from ergowalk.transcription.walker import Walker

SAMPLES = 9
"""Samples of each element, both ends included."""


def dense_gait(walker: Walker, order: PhaseOrder, trajectory: Trajectory) -> xr.Dataset:
    """The curves on a dense grid: between the nodes, where a transcription cannot hide."""
    walker = walker.at(trajectory.shared)
    longest = walker.problem.stride_time_s / 400
    pieces, last = [], 0.0
    phases = half_stride_phases(order)
    for phase, curves in zip(phases, trajectory.phases, strict=True):
        edges = curves.start + curves.duration * curves.fractions
        edges[0] = last  # where the phase before has ended, to the last digit
        if phase is phases[-1]:
            edges[-1] = walker.problem.stride_time_s / 2
        last = float(edges[-1])
        time, samples = [], []
        for k, width in enumerate(np.diff(edges)):
            count = max(SAMPLES, int(np.ceil(width / longest)) + 1)
            time.append(np.linspace(edges[k], edges[k + 1], count))
            samples.append(curves.in_element(k, np.linspace(0.0, 1.0, count)))
        dense = joined(samples)
        motion = body_motion(walker, phase, dense)
        sharing = load_sharing(walker, phase, dense, motion)
        devices = device_moments(walker, phase, dense, motion)
        pieces.append(Piece(np.concatenate(time), phase.legs, motion, sharing, devices))
    return stride_dataset(walker.problem, pieces)


def dense_energy(dataset: xr.Dataset, step_length: float) -> float:
    """E of (10) [J/m] from the dense curves."""
    return sum(joint_energies(dataset).values()) / (2 * step_length)


def minimised(dataset: xr.Dataset, problem: GaitProblem) -> float:
    """The objective [J/m] from the dense curves; E of (10) to the last digit where it is that."""
    if problem.objective.is_eq10:
        return dense_energy(dataset, problem.step_length_m)
    try:
        return objective_per_metre(dataset, problem)
    except ValueError:  # a motion out of reach has no such integral
        return float("nan")


def rhythm_of(trajectory: Trajectory, stride: float) -> Rhythm:
    """Contact instants as fractions of T."""
    times = trajectory.times
    return Rhythm(
        heel_end=times["heel_end"] / stride,
        heel_off=times["heel_off"] / stride,
        toe_off=times["other_toe_off"] / stride + 0.5,
    )


def describe(
    dataset: xr.Dataset,
    problem: GaitProblem,
    rhythm: Rhythm,
    *,
    energy: float,
    method: str,
    status: str,
    history: list[dict[str, Any]],
    extra: dict[str, Any],
) -> xr.Dataset:
    """The dataset with the global attributes of a gait file, ``acceptable`` still 0."""
    from ergowalk import __version__

    return dataset.assign_attrs(
        {
            "title": f"energy-optimal gait, problem {problem.name}",
            "energy_per_metre": energy,
            "objective_per_metre": energy
            if problem.objective.is_eq10
            else minimised(dataset, problem),
            "step_length": problem.step_length_m,
            "stride_time": problem.stride_time_s,
            "method": method,
            "solver_status": status,
            "acceptable": 0,
            "rhythm": json.dumps(rhythm.as_dict()),
            "body_parameters": json.dumps(problem.body.by_symbol()),
            "problem": problem_to_toml(problem),
            "limits": problem.conditions(),
            "mesh_history": json.dumps(history),
            "ergowalk_version": __version__,
            **extra,
        }
    )


def judged(dataset: xr.Dataset, settled: bool, folder: Path | None) -> Solution:
    """The solution with its verdict: the solver ``settled`` and every line of the audit holds."""
    report = audit(dataset, folder)
    status = dataset.attrs["solver_status"]
    if settled and not report.accepted:
        failed = ", ".join(line.key for line in report.failed)
        status += f"; the audit rejects it: {failed}"
    accepted = settled and report.accepted
    verdict = dataset.assign_attrs(solver_status=status, acceptable=int(accepted))
    return Solution(verdict, folder)
