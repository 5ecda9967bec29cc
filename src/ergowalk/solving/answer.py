"""From the curves of a stage to a Solution with all attributes of a gait file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.audit import audit
from ergowalk.gait.rhythm import Rhythm
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.solution.energy import joint_energies
from ergowalk.solution.objective import objective_per_metre
from ergowalk.solution.stride import Piece, stride_dataset
from ergowalk.transcription.curves import Trajectory, joined
from ergowalk.transcription.halves import Half, in_phases
from ergowalk.transcription.motion import body_motion, device_moments, load_sharing
from ergowalk.transcription.steps import STEP_1

SAMPLES = 9
"""Samples of each element, both ends included."""


def dense_gait(problem: GaitProblem, halves: Sequence[Half], trajectory: Trajectory) -> xr.Dataset:
    """The curves on a dense grid: between the nodes, where a transcription cannot hide."""
    stride = problem.stride_time_s
    longest, ends = stride / 400, step_times(halves, trajectory, stride)
    pieces: list[list[Piece]] = [[] for _ in halves]
    for half, walker, phase, curves in in_phases(halves, trajectory):
        which = halves.index(half)
        own = pieces[which]
        edges = curves.start + curves.duration * curves.fractions
        edges[0] = own[-1].time[-1] if own else 0.0  # to the last digit
        if phase is half.phases[-1]:
            edges[-1] = ends[which]
        # phases of a search that did not converge may overlap
        edges = np.minimum(np.maximum.accumulate(edges), ends[which])
        time, samples = [], []
        for k, width in enumerate(np.diff(edges)):
            count = max(SAMPLES, int(np.ceil(width / longest)) + 1)
            time.append(np.linspace(edges[k], edges[k + 1], count))
            samples.append(curves.in_element(k, np.linspace(0.0, 1.0, count)))
        dense = joined(samples)
        motion = body_motion(walker, phase, dense)
        sharing = load_sharing(walker, phase, dense, motion)
        devices = device_moments(walker, phase, dense, motion)
        own.append(Piece(np.concatenate(time), phase.legs, motion, sharing, devices))
    return stride_dataset(problem, pieces, step_lengths(problem, trajectory))


def step_times(halves: Sequence[Half], trajectory: Trajectory, stride: float) -> list[float]:
    """How long each half that is solved lasts [s]; both together the stride to the last digit."""
    if len(halves) == 1:
        return [stride / 2]
    first = trajectory.times["half_stride"]
    return [first, stride - first]


def step_lengths(problem: GaitProblem, trajectory: Trajectory) -> tuple[float, float]:
    """Lengths of the steps with which leg 1 and leg 2 land [m]."""
    length = problem.step_length_m
    first = trajectory.shared.get(STEP_1, length)
    return first, 2 * length - first


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


def rhythms_of(halves: Sequence[Half], trajectory: Trajectory, stride: float) -> tuple[Rhythm, ...]:
    """Contact instants of leg 1, and of leg 2 if it has a rhythm of its own.

    As fractions of T after the heel contact of the leg.
    """
    times = [half.times(trajectory.times) for half in halves]
    lasts = [t / stride for t in step_times(halves, trajectory, stride)]
    found = []
    for i, own in enumerate(times):
        other = times[1 - i] if len(times) > 1 else own
        found.append(
            Rhythm(
                heel_end=own["heel_end"] / stride,
                heel_off=own["heel_off"] / stride,
                toe_off=other["other_toe_off"] / stride + lasts[i],
                toe_tip_start=lasts[i],
            )
        )
    return tuple(found)


def describe(
    dataset: xr.Dataset,
    problem: GaitProblem,
    rhythms: Sequence[Rhythm],
    *,
    energy: float,
    method: str,
    status: str,
    history: list[dict[str, Any]],
    step_lengths: tuple[float, float] | None = None,
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
            "rhythm": json.dumps(rhythms[0].as_dict()),
            "body_parameters": json.dumps(problem.body.by_symbol()),
            "problem": problem_to_toml(problem),
            "limits": problem.conditions(),
            "mesh_history": json.dumps(history),
            "ergowalk_version": __version__,
            **extra,
        }
    ).assign_attrs(_of_legs(rhythms, step_lengths))


def _of_legs(rhythms: Sequence[Rhythm], step_lengths: tuple[float, float] | None) -> dict[str, str]:
    """Attributes of a gait in which both halves were solved."""
    if len(rhythms) == 1:
        return {}
    return {
        "rhythm_leg_2": json.dumps(rhythms[1].as_dict()),
        "step_lengths": json.dumps(step_lengths),
    }


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
