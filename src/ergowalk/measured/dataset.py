"""A measured walk as a dataset like that of a gait file, for comparison and pictures."""

from __future__ import annotations

import json
import math

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk import __version__
from ergowalk.corridors import PeriodicCurve
from ergowalk.gait.rhythm import Contact
from ergowalk.measured.walk import MeasuredWalk
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml
from ergowalk.quantities import AXES, JOINTS, LEGS, QUANTITIES, SEGMENTS

Array = NDArray[np.float64]

INTERVALS = 400
"""Even intervals of the stride, an even number: half a stride is a frame."""


def measured_dataset(walk: MeasuredWalk, problem: GaitProblem) -> xr.Dataset:
    """The mean stride of a measured walk under the names of a gait file.

    Leg 1 is the mean of the strides of both legs; leg 2 is the same half a stride later. Where the
    plates saw no stride, moments, powers and reactions are NaN. Toes without marker move with the
    sole. ``energy_per_metre`` is the mean of the strides, not of the mean curves.
    """
    fraction = np.linspace(0.0, 1.0, INTERVALS + 1)
    curves = _Curves(walk, fraction)
    foot_angle = problem.body.leg(0).foot_angle
    duration = walk.stride_time.mean
    segments = [curves.angle(name) for name in ("thigh", "shank", "sole", "toes")]
    segments[2] = (segments[2][0] - foot_angle, *segments[2][1:])
    angle, rate, acceleration = (np.stack([s[k] for s in segments], axis=1) for k in range(3))
    trunk = curves.angle("trunk")
    hip = curves.hip(2 * walk.step_length.mean)
    values: dict[str, Array] = {
        "time": duration * fraction,
        **dict(zip(("hip_position", "hip_velocity", "hip_acceleration"), hip, strict=True)),
        "trunk_angle": trunk[0],
        "trunk_angular_velocity": trunk[1],
        "trunk_angular_acceleration": trunk[2],
        "segment_angle": _both(angle),
        "segment_angular_velocity": _both(rate),
        "segment_angular_acceleration": _both(acceleration),
        "joint_angle": _both(np.stack([curves.plain(f"{j}_angle") for j in JOINTS], axis=1)),
        "joint_moment": _both(np.stack([curves.plain(f"{j}_moment") for j in JOINTS], axis=1)),
        "joint_power": _both(np.stack([curves.plain(f"{j}_power") for j in JOINTS], axis=1)),
        "ground_reaction_force": _both(
            np.stack([curves.plain(f"reaction_{a}") for a in AXES], axis=1)
        ),
        "center_of_pressure": _pressure(walk, curves),
        "contact_phase": _both(_phases(walk, fraction)),
        **_corridors(problem, fraction),
    }
    variables = {
        name: (q.dims, values[name], {"units": q.units, "long_name": q.long_name,
                                      "symbol": q.symbol})
        for name, q in QUANTITIES.items() if name != "time"
    }  # fmt: skip
    q = QUANTITIES["time"]
    time_attributes = {"units": q.units, "long_name": q.long_name, "symbol": q.symbol}
    dataset = xr.Dataset(
        variables,
        coords={
            "time": ("time", values["time"], time_attributes),
            "leg": list(LEGS),
            "axis": list(AXES),
            "segment": list(SEGMENTS),
            "joint": list(JOINTS),
        },
        attrs=_attributes(walk, problem),
    )
    dataset["contact_phase"] = dataset["contact_phase"].astype("int32")
    dataset["contact_phase"].attrs |= {
        "flag_values": np.array([int(c) for c in Contact], dtype="int32"),
        "flag_meanings": " ".join(c.name.lower() for c in Contact),
    }
    return dataset


class _Curves:
    """Mean curves of the walk at even fractions of the stride."""

    def __init__(self, walk: MeasuredWalk, fraction: Array) -> None:
        self._walk, self._fraction = walk, fraction
        self._duration = walk.stride_time.mean

    def plain(self, name: str) -> Array:
        """A curve between its points; NaN if it is not known."""
        found = self._walk.curve(name)
        if found is None:
            return np.full(len(self._fraction), np.nan)
        grid = np.linspace(0.0, 1.0, len(found[0]))
        return np.interp(self._fraction, grid, found[0])

    def angle(self, name: str) -> tuple[Array, Array, Array]:
        """A periodic angle with its rate and acceleration."""
        found = self._walk.curve(name)
        assert found is not None  # every stride has it
        return self._with_rates(PeriodicCurve.through(found[0]))

    def hip(self, length: float) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration of the hips (n, 2), from x = 0 on."""
        x, y = self._walk.curve("hip_x"), self._walk.curve("hip_y")
        assert x is not None and y is not None  # noqa: PT018 - every stride has them
        grid = np.linspace(0.0, 1.0, len(x[0]))
        sway = self._with_rates(PeriodicCurve.through(x[0] - x[0][-1] * grid))
        rise = self._with_rates(PeriodicCurve.through(y[0]))
        speed = length / self._duration
        along = (sway[0] - sway[0][0] + length * self._fraction, sway[1] + speed, sway[2])
        position, velocity, acceleration = (
            np.stack([a, b], axis=1) for a, b in zip(along, rise, strict=True)
        )
        return position, velocity, acceleration

    def _with_rates(self, curve: PeriodicCurve) -> tuple[Array, Array, Array]:
        s, t = self._fraction, self._duration
        return curve(s), curve(s, 1) / t, curve(s, 2) / t**2


def _both(leg: Array) -> Array:
    """(n, k) of leg 1 as (n, 2, k), leg 2 half a stride later; (n,) as (n, 2)."""
    n = len(leg) - 1
    later = np.concatenate([leg[n // 2 :], leg[1 : n // 2 + 1]])
    return np.stack([leg, later], axis=1)


def _pressure(walk: MeasuredWalk, curves: _Curves) -> Array:
    """Centre of pressure of both legs on the way of the hips (n, 2)."""
    first = curves.plain("pressure")
    n, step = len(first) - 1, walk.step_length.mean
    # the other foot's stance began a step back, and begins again a step ahead
    later = np.concatenate([first[n // 2 :] - step, first[1 : n // 2 + 1] + step])
    return np.stack([first, later], axis=1)


def _phases(walk: MeasuredWalk, fraction: Array) -> Array:
    rhythm = walk.rhythm
    phase = np.full(len(fraction), int(Contact.SWING))
    ends = (
        (rhythm.toe_off, Contact.TOE),
        (max(0.5, rhythm.heel_off), Contact.FOREFOOT),
        (rhythm.heel_off, Contact.FLAT),
        (rhythm.heel_end, Contact.HEEL),
    )
    for end, contact in ends:
        phase[fraction < end] = int(contact)
    return phase


def _corridors(problem: GaitProblem, fraction: Array) -> dict[str, Array]:
    lower = np.full((len(fraction), len(JOINTS)), np.nan)
    upper = lower.copy()
    for joint, corridor in problem.angle_corridors().items():
        i = JOINTS.index(joint)
        lower[:, i], upper[:, i] = corridor.lower(fraction), corridor.upper(fraction)
    return {"corridor_lower": _both(lower), "corridor_upper": _both(upper)}


def _attributes(walk: MeasuredWalk, problem: GaitProblem) -> dict[str, object]:
    energy = walk.energy_per_metre
    strides = len(walk.strides)
    return {
        "title": f"measured walk: {walk.choices.name}",
        "method": "measured",
        "energy_per_metre": energy.mean if energy else math.nan,
        "energy_per_metre_sd": energy.sd if energy else math.nan,
        "step_length": walk.step_length.mean,
        "stride_time": walk.stride_time.mean,
        "acceptable": 0,
        "solver_status": f"measured: {strides} strides, {len(walk.kinetic)} with forces",
        "rhythm": json.dumps(walk.rhythm.as_dict()),
        "body_parameters": json.dumps(problem.body.by_symbol()),
        "problem": problem_to_toml(problem),
        "limits": problem.limits.sentence(),
        "choices": walk.choices.model_dump_json(),
        "notes": json.dumps(list(walk.notes)),
        "iterations": 0,
        "solve_time": 0.0,
        "build_time": 0.0,
        "ergowalk_version": __version__,
    }
