"""Newton-Euler balance of every segment, and the walker's energy and the work done on it.

Each segment is cut free: force is mass times the acceleration of its centre of mass, moment about
the centre of mass is central inertia times angular acceleration. Joint forces run from the ground
up, so what is left over appears in eleven residuals, as many as (1) has lines: force on the trunk
(2), moment on trunk, thighs, shanks, feet and toes (9).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ergowalk.audit.walker import (
    FOOT,
    SHANK,
    THIGH,
    TOES,
    Array,
    Body,
    Moving,
    Plane,
    Turning,
    Walker,
)


@dataclass(frozen=True)
class Loads:
    """What acts on the walker.

    ``moments`` (n, 2, 4): q, u, p, w [N m]; ``reaction`` (n, 2): R_x + i R_y [N];
    ``pressure`` (n, 2): x_R [m], any finite number where nothing rests on the ground.
    """

    moments: Array
    reaction: Plane
    pressure: Array


@dataclass(frozen=True)
class Residuals:
    """What Newton and Euler leave over: forces [N] and moments [N m].

    ``trunk_force`` (n, 2): x, y; ``trunk_moment`` (n,); ``segment_moment`` (n, 2, 4).
    """

    trunk_force: Array
    trunk_moment: Array
    segment_moment: Array


def residuals(
    walker: Walker, body: Body, trunk: Turning, segments: tuple[Turning, ...], loads: Loads
) -> Residuals:
    """Balance of all segments, cut free one by one from the toes to the trunk."""
    q, u, p, w = (loads.moments[..., j] for j in range(4))
    contact = loads.pressure + 0j
    thigh, shank = segments[THIGH], segments[SHANK]

    # massless toes and foot: the reaction passes through to the ankle, where m_f sits
    toes = w + _cross(contact - body.metatarsal.position, loads.reaction)
    foot = p - w + _cross(body.metatarsal.position - body.ankle.position, loads.reaction)
    on_foot = _inertia(walker.m_f, body.ankle, walker.g) - loads.reaction

    on_shank = _inertia(walker.m_b, body.shank_centre, walker.g) + on_foot
    shank_moment = (
        u - p
        + _cross(body.knee.position - body.shank_centre.position, on_shank)
        - _cross(body.ankle.position - body.shank_centre.position, on_foot)
        - (walker.J_b - walker.m_b * walker.r_b**2) * shank.acceleration
    )  # fmt: skip
    on_thigh = _inertia(walker.m_a, body.thigh_centre, walker.g) + on_shank
    hip = body.hip.position[:, None]
    thigh_moment = (
        q - u
        + _cross(hip - body.thigh_centre.position, on_thigh)
        - _cross(body.knee.position - body.thigh_centre.position, on_shank)
        - (walker.J_a - walker.m_a * walker.r_a**2) * thigh.acceleration
    )  # fmt: skip
    from_legs = -on_thigh.sum(axis=1)
    force = from_legs - _inertia(walker.m, body.trunk_centre, walker.g)
    trunk_moment = (
        -q.sum(axis=1)
        + _cross(body.hip.position - body.trunk_centre.position, from_legs)
        - (walker.J - walker.m * walker.r**2) * trunk.acceleration
    )
    return Residuals(
        np.stack([force.real, force.imag], axis=-1),
        trunk_moment,
        np.stack([thigh_moment, shank_moment, foot, toes], axis=-1),
    )


def mechanical_energy(
    walker: Walker, body: Body, trunk: Turning, segments: tuple[Turning, ...]
) -> Array:
    """Kinetic plus potential energy [J] (n,), each segment by its centre of mass."""
    legs = (
        _energy(walker.m_a, walker.J_a - walker.m_a * walker.r_a**2, walker.g,
                body.thigh_centre, segments[THIGH].rate)
        + _energy(walker.m_b, walker.J_b - walker.m_b * walker.r_b**2, walker.g,
                  body.shank_centre, segments[SHANK].rate)
        + _energy(walker.m_f, 0.0, walker.g, body.ankle, 0.0)
    )  # fmt: skip
    centre = walker.J - walker.m * walker.r**2
    return np.asarray(
        legs.sum(axis=1) + _energy(walker.m, centre, walker.g, body.trunk_centre, trunk.rate)
    )


def relative_rates(trunk: Turning, segments: tuple[Turning, ...]) -> Array:
    """Rates that q, u, p, w work on in (10) (n, 2, 4): distal minus proximal [rad/s]."""
    rates = [np.repeat(trunk.rate[:, None], 2, axis=1), *(s.rate for s in segments)]
    return np.stack([after - before for before, after in pairwise(rates)], -1)


def ground_power(
    body: Body, segments: tuple[Turning, ...], loads: Loads, on_toes: np.ndarray
) -> Array:
    """Power [W] (n, 2) of the ground on the point of the foot that the reaction acts on.

    That point belongs to the toes where ``on_toes`` (n, 2), else to the foot. It is zero only
    as far as the point rests.
    """
    contact = loads.pressure + 0j
    by_foot = body.ankle.velocity + 1j * segments[FOOT].rate * (contact - body.ankle.position)
    by_toes = body.metatarsal.velocity + 1j * segments[TOES].rate * (
        contact - body.metatarsal.position
    )
    velocity = np.where(on_toes, by_toes, by_foot)
    return np.asarray((np.conj(loads.reaction) * velocity).real)


def _cross(arm: Plane, force: Plane) -> Array:
    """Moment of a force about the foot of its arm, counter-clockwise."""
    return np.asarray((np.conj(arm) * force).imag)


def _inertia(mass: Array | float, centre: Moving, gravity: float) -> Plane:
    """Force that a mass needs from its neighbours: mass times (acceleration - gravity)."""
    return np.asarray(mass * (centre.acceleration + 1j * gravity))


def _energy(
    mass: Array | float, inertia: Array | float, gravity: float, centre: Moving, rate: Array | float
) -> Array:
    kinetic = mass * np.abs(centre.velocity) ** 2 / 2 + inertia * rate**2 / 2
    return np.asarray(kinetic + mass * gravity * centre.position.imag)
