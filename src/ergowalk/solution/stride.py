"""The stride as a labelled dataset, from the motion of half a stride."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.gait.loads import Sharing, inverse_dynamics
from ergowalk.gait.rhythm import Contact
from ergowalk.mechanics.dynamics import LegMoments
from ergowalk.mechanics.kinematics import BodyMotion, joint_angles
from ergowalk.problem import GaitProblem
from ergowalk.problem.objective import eq10_joint_powers
from ergowalk.quantities import (
    ALL_QUANTITIES,
    AXES,
    DEVICE_MOMENT,
    JOINTS,
    LEGS,
    QUANTITIES,
    SEGMENTS,
)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Piece:
    """One phase of the half stride: instants [s], contacts, motion, sharing of the load.

    Arrays (n,), both ends included; where an acceleration or a moment may jump the instant stands
    twice. ``devices`` are their moments [N m] by leg (0, 1) and joint, None where a device
    bears all of the joint's moment.
    """

    time: Array
    contacts: tuple[Contact, Contact]
    motion: BodyMotion
    sharing: Sharing
    devices: Mapping[tuple[int, str], Array | None] = field(default_factory=dict)


def stride_dataset(
    problem: GaitProblem,
    halves: Sequence[Sequence[Piece]],
    step_lengths: tuple[float, float] | None = None,
) -> xr.Dataset:
    """All variables of a gait file for [0, T], without global attributes.

    Parameters
    ----------
    halves : one or two sequences of pieces
        Each on a clock of its own, its legs in their roles, the origin at the leading heel. The
        second half is the first one, one step further on, unless it is given.
    step_lengths : (float, float), optional
        With which leg 1 and leg 2 land [m], where they are not equal.
    """
    whole = len(halves) == 1
    seen = (problem, problem if whole else problem.exchanged())
    first, second = (
        _joined([_half_variables(seen[i], piece) for piece in halves[0 if whole else i]])
        for i in (0, 1)
    )
    contact = problem.stride_time_s / 2 if whole else float(first["time"][-1])
    ahead = problem.step_length_m if step_lengths is None else step_lengths[1]
    second = _later(second, contact, ahead)
    values = {name: np.concatenate([first[name], second[name]]) for name in first}
    values |= _corridors(problem, values["time"], contact)
    if not whole:  # to the last digit
        values["time"] = np.minimum(values["time"], problem.stride_time_s)
        values["time"][-1] = problem.stride_time_s
    return _labelled(values)


def _joined(pieces: Sequence[dict[str, Array]]) -> dict[str, Array]:
    return {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}


def _half_variables(problem: GaitProblem, piece: Piece) -> dict[str, Array]:
    body, motion = problem.body, piece.motion
    loads = inverse_dynamics(body, motion, piece.contacts, piece.sharing)
    segments = [[getattr(leg, s) for s in SEGMENTS] for leg in motion.legs]

    def by_leg(kind: str) -> Array:
        return _stack([[getattr(r, kind) for r in leg] for leg in segments])

    angles = [
        joint_angles(body.leg(i), motion.trunk.angle, *(r.angle for r in segments[i]))
        for i in (0, 1)
    ]
    moments = [[getattr(m, j) for j in JOINTS] for m in loads.moments]
    fitted = device_part(moments, piece.devices)
    own = [
        [m - d for m, d in zip(*both, strict=True)] for both in zip(moments, fitted, strict=True)
    ]
    powers = [eq10_joint_powers(LegMoments(*own[i]), motion.trunk, motion.legs[i]) for i in (0, 1)]
    contacts = [np.full(piece.time.shape, int(contact)) for contact in piece.contacts]
    return {
        "time": piece.time,
        "hip_position": _stack(motion.hip.position),
        "hip_velocity": _stack(motion.hip.velocity),
        "hip_acceleration": _stack(motion.hip.acceleration),
        "trunk_angle": motion.trunk.angle,
        "trunk_angular_velocity": motion.trunk.rate,
        "trunk_angular_acceleration": motion.trunk.acceleration,
        "segment_angle": by_leg("angle"),
        "segment_angular_velocity": by_leg("rate"),
        "segment_angular_acceleration": by_leg("acceleration"),
        "joint_angle": _stack(angles),
        "joint_moment": _stack(moments),
        **({DEVICE_MOMENT: _stack(fitted)} if any(problem.devices.everything()) else {}),
        "joint_power": _stack(powers),
        "ground_reaction_force": _stack(loads.reactions),
        "center_of_pressure": _stack(loads.pressures),
        "contact_phase": np.stack(contacts, axis=-1),
    }


def device_part(
    moments: Sequence[Sequence[Array]], devices: Mapping[tuple[int, str], Array | None]
) -> list[list[Array]]:
    """The part of the joint moments [N m] that devices bear, by leg and joint."""
    found = [[np.zeros_like(m) for m in leg] for leg in moments]
    for (leg, joint), moment in devices.items():
        j = JOINTS.index(joint)
        found[leg][j] = moments[leg][j] if moment is None else moment
    return found


def _stack(parts: Any) -> Array:
    """Nested sequences of (n,) arrays as one array with time first."""
    if isinstance(parts, np.ndarray):
        return parts
    return np.stack([_stack(p) for p in parts], axis=1)


def _later(roles: dict[str, Array], contact: float, ahead: float) -> dict[str, Array]:
    """The half in which leg 2 leads: it lands at ``contact`` [s] and ``ahead`` [m]."""
    found = {}
    for name, values in roles.items():
        dims = ALL_QUANTITIES[name].dims
        found[name] = values[:, ::-1] if "leg" in dims else values.copy()
    found["time"] = roles["time"] + contact
    found["hip_position"] = roles["hip_position"] + np.array([ahead, 0.0])
    found["center_of_pressure"] = found["center_of_pressure"] + ahead
    return found


def _corridors(problem: GaitProblem, time: Array, contact: float) -> dict[str, Array]:
    """Bounds of (6), leg 2's after its heel contact [s]; the metatarsal joint has none."""
    lower = np.full((len(time), 2, len(JOINTS)), np.nan)
    upper = lower.copy()
    stride = problem.stride_time_s
    fraction = time / stride
    for leg, shift in enumerate((0.0, 1.0 - contact / stride)):
        for j, (joint, corridor) in enumerate(problem.angle_corridors(leg).items()):
            if problem.corridors_of(leg).width(joint) is None:
                continue
            lower[:, leg, j] = corridor.lower(fraction + shift)
            upper[:, leg, j] = corridor.upper(fraction + shift)
    return {"corridor_lower": lower, "corridor_upper": upper}


def _labelled(values: dict[str, Array]) -> xr.Dataset:
    variables = {}
    for name, quantity in ALL_QUANTITIES.items():
        if name not in values:
            continue
        if name == "time":
            continue
        attributes: dict[str, Any] = {
            "units": quantity.units,
            "long_name": quantity.long_name,
            "symbol": quantity.symbol,
        }
        data = values[name]
        if name == "contact_phase":
            data = data.astype(np.int8)
            attributes["flag_values"] = np.array([int(c) for c in Contact], dtype=np.int8)
            attributes["flag_meanings"] = " ".join(c.name.lower() for c in Contact)
        variables[name] = (quantity.dims, data, attributes)
    time = QUANTITIES["time"]
    meta = {"units": time.units, "long_name": time.long_name, "symbol": time.symbol}
    coordinates = {
        "time": ("time", values["time"], meta),
        "leg": ("leg", np.array(LEGS, dtype=np.int32)),
        "axis": ("axis", np.array(AXES, dtype=object)),
        "segment": ("segment", np.array(SEGMENTS, dtype=object)),
        "joint": ("joint", np.array(JOINTS, dtype=object)),
    }
    return xr.Dataset(variables, coords=coordinates)
