"""Two derivations of (1) that share nothing with the package but the names of the parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
import sympy as sm
from sympy.physics.mechanics import (
    KanesMethod,
    Particle,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)

from ergowalk.body import Body

from .spaces import Array, Load, State

_TRUNK = ("trunk_mass_kg", "trunk_com_m", "trunk_inertia_kgm2", "gravity_m_s2")
_LEG = (
    *("thigh_mass", "thigh_length", "thigh_com", "thigh_inertia"),
    *("shank_mass", "shank_length", "shank_com", "shank_inertia"),
    *("foot_mass", "ankle_to_metatarsal"),
)
_LOAD = ("hip", "knee", "ankle", "metatarsal", "R_x", "R_y", "d_x", "d_y")


def kane_residual(body: Body, state: State, load: Load) -> Array:
    """Left minus right side of all eleven lines of (1), by Kane's method (SymPy).

    Nine links on the hip, the feet without mass; order of lines: hip x, hip y, trunk, thigh and
    shank of leg 1 and 2, foot and toes of leg 1 and 2.
    """
    parameters = [getattr(body, name) for name in _TRUNK]
    loads: list[float] = []
    for i in (0, 1):
        leg = body.leg(i)
        parameters += [getattr(leg, name) for name in _LEG]
        moments, pressure = load.moments[i], load.pressure[i]
        offset = _seen_from_toes(body, state, i, pressure)
        loads += [moments.hip, moments.knee, moments.ankle, moments.metatarsal]
        loads += [*load.reactions[i], offset.real, offset.imag]
    motion = state.positions, state.rates, state.accelerations
    return np.array(_kane()(*motion, parameters, loads), dtype=float)


def _seen_from_toes(body: Body, state: State, i: int, pressure: float) -> complex:
    """The centre of pressure relative to the metatarsal joint, in axes turning with the toes."""
    leg, q = body.leg(i), state.positions
    lengths = leg.thigh_length, leg.shank_length, leg.ankle_to_metatarsal
    angles = q[3 + 2 * i], q[4 + 2 * i], q[7 + 2 * i]
    down = sum(-1j * r * np.exp(1j * a) for r, a in zip(lengths, angles, strict=True))
    return complex((pressure - (q[0] + 1j * q[1] + down)) * np.exp(-1j * q[8 + 2 * i]))


@cache
def _kane() -> Callable[..., Any]:
    """Residual of (1) as a function of coordinates, rates, accelerations, parameters, loads."""
    q, u = dynamicsymbols("q:11"), dynamicsymbols("u:11")
    mass, com, moment, g = trunk_symbols = sm.symbols("m r J g")
    world, origin, hip = ReferenceFrame("N"), Point("origin"), Point("O")
    origin.set_vel(world, 0)
    hip.set_pos(origin, q[0] * world.x + q[1] * world.y)
    hip.set_vel(world, u[0] * world.x + u[1] * world.y)
    bodies: list[Any] = []
    loads: list[Any] = []

    def frame(k: int) -> Any:
        turning = ReferenceFrame(f"F{k}")
        turning.orient_axis(world, world.z, q[k])
        turning.set_ang_vel(world, u[k] * world.z)
        return turning

    def fixed(start: Any, vector: Any, turning: Any) -> Any:
        point = start.locatenew(f"P{len(bodies)}{vector}", vector)
        point.v2pt_theory(start, world, turning)
        return point

    def heavy(joint: Any, axis: Any, turning: Any, m: Any, r: Any, about_joint: Any) -> None:
        center = fixed(joint, r * axis, turning)
        central = inertia(turning, 0, 0, about_joint - m * r**2), center
        bodies.append(RigidBody(f"B{len(bodies)}", center, turning, m, central))
        loads.append((center, -m * g * world.y))

    trunk = frame(2)
    heavy(hip, trunk.y, trunk, mass, com, moment)
    parameters, forces = [*trunk_symbols], []
    for i in (0, 1):
        part = sm.symbols([f"{name}{i}" for name in _LEG])
        m_a, a, r_a, j_a, m_b, b, r_b, j_b, m_f, c = part
        force = sm.symbols([f"{name}{i}" for name in _LOAD])
        at_hip, at_knee, at_ankle, at_toes, r_x, r_y, d_x, d_y = force
        thigh, shank, foot, toes = (frame(k) for k in (3 + 2 * i, 4 + 2 * i, 7 + 2 * i, 8 + 2 * i))
        heavy(hip, -thigh.y, thigh, m_a, r_a, j_a)
        knee = fixed(hip, -a * thigh.y, thigh)
        heavy(knee, -shank.y, shank, m_b, r_b, j_b)
        ankle = fixed(knee, -b * shank.y, shank)
        bodies.append(Particle(f"foot{i}", ankle, m_f))
        pressed = fixed(fixed(ankle, -c * foot.y, foot), d_x * toes.x + d_y * toes.y, toes)
        loads += [
            (ankle, -m_f * g * world.y),
            (trunk, -at_hip * world.z),
            (thigh, (at_hip - at_knee) * world.z),
            (shank, (at_knee - at_ankle) * world.z),
            (foot, (at_ankle - at_toes) * world.z),
            (toes, at_toes * world.z),
            (pressed, r_x * world.x + r_y * world.y),
        ]
        parameters += part
        forces += force
    method = KanesMethod(world, q, u, [x.diff() - v for x, v in zip(q, u, strict=True)])
    active, inertial = method.kanes_equations(bodies, loads)
    plain = [sm.symbols(f"{name}:11") for name in "QUA"]
    lines = -(active + inertial)
    lines = lines.xreplace({v.diff(): x for v, x in zip(u, plain[2], strict=True)})
    lines = lines.xreplace(dict(zip([*q, *u], [*plain[0], *plain[1]], strict=True)))
    residual: Callable[..., Any] = sm.lambdify([*plain, parameters, forces], list(lines), cse=True)
    return residual


def newton_euler(
    body: Body, state: State, reactions: Sequence[Sequence[float]], ankles: Sequence[float]
) -> tuple[Array, Array]:
    """Inverse dynamics by Newton's and Euler's laws, link by link from the ground up.

    The plane is the complex plane: a link is -i l exp(i phi), its acceleration follows by the
    chain rule, and the moment of F about a point at distance d is Im(conj(d) F).

    Returns
    -------
    moments : (2, 2) array
        Knee and hip moment of each leg that Euler's law asks for, given the ankle moments.
    rest : (3,) array
        Force (x, y) and moment about the hip that the trunk lacks: zero if reactions and moments
        carry the motion.
    """
    q, v, a = state.positions, state.rates, state.accelerations
    up = 1j * body.gravity_m_s2

    def arm(k: int, length: float) -> complex:
        return complex(-1j * length * np.exp(1j * q[k]))

    def pull(k: int, length: float) -> complex:
        """Acceleration of the tip of a link relative to its base."""
        return complex(1j * a[k] - v[k] ** 2) * arm(k, length)

    def turn(d: complex, force: complex) -> float:
        return (d.conjugate() * force).imag

    hip = complex(a[0], a[1])
    moments = np.zeros((2, 2))
    on_trunk, about_hip = 0j, 0.0
    for i in (0, 1):
        p, k_a, k_b = body.leg(i), 3 + 2 * i, 4 + 2 * i
        knee = hip + pull(k_a, p.thigh_length)
        ankle = knee + pull(k_b, p.shank_length)
        # each force is what the lower part exerts on the upper one
        at_ankle = complex(*reactions[i]) - p.foot_mass * (ankle + up)
        center = knee + pull(k_b, p.shank_com)
        needed = p.shank_mass * (center + up)
        central = p.shank_inertia - p.shank_mass * p.shank_com**2
        moments[i, 0] = (
            central * a[k_b]
            + turn(arm(k_b, p.shank_com), needed)
            - turn(arm(k_b, p.shank_length), at_ankle)
            + ankles[i]
        )
        at_knee = at_ankle - needed
        center = hip + pull(k_a, p.thigh_com)
        needed = p.thigh_mass * (center + up)
        central = p.thigh_inertia - p.thigh_mass * p.thigh_com**2
        moments[i, 1] = (
            central * a[k_a]
            + turn(arm(k_a, p.thigh_com), needed)
            - turn(arm(k_a, p.thigh_length), at_knee)
            + moments[i, 0]
        )
        on_trunk += at_knee - needed
        about_hip -= moments[i, 1]
    r, m = body.trunk_com_m, body.trunk_mass_kg
    needed = m * (hip - pull(2, r) + up)  # the trunk stands where a link hangs
    central = body.trunk_inertia_kgm2 - m * r**2
    lacking = central * a[2] + turn(-arm(2, r), needed) - about_hip
    force = needed - on_trunk
    return moments, np.array([force.real, force.imag, lacking])
