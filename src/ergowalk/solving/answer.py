"""From the curves of a stage to a Solution with all attributes of a gait file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.gait.rhythm import PhaseOrder, Rhythm, half_stride_phases
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution.energy import joint_energies
from ergowalk.solution.stride import Piece, stride_dataset
from ergowalk.transcription.curves import Trajectory
from ergowalk.transcription.motion import body_motion, load_sharing
from ergowalk.transcription.walker import Walker

SAMPLES = 9
"""Samples of each element, both ends included."""


def dense_gait(walker: Walker, order: PhaseOrder, trajectory: Trajectory) -> xr.Dataset:
    """The curves on a dense grid: between the nodes, where a transcription cannot hide."""
    longest = walker.problem.stride_time_s / 400
    pieces = []
    for phase, curves in zip(half_stride_phases(order), trajectory.phases, strict=True):
        for k in range(curves.elements):
            width = curves.duration * (curves.fractions[k + 1] - curves.fractions[k])
            count = max(SAMPLES, int(np.ceil(width / longest)) + 1)
            s = np.linspace(0.0, 1.0, count)
            samples = curves.in_element(k, s)
            motion = body_motion(walker, phase, samples)
            time = curves.start + curves.duration * curves.fractions[k] + width * s
            sharing = load_sharing(walker, phase, samples, motion)
            pieces.append(Piece(time, phase.legs, motion, sharing))
    return stride_dataset(walker.problem, _meeting(pieces, walker.problem.stride_time_s / 2))


def _meeting(pieces: Sequence[Piece], half: float) -> list[Piece]:
    """Neighbouring pieces end and begin at the very same number, the last at T/2."""
    out, last = [], 0.0
    for i, piece in enumerate(pieces):
        time = piece.time.copy()
        time[0] = last
        last = half if i == len(pieces) - 1 else float(time[-1])
        time[-1] = last
        out.append(Piece(time, piece.contacts, piece.motion, piece.sharing))
    return out


def dense_energy(dataset: xr.Dataset, step_length: float) -> float:
    """E of (10) [J/m] from the dense curves."""
    return sum(joint_energies(dataset).values()) / (2 * step_length)


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
            "energy_per_metre": dense_energy(dataset, problem.step_length_m),
            "step_length": problem.step_length_m,
            "stride_time": problem.stride_time_s,
            "method": method,
            "solver_status": status,
            "acceptable": 0,
            "rhythm": json.dumps(rhythm.as_dict()),
            "body_parameters": json.dumps(problem.body.by_symbol()),
            "problem": problem_to_toml(problem),
            "limits": problem.limits.sentence(),
            "mesh_history": json.dumps(history),
            "ergowalk_version": __version__,
            **extra,
        }
    )
