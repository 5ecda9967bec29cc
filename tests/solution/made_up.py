"""A made-up half stride: smooth, of no mechanical merit, but easy to tell apart everywhere."""

from __future__ import annotations

import json

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.gait.loads import Sharing
from ergowalk.gait.rhythm import PRINTED_RHYTHM, boundary_fractions, half_stride_phases
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Point, Rotation
from ergowalk.problem import GaitProblem, preset
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution.energy import joint_energies
from ergowalk.solution.stride import Piece, stride_dataset

Array = NDArray[np.float64]

PROBLEM: GaitProblem = preset("berbyuk2002-rhythm")

SAMPLES = 60


def pieces(samples: int = SAMPLES) -> list[Piece]:
    """Four pieces, one per phase of the printed rhythm."""
    stride = PROBLEM.stride_time_s
    instants = boundary_fractions(PRINTED_RHYTHM)
    out = []
    for phase in half_stride_phases(PRINTED_RHYTHM.order):
        t = np.linspace(instants[phase.start] * stride, instants[phase.end] * stride, samples)
        share = 0.4 if phase.double_support else 0.0
        sharing = Sharing(share * (60 - 80 * t), share * (700 + 90 * t), -0.46 + 0.01 * t)
        out.append(Piece(t, phase.legs, motion(t), sharing))
    return out


def motion(t: Array) -> BodyMotion:
    """Sines of different size and phase, with exact derivatives."""

    def turn(mean: float, size: float, lag: float) -> Rotation:
        w = 2 * np.pi / PROBLEM.stride_time_s
        return Rotation(
            mean + size * np.sin(w * t + lag),
            size * w * np.cos(w * t + lag),
            -size * w**2 * np.sin(w * t + lag),
        )

    hip = Point(
        (0.66 * t, 0.9 + 0.02 * np.cos(11 * t)),
        (0.66 + 0 * t, -0.22 * np.sin(11 * t)),
        (0 * t, -2.42 * np.cos(11 * t)),
    )
    legs = (
        LegMotion(turn(0.1, 0.3, 1), turn(-0.3, 0.4, 2), turn(1, 0.3, 3), turn(1.6, 0.2, 4)),
        LegMotion(turn(0.2, 0.25, 5), turn(-0.2, 0.5, 6), turn(0.9, 0.4, 7), turn(1.5, 0.1, 8)),
    )
    return BodyMotion(hip, turn(0.02, 0.03, 0), legs)


def dataset() -> xr.Dataset:
    """The stride with the attributes that make it a gait file."""
    stride = stride_dataset(PROBLEM, [pieces()])
    energy = sum(joint_energies(stride).values()) / (2 * PROBLEM.step_length_m)
    return stride.assign_attrs(
        energy_per_metre=energy,
        step_length=PROBLEM.step_length_m,
        stride_time=PROBLEM.stride_time_s,
        solver_status="made up",
        acceptable=0,
        rhythm=json.dumps(PRINTED_RHYTHM.as_dict()),
        body_parameters=json.dumps(PROBLEM.body.by_symbol()),
        problem=problem_to_toml(PROBLEM),
        mesh_history=json.dumps([{"elements": 4, "energy_per_metre": energy}]),
    )
