"""The equations of motion (1): mass matrix, inverse dynamics, forward dynamics.

Generalised coordinates, in this order: hip x, hip y, trunk psi, thigh alpha_1, shank beta_1,
thigh alpha_2, shank beta_2. The feet have no inertia: their mass m_f sits at the ankle and their
balance is the last two lines of (1), in :mod:`ergowalk.mechanics.foot`.

The shank line printed in the paper carries + alpha'^2 sin(alpha - beta); the Lagrangian gives the
minus sign used here, and the tests show that the printed sign breaks the balance of work.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.mechanics.functions import cos, sin
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Point, Rotation, Vector

COORDINATES = ("hip_x", "hip_y", "trunk", "thigh_1", "shank_1", "thigh_2", "shank_2")
"""The seven coordinates of (1): hip in m, absolute angles in rad."""


@dataclass(frozen=True)
class LegMoments:
    """Joint moments of one leg [N m]: q, u, p, w of the paper, counter-clockwise on the distal
    segment."""

    hip: Any
    knee: Any
    ankle: Any
    metatarsal: Any


@dataclass(frozen=True)
class LegCoefficients:
    """K_a, K_b, J_i, J_c of (1) with the lengths a and b of one leg."""

    K_a: Any
    K_b: Any
    J_i: Any
    J_c: Any
    a: Any
    b: Any


@dataclass(frozen=True)
class Coefficients:
    """The constants of (1): total mass M, K_r = m r, trunk inertia J, gravity g, two legs."""

    M: Any
    K_r: Any
    J: Any
    g: Any
    legs: tuple[LegCoefficients, LegCoefficients]


def coefficients(body: Body) -> Coefficients:
    """The constants of (1) for a body."""

    def leg(i: int) -> LegCoefficients:
        p = body.leg(i)
        below = p.shank_mass + p.foot_mass
        return LegCoefficients(
            K_a=p.thigh_mass * p.thigh_com + p.thigh_length * below,
            K_b=p.shank_mass * p.shank_com + p.shank_length * p.foot_mass,
            J_i=p.thigh_inertia + p.thigh_length**2 * below,
            J_c=p.shank_inertia + p.shank_length**2 * p.foot_mass,
            a=p.thigh_length,
            b=p.shank_length,
        )

    return Coefficients(
        M=body.total_mass,
        K_r=body.trunk_mass_kg * body.trunk_com_m,
        J=body.trunk_inertia_kgm2,
        g=body.gravity_m_s2,
        legs=(leg(0), leg(1)),
    )


def mass_matrix(c: Coefficients, motion: BodyMotion) -> list[list[Any]]:
    """Mass matrix of (1), 7 by 7, as nested lists [kg, kg m, kg m2]; only angles are used."""
    psi = motion.trunk.angle
    matrix: list[list[Any]] = [[0.0] * 7 for _ in range(7)]

    def put(i: int, j: int, value: Any) -> None:
        matrix[i][j] = matrix[j][i] = value

    put(0, 0, c.M)
    put(1, 1, c.M)
    put(0, 2, -c.K_r * cos(psi))
    put(1, 2, -c.K_r * sin(psi))
    put(2, 2, c.J)
    for k, (leg, part) in enumerate(zip(motion.legs, c.legs, strict=True)):
        alpha, beta, row = leg.thigh.angle, leg.shank.angle, 3 + 2 * k
        put(0, row, part.K_a * cos(alpha))
        put(1, row, part.K_a * sin(alpha))
        put(0, row + 1, part.K_b * cos(beta))
        put(1, row + 1, part.K_b * sin(beta))
        put(row, row, part.J_i)
        put(row + 1, row + 1, part.J_c)
        put(row, row + 1, part.a * part.K_b * cos(alpha - beta))
    return matrix


def centrifugal_and_gravity(c: Coefficients, motion: BodyMotion) -> list[Any]:
    """What remains of the left side of (1) at zero acceleration: 7 entries [N, N m]."""
    psi, spin = motion.trunk.angle, motion.trunk.rate**2
    x = c.K_r * spin * sin(psi)
    y = c.M * c.g - c.K_r * spin * cos(psi)
    rows = [-c.g * c.K_r * sin(psi)]
    for leg, part in zip(motion.legs, c.legs, strict=True):
        alpha, beta = leg.thigh.angle, leg.shank.angle
        thigh, shank = leg.thigh.rate**2, leg.shank.rate**2
        x = x - part.K_a * thigh * sin(alpha) - part.K_b * shank * sin(beta)
        y = y + part.K_a * thigh * cos(alpha) + part.K_b * shank * cos(beta)
        coupling = part.a * part.K_b * sin(alpha - beta)
        rows.append(coupling * shank + c.g * part.K_a * sin(alpha))
        rows.append(-coupling * thigh + c.g * part.K_b * sin(beta))
    return [x, y, *rows]


def inertial_load(c: Coefficients, motion: BodyMotion) -> list[Any]:
    """Left side of (1): mass matrix times accelerations plus centrifugal terms and gravity."""
    matrix = mass_matrix(c, motion)
    acceleration = accelerations(motion)
    rest = centrifugal_and_gravity(c, motion)
    return [
        rest[i] + sum(matrix[i][j] * acceleration[j] for j in range(7) if _nonzero(matrix[i][j]))
        for i in range(7)
    ]


def applied_load(
    c: Coefficients,
    motion: BodyMotion,
    moments: tuple[LegMoments, LegMoments],
    reactions: tuple[Vector, Vector],
) -> list[Any]:
    """Right side of (1): what joint moments [N m] and ground reactions [N] do, 7 entries."""
    rows: list[Any] = [
        reactions[0][0] + reactions[1][0],
        reactions[0][1] + reactions[1][1],
        -moments[0].hip - moments[1].hip,
    ]
    for leg, part, moment, (r_x, r_y) in zip(motion.legs, c.legs, moments, reactions, strict=True):
        alpha, beta = leg.thigh.angle, leg.shank.angle
        rows.append(moment.hip - moment.knee + part.a * (r_x * cos(alpha) + r_y * sin(alpha)))
        rows.append(moment.knee - moment.ankle + part.b * (r_x * cos(beta) + r_y * sin(beta)))
    return rows


def net_load(
    c: Coefficients,
    motion: BodyMotion,
    moments: tuple[LegMoments, LegMoments],
    reactions: tuple[Vector, Vector],
) -> list[Any]:
    """Mass matrix times accelerations by (1): applied load less centrifugal terms and gravity."""
    applied = applied_load(c, motion, moments, reactions)
    return [a - r for a, r in zip(applied, centrifugal_and_gravity(c, motion), strict=True)]


def forward_dynamics(
    c: Coefficients,
    motion: BodyMotion,
    moments: tuple[LegMoments, LegMoments],
    reactions: tuple[Vector, Vector],
) -> NDArray[np.float64]:
    """Accelerations of the :data:`COORDINATES` under given moments and reactions, by (1).

    Parameters
    ----------
    motion : BodyMotion
        Angles and rates of the walker; its accelerations are not used.
    moments : pair of LegMoments
        Joint moments [N m]; the metatarsal moment does not enter, the feet having no inertia.
    reactions : pair of (R_x, R_y)
        Ground reactions [N]. Where they act is in the ankle moments.

    Returns
    -------
    (7,) array for numbers, (7, n) for (n,) arrays [m/s2, rad/s2]. NumPy only; the same for CasADi
    is in :mod:`ergowalk.mechanics.symbolic`.
    """
    matrix = mass_matrix(c, motion)
    right = np.stack(np.broadcast_arrays(*net_load(c, motion, moments, reactions)), axis=-1)
    entries = np.broadcast_arrays(*(entry for row in matrix for entry in row), right[..., 0])[:-1]
    square = np.stack(entries, axis=-1).reshape(*right.shape, 7)
    return np.moveaxis(np.linalg.solve(square, right[..., None])[..., 0], -1, 0)


def motion_of(positions: Any, rates: Any = None, accelerations: Any = None) -> BodyMotion:
    """The walker's motion from its :data:`COORDINATES`, their rates and accelerations.

    Anything indexable from 0 to 6: a list, a (7,) or (7, n) array, a CasADi vector; rates and
    accelerations left out are zero. The massless feet, which (1) does not see, hang at rest.
    """
    v = [0.0] * 7 if rates is None else rates
    a = [0.0] * 7 if accelerations is None else accelerations
    trunk, *links = (Rotation(positions[i], v[i], a[i]) for i in range(2, 7))
    foot = Rotation(0.0)
    return BodyMotion(
        hip=Point((positions[0], positions[1]), (v[0], v[1]), (a[0], a[1])),
        trunk=trunk,
        legs=(LegMotion(links[0], links[1], foot, foot), LegMotion(links[2], links[3], foot, foot)),
    )


def accelerations(motion: BodyMotion) -> list[Any]:
    """Accelerations of the seven coordinates."""
    return [
        *motion.hip.acceleration,
        motion.trunk.acceleration,
        *(r.acceleration for leg in motion.legs for r in (leg.thigh, leg.shank)),
    ]


def rates(motion: BodyMotion) -> list[Any]:
    """Rates of the seven coordinates."""
    return [
        *motion.hip.velocity,
        motion.trunk.rate,
        *(r.rate for leg in motion.legs for r in (leg.thigh, leg.shank)),
    ]


def total_reaction(c: Coefficients, motion: BodyMotion) -> Vector:
    """Sum of both ground reactions [N] that the motion needs: the first two lines of (1)."""
    load = inertial_load(c, motion)
    return load[0], load[1]


def joint_moments_from(
    c: Coefficients,
    motion: BodyMotion,
    reactions: tuple[Vector, Vector],
    trailing_ankle: Any,
) -> tuple[tuple[Any, Any, Any], tuple[Any, Any, Any]]:
    """Inverse dynamics: hip, knee, ankle moment of both legs from the five moment lines of (1).

    The motion and both reactions being given, one moment is free: ``trailing_ankle``, the ankle
    moment p_2 of leg 2 [N m] (zero in swing, from its centre of pressure in double support). Leg
    2 is solved from the ankle up, the trunk gives q_1, leg 1 is solved from the hip down.

    Returns
    -------
    ((q_1, u_1, p_1), (q_2, u_2, p_2)) in N m.
    """
    load = inertial_load(c, motion)
    arm = [0.0] * 4
    for k, (leg, part, (r_x, r_y)) in enumerate(zip(motion.legs, c.legs, reactions, strict=True)):
        alpha, beta = leg.thigh.angle, leg.shank.angle
        arm[2 * k] = part.a * (r_x * cos(alpha) + r_y * sin(alpha))
        arm[2 * k + 1] = part.b * (r_x * cos(beta) + r_y * sin(beta))
    u_2 = load[6] + trailing_ankle - arm[3]
    q_2 = load[5] + u_2 - arm[2]
    q_1 = -load[2] - q_2
    u_1 = q_1 - load[3] + arm[0]
    p_1 = u_1 - load[4] + arm[1]
    return (q_1, u_1, p_1), (q_2, u_2, trailing_ankle)


def _nonzero(value: Any) -> bool:
    return not (isinstance(value, float) and value == 0.0)
