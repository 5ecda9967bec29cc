"""Tampering with phases, grid, corridors and attributes."""

from __future__ import annotations

import json

import numpy as np
import xarray as xr

from .tampering import (
    FLAT,
    FOREFOOT,
    HIP,
    KNEE,
    LIMITS,
    MOTION,
    SWING,
    doubles,
    edit_json,
    lie,
    phase_of,
    set_problem,
)


@lie("phases", "center_of_pressure")
def one_sample_in_the_wrongphase_of(gait: xr.Dataset) -> None:
    flat = np.flatnonzero(phase_of(gait, 0) == FLAT)
    gait["contact_phase"].values[flat[len(flat) // 2], 0] = FOREFOOT


@lie("phases", "center_of_pressure", "moment_limits", "moment_rate_limits", "toes")
def a_heel_off_one_piece_late(gait: xr.Dataset) -> None:
    heel_off = np.flatnonzero(phase_of(gait, 0) == FOREFOOT)[0]
    after = doubles(gait)[doubles(gait) > heel_off][0]
    gait["contact_phase"].values[heel_off:after, 0] = FLAT


@lie("phases", "swing_unloaded", "work_energy", "center_of_pressure", "toes", "feet_fixed")
def legs_that_exchange_their_phases(gait: xr.Dataset) -> None:
    gait["contact_phase"].values[:] = gait["contact_phase"].values[:, ::-1]


@lie("phases", "toes", "feet_fixed")
def a_phase_that_is_none(gait: xr.Dataset) -> None:
    gait["contact_phase"].values[10, 0] = 9


@lie("phases", "rhythm_as_asked")
def another_rhythm(gait: xr.Dataset) -> None:
    heel_off = json.loads(gait.attrs["rhythm"])["heel_off"]
    edit_json(gait, "rhythm", heel_off=heel_off + 1e-4)


@lie("objective")
def an_objective_of_a_percent_less(gait: xr.Dataset) -> None:
    gait.attrs["objective_per_metre"] = 0.99 * gait.attrs["energy_per_metre"]


@lie("objective")
def another_objective_than_the_problems(gait: xr.Dataset) -> None:
    gait.attrs["objective_per_metre"] = gait.attrs["energy_per_metre"]
    set_problem(gait, "objective", "muscle_work", "0.5")


@lie("rhythm_order", "phases", "rhythm_as_asked")
def a_rhythm_against_the_inequality(gait: xr.Dataset) -> None:
    edit_json(gait, "rhythm", heel_end=0.46, heel_off=0.45)


@lie("rhythm_as_asked")
def a_rhythm_that_was_not_asked_for(gait: xr.Dataset) -> None:
    set_problem(gait, "rhythm", "heel_off", "0.45")


@lie("rhythm_as_asked")
def a_phase_order_that_was_not_asked_for(gait: xr.Dataset) -> None:
    rhythm = json.loads(gait.attrs["rhythm"])
    flat_first = rhythm["toe_off"] - 0.5 > rhythm["heel_end"]
    other = "toe-off-first" if flat_first else "flat-first"
    set_problem(gait, "rhythm", "order", f'"{other}"')


@lie("phases", "velocities", "accelerations", "time_steps", also=MOTION)
def a_phase_change_that_stands_once(gait: xr.Dataset) -> xr.Dataset:
    toe_off = np.flatnonzero(np.diff(phase_of(gait, 0) == SWING))[0]
    return gait.isel(time=np.delete(np.arange(gait.sizes["time"]), toe_off))


@lie("time_steps", "energy", also=MOTION)
def half_of_the_samples_left_out(gait: xr.Dataset) -> xr.Dataset:
    piece = np.searchsorted(doubles(gait), np.arange(gait.sizes["time"]), side="right")
    first = np.concatenate([[0], doubles(gait)])[piece]
    return gait.isel(time=np.flatnonzero((np.arange(gait.sizes["time"]) - first) % 2 == 0))


@lie("smooth_pieces", "time_steps", "energy", also=MOTION)
def pieces_of_three_samples(gait: xr.Dataset) -> xr.Dataset:
    piece = np.searchsorted(doubles(gait), np.arange(gait.sizes["time"]), side="right")
    first = np.concatenate([[0], doubles(gait)])[piece]
    return gait.isel(time=np.flatnonzero((np.arange(gait.sizes["time"]) - first) % 4 == 0))


@lie(
    "time_span", "phases", "corridors_as_asked", "feet_fixed", "energy", "time_steps",
    "corridors", also=MOTION | LIMITS,
)  # fmt: skip
def a_stride_a_thousandth_longer(gait: xr.Dataset) -> xr.Dataset:
    return gait.assign_coords(time=gait["time"] * 1.001)


@lie("corridors_as_asked")
def corridors_widened_in_the_file(gait: xr.Dataset) -> None:
    gait["corridor_upper"].values[..., KNEE] += np.radians(0.5)


@lie("corridors_as_asked")
def a_corridor_missing_at_the_hip(gait: xr.Dataset) -> None:
    gait["corridor_lower"].values[:, 0, HIP] = np.nan


@lie("corridors_as_asked")
def corridors_of_twice_the_width_asked_for(gait: xr.Dataset) -> None:
    set_problem(gait, "corridors", "width_sd", "0.5")


@lie("attributes")
def a_problem_with_a_heavier_trunk(gait: xr.Dataset) -> None:
    set_problem(gait, "body", "trunk_mass_kg", "46.8")


@lie("attributes")
def a_problem_with_a_longer_step(gait: xr.Dataset) -> None:
    set_problem(gait, "", "step_length_m", "0.8")


@lie("attributes", "equations_of_motion", "work_energy", also=LIMITS)
def a_body_with_a_lighter_foot(gait: xr.Dataset) -> None:
    edit_json(gait, "body_parameters", m_f=1.2)


@lie("attributes", "feet_fixed", "feet_above_ground", "toes", also=MOTION | LIMITS)
def a_body_with_a_shorter_sole(gait: xr.Dataset) -> None:
    edit_json(gait, "body_parameters", l_h=0.19)
