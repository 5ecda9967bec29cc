"""Newton and Euler segment by segment against the equations of motion (1) and against energy."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ergowalk.audit import balance
from ergowalk.audit.balance import Loads
from ergowalk.audit.walker import Body as Points
from ergowalk.audit.walker import Moving, Turning, Walker, body_points
from ergowalk.body import Body
from ergowalk.mechanics import dynamics, kinematics
from ergowalk.mechanics import energy as mechanics_energy
from ergowalk.mechanics import foot as mechanics_foot

UNEQUAL = Body(
    thigh_length_m=(0.47, 0.45), shank_mass_kg=(3.51, 3.2), heel_to_metatarsal_m=(0.2, 0.19)
)


def walker_of(body: Body) -> Walker:
    """The same body as the audit reads it."""
    return Walker.from_json(json.dumps(body.by_symbol()))


class Walk:
    """A smooth motion of all nine links at the given instants, with exact derivatives."""

    def __init__(self, seed: int, time: np.ndarray) -> None:
        rng = np.random.default_rng(seed)

        def curve(level: float, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
            value, rate, acceleration = np.full(time.shape, level), 0 * time, 0 * time
            for harmonic in (1, 2, 3):
                w = 2 * np.pi * harmonic
                a, phase = rng.normal(0, size / harmonic), rng.uniform(0, 2 * np.pi)
                value = value + a * np.sin(w * time + phase)
                rate = rate + a * w * np.cos(w * time + phase)
                acceleration = acceleration - a * w**2 * np.sin(w * time + phase)
            return value, rate, acceleration

        self.x, self.y = curve(0.0, 0.05), curve(0.9, 0.03)
        self.psi = curve(0.0, 0.1)
        self.angles = [[curve(m, 0.3) for m in (0.1, -0.2, 1.0, 1.5)] for _ in (1, 2)]

    def audited(self, walker: Walker) -> tuple[Turning, tuple[Turning, ...], Points]:
        """Trunk, segments and points as the audit computes them."""
        hip = Moving(*(x + 1j * y for x, y in zip(self.x, self.y, strict=True)))
        trunk = Turning(*self.psi)
        segments = tuple(
            Turning(*(np.stack([leg[s][k] for leg in self.angles], axis=-1) for k in range(3)))
            for s in range(4)
        )
        return trunk, segments, body_points(walker, hip, trunk, segments)

    def solved(self) -> kinematics.BodyMotion:
        """The same motion as the package computes with it."""
        legs = tuple(
            kinematics.LegMotion(*(kinematics.Rotation(*angle) for angle in leg))
            for leg in self.angles
        )
        hip = kinematics.Point(*zip(self.x, self.y, strict=True))
        return kinematics.BodyMotion(hip, kinematics.Rotation(*self.psi), (legs[0], legs[1]))


def inverse_dynamics(body: Body, walk: Walk, seed: int) -> Loads:
    """Moments and reactions that (1) gives for a motion, both feet loaded at random places."""
    rng = np.random.default_rng(seed)
    motion, c = walk.solved(), dynamics.coefficients(body)
    points = [kinematics.leg_points(body.leg(i), motion.legs[i], motion.hip) for i in (0, 1)]
    total_x, total_y = dynamics.total_reaction(c, motion)
    share = 0.3 + 0.4 * rng.random()
    reactions = ((share * total_x, share * total_y), ((1 - share) * total_x, (1 - share) * total_y))
    pressure_2 = points[1].ankle.position[0] + 0.1
    p_2 = mechanics_foot.ankle_moment_under(points[1], reactions[1], pressure_2)
    upper = dynamics.joint_moments_from(c, motion, reactions, p_2)
    moments, pressures = [], []
    for leg in (0, 1):
        x_r = mechanics_foot.pressure_moment(points[leg], upper[leg][2], reactions[leg])
        x_r = x_r / reactions[leg][1]
        w = mechanics_foot.metatarsal_moment_under(points[leg], reactions[leg], x_r)
        moments.append(np.stack([*upper[leg], w], axis=-1))
        pressures.append(x_r)
    reaction = np.stack([r_x + 1j * r_y for r_x, r_y in reactions], axis=-1)
    return Loads(np.stack(moments, axis=1), reaction, np.stack(pressures, axis=-1))


def largest_residual(walker: Walker, walk: Walk, loads: Loads) -> float:
    """Largest of the eleven residuals per M g."""
    trunk, segments, points = walk.audited(walker)
    left = balance.residuals(walker, points, trunk, segments, loads)
    parts = (left.trunk_force, left.trunk_moment, left.segment_moment)
    return max(float(np.max(np.abs(part))) for part in parts) / walker.weight


@pytest.mark.parametrize("body", [Body(), UNEQUAL], ids=["paper", "unequal legs"])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_two_derivations_of_the_equations_of_motion_agree(body: Body, seed: int) -> None:
    walk = Walk(seed, np.linspace(0.0, 1.0, 50))
    loads = inverse_dynamics(body, walk, seed)
    assert largest_residual(walker_of(body), walk, loads) < 1e-12


@pytest.mark.parametrize("joint", range(4), ids=["hip", "knee", "ankle", "metatarsal"])
def test_each_joint_moment_enters_the_balance(joint: int) -> None:
    walk = Walk(3, np.linspace(0.0, 1.0, 50))
    loads = inverse_dynamics(Body(), walk, 3)
    loads.moments[:, 1, joint] += 1.0  # N m
    walker = walker_of(Body())
    assert largest_residual(walker, walk, loads) == pytest.approx(1 / walker.weight, rel=1e-6)


def test_the_printed_sign_of_the_shank_equation_breaks_the_balance() -> None:
    walk, body = Walk(4, np.linspace(0.0, 1.0, 50)), Body()
    loads = inverse_dynamics(body, walk, 4)
    thigh, shank = walk.angles[0][0], walk.angles[0][1]
    coupling = dynamics.coefficients(body).legs[0]
    printed = 2 * coupling.a * coupling.K_b * thigh[1] ** 2 * np.sin(thigh[0] - shank[0])
    loads.moments[:, 0, 1] += printed
    assert largest_residual(walker_of(body), walk, loads) > 1e-4


@pytest.mark.parametrize("seed", [0, 5])
def test_power_of_moments_and_ground_is_the_rate_of_energy(seed: int) -> None:
    time = np.linspace(0.0, 1.0, 4001)
    walk, walker = Walk(seed, time), walker_of(Body())
    loads = inverse_dynamics(Body(), walk, seed)
    trunk, segments, points = walk.audited(walker)
    energy = balance.mechanical_energy(walker, points, trunk, segments)
    power = (loads.moments * balance.relative_rates(trunk, segments)).sum(axis=(1, 2))
    on_toes = np.ones_like(loads.pressure, dtype=bool)
    power = power + balance.ground_power(points, segments, loads, on_toes).sum(axis=1)
    rate = np.gradient(energy, time, edge_order=2)[5:-5]
    assert rate == pytest.approx(power[5:-5], abs=2e-4 * np.max(np.abs(power)))


def test_energy_agrees_with_the_package() -> None:
    walk = Walk(6, np.linspace(0.0, 1.0, 20))
    walker, motion = walker_of(UNEQUAL), walk.solved()
    trunk, segments, points = walk.audited(walker)
    expected = mechanics_energy.kinetic_energy(UNEQUAL, motion)
    expected = expected + mechanics_energy.potential_energy(UNEQUAL, motion)
    found = balance.mechanical_energy(walker, points, trunk, segments)
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", ["knee", "ankle", "heel", "metatarsal", "toe_tip"])
@pytest.mark.parametrize("order", ["position", "velocity", "acceleration"])
def test_points_of_the_legs_agree_with_the_package(name: str, order: str) -> None:
    walk = Walk(7, np.linspace(0.0, 1.0, 20))
    _, _, points = walk.audited(walker_of(UNEQUAL))
    motion = walk.solved()
    for leg in (0, 1):
        expected = kinematics.leg_points(UNEQUAL.leg(leg), motion.legs[leg], motion.hip)
        x, y = getattr(getattr(expected, name), order)
        found = getattr(getattr(points, name), order)[:, leg]
        assert found == pytest.approx(x + 1j * y, abs=1e-11)


def test_sole_angle_and_ankle_height_of_the_paper() -> None:
    walker = walker_of(Body())
    assert np.degrees(walker.sole_angle) == pytest.approx([36.7, 36.7], abs=0.05)
    assert walker.flat_ankle.imag == pytest.approx([0.102, 0.102], abs=5e-4)
