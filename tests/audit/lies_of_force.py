"""Tampering with loads, limits and energy."""

from __future__ import annotations

import json

import numpy as np
import xarray as xr

from .tampering import ANKLE, FLAT, HIP, KNEE, LIMITS, SWING, TOE, lie, phase_of, set_problem


@lie("equations_of_motion", "load_symmetry", "joint_power", "work_energy", also=LIMITS)
def a_knee_moment_scaled_by_one_percent(gait: xr.Dataset) -> None:
    gait["joint_moment"].values[:, 0, KNEE] *= 1.01


@lie("work_energy", "equations_of_motion", "joint_power", "swing_unloaded", also=LIMITS)
def all_moments_scaled_by_five_percent(gait: xr.Dataset) -> None:
    gait["joint_moment"].values[:] *= 1.05


@lie("load_symmetry", "equations_of_motion", "joint_power", "work_energy", also=LIMITS)
def a_hip_moment_of_one_leg_off_by_a_thousandth(gait: xr.Dataset) -> None:
    gait["joint_moment"].values[:, 1, HIP] *= 1.001


@lie("center_of_pressure", "equations_of_motion", "load_symmetry", "work_energy")
def the_centre_of_pressure_of_one_leg_moved_by_5_mm(gait: xr.Dataset) -> None:
    gait["center_of_pressure"].values[:, 0] += 0.005


@lie("center_of_pressure", "equations_of_motion", "load_symmetry", "work_energy")
def the_centre_of_pressure_missing_under_load(gait: xr.Dataset) -> None:
    middle = np.flatnonzero(phase_of(gait, 0) == FLAT)
    gait["center_of_pressure"].values[middle[len(middle) // 2], 0] = np.nan


@lie("equations_of_motion", "load_symmetry", "work_energy", also=LIMITS)
def a_reaction_capped(gait: xr.Dataset) -> None:
    force = gait["ground_reaction_force"].values[..., 1]
    np.minimum(force, 0.9 * force.max(), out=force)


@lie(
    "reaction_upward", "equations_of_motion", "load_symmetry", "work_energy", "swing_unloaded",
    "center_of_pressure", also=LIMITS,
)  # fmt: skip
def a_foot_that_pulls_the_ground(gait: xr.Dataset) -> None:
    gait["ground_reaction_force"].values[phase_of(gait, 0) == TOE, 0, 1] = -10.0


@lie("swing_unloaded", "equations_of_motion", "load_symmetry", "work_energy", also=LIMITS)
def a_newton_on_a_swinging_foot(gait: xr.Dataset) -> None:
    gait["ground_reaction_force"].values[phase_of(gait, 1) == SWING, 1, 0] = 1.0


@lie("swing_unloaded")
def a_centre_of_pressure_in_swing(gait: xr.Dataset) -> None:
    gait["center_of_pressure"].values[phase_of(gait, 0) == SWING, 0] = 0.3


@lie("vertical_reaction_cap")
def a_reaction_over_its_limit(gait: xr.Dataset) -> None:
    set_problem(gait, "limits", "vertical_reaction_body_weights", "0.5")


@lie("friction")
def a_floor_too_slippery(gait: xr.Dataset) -> None:
    set_problem(gait, "limits", "friction_coefficient", "0.01")


@lie("vertical_reaction_cap")
def a_limit_that_the_problem_does_not_state(gait: xr.Dataset) -> None:
    stated = "vertical_reaction_body_weights"
    gait.attrs["problem"] = gait.attrs["problem"].replace(stated, "other")


@lie("moment_limits")
def a_moment_over_its_limit(gait: xr.Dataset) -> None:
    set_problem(gait, "limits.moment_nm_per_kg", "ankle", "0.2")


@lie("moment_rate_limits")
def a_moment_rate_over_its_limit(gait: xr.Dataset) -> None:
    set_problem(gait, "limits.moment_rate_nm_per_kg_s", "knee", "2.0")


@lie("energy", "mesh")
def an_energy_one_percent_too_small(gait: xr.Dataset) -> None:
    gait.attrs["energy_per_metre"] *= 0.99


@lie("joint_power")
def joint_power_with_its_sign_flipped(gait: xr.Dataset) -> None:
    gait["joint_power"].values[:, :, ANKLE] *= -1


@lie("energy", "joint_power", "objective")
def joint_powers_scaled_by_one_percent(gait: xr.Dataset) -> None:
    gait["joint_power"].values[:] *= 1.01


@lie("mesh")
def a_finer_mesh_that_disagrees(gait: xr.Dataset) -> None:
    history = json.loads(gait.attrs["mesh_history"])
    finer = next(entry for entry in history if entry.get("finer"))
    finer["energy_per_metre"] *= 0.97
    gait.attrs["mesh_history"] = json.dumps(history)


@lie("mesh")
def no_finer_mesh(gait: xr.Dataset) -> None:
    del gait.attrs["mesh_history"]


@lie("mesh")
def a_finer_mesh_that_is_not_finer(gait: xr.Dataset) -> None:
    history = json.loads(gait.attrs["mesh_history"])
    for entry in history:
        entry["elements"] = 30
    gait.attrs["mesh_history"] = json.dumps(history)
