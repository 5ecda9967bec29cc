"""Tampering with curves, rates and feet."""

from __future__ import annotations

import numpy as np
import xarray as xr

from .tampering import FOOT, KNEE, MOTION, SHANK, SWING, THIGH, TOE, TOES, doubles, lie, phase_of


@lie("joint_angles", "equations_of_motion", "work_energy")
def a_trunk_curve_shifted(gait: xr.Dataset) -> None:
    gait["trunk_angle"].values[:] += 0.01


@lie("corridors", "joint_angles")
def a_knee_bent_out_of_its_corridor(gait: xr.Dataset) -> None:
    gap = gait["corridor_upper"].values[..., KNEE] - gait["joint_angle"].values[..., KNEE]
    gait["joint_angle"].values[..., KNEE] += gap + np.radians(0.2)


@lie("velocities", "accelerations", "equations_of_motion", "work_energy", "joint_power")
def trunk_velocity_scaled_by_a_thousandth(gait: xr.Dataset) -> None:
    gait["trunk_angular_velocity"].values[:] *= 1.001


@lie("accelerations", "equations_of_motion")
def hip_acceleration_scaled_by_a_thousandth(gait: xr.Dataset) -> None:
    gait["hip_acceleration"].values[..., 1] *= 1.001


@lie("no_impact", also=MOTION)
def a_velocity_that_jumps_at_heel_contact(gait: xr.Dataset) -> None:
    late = np.arange(gait.sizes["time"]) >= doubles(gait)[len(doubles(gait)) // 2]
    gait["trunk_angular_velocity"].values[late] += 0.01


@lie("no_impact", also=MOTION)
def a_position_that_jumps(gait: xr.Dataset) -> None:
    late = np.arange(gait.sizes["time"]) >= doubles(gait)[len(doubles(gait)) // 3]
    gait["trunk_angle"].values[late] += 1e-3


@lie("leg_symmetry", also=MOTION)
def a_rate_of_one_leg_off_by_a_ten_thousandth(gait: xr.Dataset) -> None:
    gait["segment_angular_velocity"].values[:, 1, THIGH] *= 1.0001


@lie("periodicity", "feet_fixed", "leg_symmetry", "equations_of_motion", "work_energy")
def a_hip_that_rises_by_a_tenth_of_a_millimetre(gait: xr.Dataset) -> None:
    time, period = gait["time"].values, gait.attrs["stride_time"]
    gait["hip_position"].values[:, 1] += 0.9e-4 * time / period
    gait["hip_velocity"].values[:, 1] += 0.9e-4 / period


@lie(
    "feet_fixed", "periodicity", "leg_symmetry", "equations_of_motion", "work_energy",
    "load_symmetry", "center_of_pressure",
)  # fmt: skip
def a_walk_that_slides_by_2_mm_a_second(gait: xr.Dataset) -> None:
    gait["hip_position"].values[:, 0] += 0.002 * gait["time"].values
    gait["hip_velocity"].values[:, 0] += 0.002


@lie(
    "feet_fixed", "joint_angles", "leg_symmetry", "equations_of_motion", "work_energy",
    "load_symmetry", "feet_above_ground",
)  # fmt: skip
def a_shank_turned_by_a_milliradian(gait: xr.Dataset) -> None:
    gait["segment_angle"].values[:, 0, SHANK] += 1e-3


@lie("feet_above_ground", "feet_fixed", "equations_of_motion")
def a_hip_2_mm_too_low(gait: xr.Dataset) -> None:
    gait["hip_position"].values[:, 1] -= 0.002


@lie("toes", "feet_above_ground", "feet_fixed", also=MOTION)
def toes_bent_in_swing(gait: xr.Dataset) -> None:
    gait["segment_angle"].values[phase_of(gait, 0) == SWING, 0, TOES] += 0.01


@lie("toes", "feet_above_ground", "feet_fixed", also=MOTION)
def toes_bent_downwards_in_the_toephase_of(gait: xr.Dataset) -> None:
    angle = gait["segment_angle"].values
    toe = phase_of(gait, 0) == TOE
    sole = angle[phase_of(gait, 0) == SWING, 0]
    straight = float(np.mean(sole[:, TOES] - sole[:, FOOT]))
    angle[toe, 0, TOES] = angle[toe, 0, FOOT] + straight - 0.01
