"""A marionette's walk as a gait file: loads, mirrored second half, attributes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import xarray as xr

from ergowalk.corridors import human_gait
from ergowalk.mechanics import dynamics, foot, kinematics
from ergowalk.problem import Corridors, GaitProblem, JointBounds, Limits
from ergowalk.problem.files import problem_to_toml

from .marionette import (
    BODY,
    LEG,
    STEP,
    STRIDE,
    TOE,
    Marionette,
    led_by_hand,
)

CORRIDOR_FILE = "marionette.csv"
PHASES = ("swing", "heel", "flat", "forefoot", "toe")
JOINTS = ("hip", "knee", "ankle", "metatarsal")

PROBLEM = GaitProblem(
    name="marionette",
    step_length_m=STEP,
    stride_time_s=STRIDE,
    body=BODY,
    corridors=Corridors(source=CORRIDOR_FILE),
    limits=Limits(
        moment_rate_nm_per_kg_s=JointBounds(),
        moment_nm_per_kg=JointBounds(hip=4.0, knee=4.0, ankle=4.0),
    ),
)


def synthetic_gait(folder: Path) -> xr.Dataset:
    """The walk as ``gait.nc`` would hold it; its corridor table is written into ``folder``."""
    half = _half_stride(led_by_hand())
    _write_corridors(half, folder / CORRIDOR_FILE)
    data = _whole_stride(half)
    human = human_gait(CORRIDOR_FILE, folder)
    shape = data["joint_angle"][1].shape
    bounds = {"corridor_lower": np.full(shape, np.nan), "corridor_upper": np.full(shape, np.nan)}
    for j, joint in enumerate(JOINTS[:3]):
        corridor = human.angle_corridor(joint, 1.0)
        for leg in (0, 1):
            fraction = data["time"][1] / STRIDE - leg / 2
            bounds["corridor_lower"][:, leg, j] = corridor.lower(fraction)
            bounds["corridor_upper"][:, leg, j] = corridor.upper(fraction)
    data |= {name: (("time", "leg", "joint"), values) for name, values in bounds.items()}
    return _labelled(data)


def _half_stride(walk: Marionette) -> dict[str, np.ndarray]:
    """Every variable on [0, T/2]."""
    motion, share = walk.motion, walk.trailing_share
    total_x, total_y = walk.total
    reactions = (
        ((1 - share) * total_x, (1 - share) * total_y),
        (share * total_x, share * total_y),
    )
    tip = -STEP + LEG.heel_to_metatarsal + LEG.toe_length
    p_2 = foot.ankle_moment_under(walk.points[1], reactions[1], tip)
    upper = dynamics.joint_moments_from(dynamics.coefficients(BODY), motion, reactions, p_2)
    pressure_1 = foot.pressure_moment(walk.points[0], upper[0][2], reactions[0]) / reactions[0][1]
    pressures = (pressure_1, np.where(walk.contacts[:, 1] == TOE, tip, np.nan))
    moments = []
    for leg in (0, 1):
        at = np.nan_to_num(pressures[leg])
        w = foot.metatarsal_moment_under(walk.points[leg], reactions[leg], at)
        moments.append(np.stack([*upper[leg], w], axis=-1))
    curves = _kinematics(walk)
    trunk = curves["trunk_angular_velocity"]
    rates = [
        np.stack(kinematics.joint_rates(trunk, *curves["segment_angular_velocity"][:, leg].T), -1)
        for leg in (0, 1)
    ]
    return curves | {
        "time": walk.time,
        "joint_moment": np.stack(moments, axis=1),
        "joint_power": np.stack(moments, axis=1) * np.stack(rates, axis=1),
        "ground_reaction_force": np.stack([np.stack(r, axis=-1) for r in reactions], axis=1),
        "center_of_pressure": np.stack(pressures, axis=-1),
        "contact_phase": walk.contacts,
        "heel_off": np.array(walk.heel_off),
    }


def _kinematics(walk: Marionette) -> dict[str, np.ndarray]:
    motion, curves = walk.motion, {}
    for order in ("position", "velocity", "acceleration"):
        curves[f"hip_{order}"] = np.stack(getattr(motion.hip, order), axis=-1)
    angular = {"angle": "angle", "angular_velocity": "rate", "angular_acceleration": "acceleration"}
    for name, field in angular.items():
        curves[f"trunk_{name}"] = getattr(motion.trunk, field)
        curves[f"segment_{name}"] = np.stack(
            [
                np.stack([getattr(r, field) for r in (g.thigh, g.shank, g.foot, g.toes)], axis=-1)
                for g in motion.legs
            ],
            axis=1,
        )
    trunk = curves["trunk_angle"]
    curves["joint_angle"] = np.stack(
        [
            np.stack(
                kinematics.joint_angles(LEG, trunk, *curves["segment_angle"][:, leg].T), axis=-1
            )
            for leg in (0, 1)
        ],
        axis=1,
    )
    return curves


def _write_corridors(half: dict[str, np.ndarray], path: Path) -> None:
    """A corridor of 5 degrees around the walk itself."""
    fractions = half["time"] / STRIDE
    stride = {}
    for j, joint in enumerate(JOINTS[:3]):
        angles = np.degrees(half["joint_angle"][..., j])
        grid = np.linspace(0, 1, 51)
        both = np.where(
            grid < 0.5,
            np.interp(grid, fractions, angles[:, 0]),
            np.interp(grid - 0.5, fractions, angles[:, 1]),
        )
        both[-1] = both[0]
        stride[joint] = both
    stems = ("hip_flexion_angle", "knee_flexion_angle", "ankle_dorsiflexion_angle")
    header = ["percent_stride", *(f"{s}_{k}_deg" for s in stems for k in ("mean", "sd"))]
    lines = [",".join(header)]
    for i in range(51):
        cells = [f"{2 * i}", *(f"{stride[j][i]:.6f},5.0" for j in JOINTS[:3])]
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


_PER_LEG = {
    "segment_angle", "segment_angular_velocity", "segment_angular_acceleration", "joint_angle",
    "joint_moment", "joint_power", "ground_reaction_force", "center_of_pressure", "contact_phase",
}  # fmt: skip

_DIMS = {
    "time": ("time",),
    **{f"hip_{k}": ("time", "axis") for k in ("position", "velocity", "acceleration")},
    **{f"trunk_{k}": ("time",) for k in ("angle", "angular_velocity", "angular_acceleration")},
    **{
        f"segment_{k}": ("time", "leg", "segment")
        for k in ("angle", "angular_velocity", "angular_acceleration")
    },
    **{f"joint_{k}": ("time", "leg", "joint") for k in ("angle", "moment", "power")},
    "ground_reaction_force": ("time", "leg", "axis"),
    "center_of_pressure": ("time", "leg"),
    "contact_phase": ("time", "leg"),
}


def _whole_stride(half: dict[str, np.ndarray]) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """The half stride, then the same with the legs exchanged, one step farther."""
    data = {}
    for name, dims in _DIMS.items():
        first = half[name]
        second = first[:, ::-1] if name in _PER_LEG else first
        if name == "time":
            second = first + STRIDE / 2
        elif name == "hip_position":
            second = first + np.array([STEP, 0.0])
        elif name == "center_of_pressure":
            second = second + STEP
        data[name] = (dims, np.concatenate([first, second]))
    data["heel_off"] = ((), half["heel_off"])
    return data


def _labelled(data: dict[str, tuple[tuple[str, ...], np.ndarray]]) -> xr.Dataset:
    heel_off = float(data.pop("heel_off")[1])
    coords = {
        "time": data.pop("time")[1],
        "leg": [1, 2],
        "axis": ["x", "y"],
        "segment": ["thigh", "shank", "foot", "toes"],
        "joint": list(JOINTS),
    }
    dataset = xr.Dataset(data, coords)
    dataset["contact_phase"].attrs = {
        "flag_values": np.arange(5), "flag_meanings": " ".join(PHASES),
    }  # fmt: skip
    rhythm = {"heel_end": 0.08, "heel_off": heel_off, "toe_tip_start": 0.5, "toe_off": 0.62}
    time, power = dataset["time"].values, np.abs(dataset["joint_power"].values)
    energy = float(np.trapezoid(power.sum(axis=(1, 2)), time)) / (2 * STEP)
    meshes = [
        {"elements": 30, "energy_per_metre": energy, "final": True},
        {"elements": 60, "energy_per_metre": 1.004 * energy, "finer": True},
    ]
    dataset.attrs = {
        "energy_per_metre": energy,
        "step_length": STEP,
        "stride_time": STRIDE,
        "rhythm": json.dumps(rhythm),
        "body_parameters": json.dumps(BODY.by_symbol()),
        "problem": problem_to_toml(PROBLEM),
        "mesh_history": json.dumps(meshes),
    }
    return dataset
