"""Names, symbols, units and dimensions of everything in a gait file."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One variable of a gait file: what it is, the paper's symbol, its unit and dimensions."""

    name: str
    symbol: str
    units: str
    dims: tuple[str, ...]
    long_name: str


SEGMENTS = ("thigh", "shank", "foot", "toes")
JOINTS = ("hip", "knee", "ankle", "metatarsal")
AXES = ("x", "y")
LEGS = (1, 2)

TRUNK_DRAWN = 1.45
"""Length of the trunk in pictures over the distance r from hip to centre of mass: the shoulders."""

_T, _TL = ("time",), ("time", "leg")
_TX, _TLX = ("time", "axis"), ("time", "leg", "axis")
_TLS, _TLJ = ("time", "leg", "segment"), ("time", "leg", "joint")

QUANTITIES = {
    q.name: q
    for q in (
        Quantity("time", "t", "s", _T, "time since heel contact of leg 1"),
        Quantity("hip_position", "x, y", "m", _TX, "position of the hip point O"),
        Quantity("hip_velocity", "x', y'", "m/s", _TX, "velocity of the hip point"),
        Quantity("hip_acceleration", "x'', y''", "m/s2", _TX, "acceleration of the hip point"),
        Quantity(
            "trunk_angle", "psi", "rad", _T, "trunk angle from the upward vertical, leaning back +"
        ),
        Quantity("trunk_angular_velocity", "psi'", "rad/s", _T, "trunk angular velocity"),
        Quantity("trunk_angular_acceleration", "psi''", "rad/s2", _T, "trunk angular acceleration"),
        Quantity(
            "segment_angle",
            "alpha, beta, gamma, epsilon",
            "rad",
            _TLS,
            "angle of thigh, shank, foot, toes from the downward vertical, forward +",
        ),
        Quantity(
            "segment_angular_velocity",
            "alpha', beta', gamma', epsilon'",
            "rad/s",
            _TLS,
            "segment angular velocity",
        ),
        Quantity(
            "segment_angular_acceleration",
            "alpha'', beta'', gamma'', epsilon''",
            "rad/s2",
            _TLS,
            "segment angular acceleration",
        ),
        Quantity(
            "joint_angle",
            "mu_o, mu_k, mu_a, epsilon - gamma - phi_m",
            "rad",
            _TLJ,
            "hip flexion, knee flexion, ankle dorsiflexion, toe rotation",
        ),
        Quantity(
            "joint_moment",
            "q, u, p, w",
            "N m",
            _TLJ,
            "joint moment, counter-clockwise on the distal segment",
        ),
        Quantity(
            "joint_power",
            "q(alpha'-psi'), u(beta'-alpha'), p(gamma'-beta'), w(epsilon'-gamma')",
            "W",
            _TLJ,
            "moment times relative rate, into the walker +",
        ),
        Quantity("ground_reaction_force", "R_x, R_y", "N", _TLX, "force of the ground on the foot"),
        Quantity("center_of_pressure", "x_R", "m", _TL, "centre of pressure, NaN in swing"),
        Quantity("contact_phase", "-", "1", _TL, "how the foot touches the ground"),
        Quantity("corridor_lower", "theta", "rad", _TLJ, "lower bound of the joint angle"),
        Quantity("corridor_upper", "Theta", "rad", _TLJ, "upper bound of the joint angle"),
    )
}
"""Every variable of a gait file by name; the contract that other tools rely on."""

DEVICE_MOMENT = "device_moment"

OF_DEVICES = {
    DEVICE_MOMENT: Quantity(
        DEVICE_MOMENT,
        "-",
        "N m",
        _TLJ,
        "part of the joint moment that a device bears; the rest is the walker's own",
    )
}
"""Variables of a gait with devices alone."""

ALL_QUANTITIES = QUANTITIES | OF_DEVICES
"""Both."""
