"""Balances of work, momentum and angular momentum along smooth motions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from ergowalk.body import Body
from ergowalk.mechanics.dynamics import coefficients, total_reaction
from ergowalk.mechanics.energy import kinetic_energy, potential_energy
from ergowalk.mechanics.foot import metatarsal_moment_under, pressure_moment
from ergowalk.mechanics.kinematics import BodyMotion, joint_rates, leg_points

from .spaces import (
    LAW,
    PAPER,
    Array,
    Carried,
    SmoothMotion,
    bodies,
    carried,
    numbers,
    smooth_motions,
)

STEP = 1e-30j
"""An imaginary time step: f(t + ih) = f(t) + ih f'(t) to the last digit."""

DURATION = 0.4

_nodes, _weights = np.polynomial.legendre.leggauss(80)
TIMES, WEIGHTS = DURATION * (_nodes + 1) / 2, DURATION * _weights / 2


def power(body: Body, load: Carried) -> Array:
    """Power of the joint moments and of the reactions acting at the ankles [W].

    With the massless foot left out; the last test of this file has it in.
    """
    motion, total = load.motion, 0.0
    for i, leg in enumerate(motion.legs):
        m, (r_x, r_y) = load.moments[i], load.reactions[i]
        hip, knee, _, _ = joint_rates(motion.trunk.rate, leg.thigh.rate, leg.shank.rate, 0.0, 0.0)
        v_x, v_y = leg_points(body.leg(i), leg, motion.hip).ankle.velocity
        total = total + m.hip * hip + m.knee * knee - m.ankle * leg.shank.rate
        total = total + r_x * v_x + r_y * v_y
    return np.asarray(total)


def energy(body: Body, motion: BodyMotion) -> float:
    """Kinetic and potential energy [J]."""
    return float(kinetic_energy(body, motion) + potential_energy(body, motion))


@LAW
@given(bodies, smooth_motions, numbers(2, 500.0), numbers(1, 100.0))
def test_work_is_the_change_of_energy(
    body: Body, motion: SmoothMotion, trailing: Array, ankle: Array
) -> None:
    load = carried(body, motion.at(TIMES).motion(), trailing, ankle[0])
    rate = power(body, load)
    change = energy(body, motion.at(DURATION).motion()) - energy(body, motion.at(0.0).motion())
    scale = float(WEIGHTS @ np.abs(rate)) + body.total_mass * body.gravity_m_s2
    assert WEIGHTS @ rate == pytest.approx(change, abs=1e-11 * scale)


def test_printed_sign_of_the_shank_line_breaks_the_balance_of_work() -> None:
    # both thighs swing by 0.5 rad, in opposition; the shanks lag by a quarter of a period
    amplitude, phase = np.zeros((11, 2)), np.zeros((11, 2))
    amplitude[3:7, 0], phase[3:7, 0] = (0.5, 0.6, 0.5, 0.6), np.pi * np.array([0, -0.5, 1, 0.5])
    motion = SmoothMotion(np.zeros(11), amplitude.ravel(), phase.ravel())
    walk = motion.at(TIMES).motion()
    load = carried(PAPER, walk, np.zeros(2), 0.0)
    change = energy(PAPER, motion.at(DURATION).motion()) - energy(PAPER, motion.at(0.0).motion())
    rate = power(PAPER, load)
    assert WEIGHTS @ rate == pytest.approx(change, abs=1e-9)
    # each shank line asks for that much more moment, and the moment works at the shank's rate
    surplus = sum(
        2 * part.a * part.K_b * a.rate**2 * np.sin(a.angle - b.angle) * b.rate
        for part, a, b in (
            (c, leg.thigh, leg.shank)
            for c, leg in zip(coefficients(PAPER).legs, walk.legs, strict=True)
        )
    )
    assert abs(WEIGHTS @ (rate + surplus) - change) > 1.0  # J


def masses(body: Body, motion: BodyMotion) -> list[tuple[float, complex, complex, float, complex]]:
    """Mass, centre, its velocity, central inertia and rate of every segment.

    By rotating complex numbers, not by the package's kinematics.
    """
    hip, speed = complex(*motion.hip.position), complex(*motion.hip.velocity)

    def rod(length: float, angle: float, rate: float) -> tuple[complex, complex]:
        z = -1j * length * np.exp(1j * angle)
        return z, 1j * rate * z

    m, r = body.trunk_mass_kg, body.trunk_com_m
    z, dz = rod(-r, motion.trunk.angle, motion.trunk.rate)
    spin = body.trunk_inertia_kgm2 - m * r**2
    found = [(m, hip + z, speed + dz, spin, motion.trunk.rate)]
    for i, leg in enumerate(motion.legs):
        p = body.leg(i)
        z, dz = rod(1.0, leg.thigh.angle, leg.thigh.rate)
        s, ds = rod(1.0, leg.shank.angle, leg.shank.rate)
        knee, fast = hip + p.thigh_length * z, speed + p.thigh_length * dz
        spin = p.thigh_inertia - p.thigh_mass * p.thigh_com**2
        center = hip + p.thigh_com * z, speed + p.thigh_com * dz
        found.append((p.thigh_mass, *center, spin, leg.thigh.rate))
        spin = p.shank_inertia - p.shank_mass * p.shank_com**2
        center = knee + p.shank_com * s, fast + p.shank_com * ds
        found.append((p.shank_mass, *center, spin, leg.shank.rate))
        found.append((p.foot_mass, knee + p.shank_length * s, fast + p.shank_length * ds, 0, 0))
    return found


def slope(body: Body, motion: SmoothMotion, time: float, quantity: str) -> complex:
    """Rate of linear or angular momentum (about the origin) by a five-point difference."""

    def at(t: float) -> complex:
        parts = masses(body, motion.at(t).motion())
        if quantity == "linear":
            return sum(m * v for m, _, v, _, _ in parts)
        return sum(m * (x.conjugate() * v).imag + j * w for m, x, v, j, w in parts)

    h = 1e-3
    return (8 * (at(time + h) - at(time - h)) - at(time + 2 * h) + at(time - 2 * h)) / (12 * h)


@LAW
@given(bodies, smooth_motions)
def test_reactions_carry_the_weight_and_change_the_momentum(
    body: Body, motion: SmoothMotion
) -> None:
    r_x, r_y = total_reaction(coefficients(body), motion.at(0.1).motion())
    weight = body.total_mass * body.gravity_m_s2
    expected = slope(body, motion, 0.1, "linear") + 1j * weight
    assert complex(r_x, r_y) == pytest.approx(expected, rel=1e-7, abs=1e-7 * weight)


@LAW
@given(bodies, smooth_motions, numbers(2, 500.0), numbers(1, 100.0))
def test_reactions_and_gravity_change_the_angular_momentum(
    body: Body, motion: SmoothMotion, trailing: Array, ankle: Array
) -> None:
    walk = motion.at(0.1).motion()
    load = carried(body, walk, trailing, ankle[0])
    ground = 0.0
    for i in (0, 1):
        points = leg_points(body.leg(i), walk.legs[i], walk.hip)
        ground += pressure_moment(points, load.moments[i].ankle, load.reactions[i])
    weight = sum(m * x.real for m, x, *_ in masses(body, walk)) * body.gravity_m_s2
    change = slope(body, motion, 0.1, "angular").real
    scale = abs(ground) + abs(weight) + body.total_mass * body.gravity_m_s2
    assert ground - weight == pytest.approx(change, abs=1e-7 * scale)


@LAW
@given(bodies, smooth_motions)
def test_energies_are_sums_over_the_segments(body: Body, motion: SmoothMotion) -> None:
    walk = motion.at(0.2).motion()
    parts = masses(body, walk)
    kinetic = sum(m * abs(v) ** 2 / 2 + j * abs(w) ** 2 / 2 for m, _, v, j, w in parts)
    height = sum(m * x.imag for m, x, *_ in parts)
    assert kinetic_energy(body, walk) == pytest.approx(kinetic, rel=1e-12)
    expected = body.gravity_m_s2 * height
    assert potential_energy(body, walk) == pytest.approx(expected, abs=1e-12 * 1000)


@LAW
@given(bodies, smooth_motions, numbers(2, 500.0), numbers(1, 100.0))
def test_power_is_the_rate_of_energy(
    body: Body, motion: SmoothMotion, trailing: Array, ankle: Array
) -> None:
    load = carried(body, motion.at(0.15).motion(), trailing, ankle[0])
    shifted = motion.at(0.15 + STEP).motion()
    value = kinetic_energy(body, shifted) + potential_energy(body, shifted)
    rate = float(value.imag / STEP.imag)
    parts = [abs(m.hip) + abs(m.knee) for m in load.moments]
    scale = 100 * sum(parts) + 20 * np.abs(load.reactions).sum()
    assert power(body, load) == pytest.approx(rate, abs=1e-13 * scale)


@LAW
@given(bodies, smooth_motions, numbers(2, 400.0), numbers(2, 0.3))
def test_all_four_joints_and_the_ground_do_the_work(
    body: Body, motion: SmoothMotion, trailing: Array, pressure: Array
) -> None:
    """As in (10): q, u, p, w at the relative rates, and each reaction at the point of the toes
    that it presses on."""
    walk = motion.at(0.15).motion()
    points = [leg_points(body.leg(i), walk.legs[i], walk.hip) for i in (0, 1)]
    (x_a, y_a), r = points[1].ankle.position, trailing
    trailing_ankle = -y_a * r[0] - (pressure[1] - x_a) * r[1]
    load = carried(body, walk, trailing, trailing_ankle)
    x_r = [pressure_moment(points[0], load.moments[0].ankle, load.reactions[0]), pressure[1]]
    x_r[0] /= load.reactions[0][1]
    total = terms = 0.0
    for i, leg in enumerate(walk.legs):
        m, (r_x, r_y) = load.moments[i], load.reactions[i]
        w = metatarsal_moment_under(points[i], load.reactions[i], x_r[i])
        angles = (leg.thigh, leg.shank, leg.foot, leg.toes)
        rates = joint_rates(walk.trunk.rate, *(angle.rate for angle in angles))
        (x_m, y_m), (v_x, v_y) = points[i].metatarsal.position, points[i].metatarsal.velocity
        v_x, v_y = v_x + leg.toes.rate * y_m, v_y + leg.toes.rate * (x_r[i] - x_m)
        shares = [f * v for f, v in zip((m.hip, m.knee, m.ankle, w), rates, strict=True)]
        shares += [r_x * v_x, r_y * v_y]
        total, terms = total + sum(shares), terms + sum(map(abs, shares))
    shifted = motion.at(0.15 + STEP).motion()
    value = kinetic_energy(body, shifted) + potential_energy(body, shifted)
    assert total == pytest.approx(float(value.imag / STEP.imag), abs=1e-12 * (terms + 1e3))
