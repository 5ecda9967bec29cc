"""CasADi's symbols through the mechanics: the same numbers, and the derivatives they promise."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import fields, replace
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given

from ergowalk.body import Body
from ergowalk.mechanics import dynamics, energy, foot, kinematics
from ergowalk.mechanics.dynamics import LegMoments, motion_of
from ergowalk.mechanics.kinematics import BodyMotion, Point, Rotation
from ergowalk.mechanics.symbolic import MechanicsFunctions, casadi_functions

from .spaces import LAW, PAPER, Array, State, carried, numbers, states

LEG = PAPER.leg(0)
C = dynamics.coefficients(PAPER)


def walker(v: Any) -> BodyMotion:
    """A motion from 33 numbers: eleven positions, rates, accelerations."""
    body = motion_of(
        [v[i] for i in range(7)], [v[i] for i in range(11, 18)], [v[i] for i in range(22, 29)]
    )
    feet = [Rotation(v[i], v[11 + i], v[22 + i]) for i in range(7, 11)]
    first, second = body.legs
    legs = replace(first, foot=feet[0], toes=feet[1]), replace(second, foot=feet[2], toes=feet[3])
    return replace(body, legs=legs)


def forces(v: Any) -> tuple[Any, Any, Any]:
    """Moments, reactions and centre of pressure, of any numbers at hand."""
    moments = tuple(LegMoments(*(10 * v[i + k] for k in (0, 2, 4, 6))) for i in (22, 23))
    return moments, ((v[30], v[31]), (v[31], v[32])), v[0]


def flat(points: Any) -> list[Any]:
    """All numbers of some points."""
    several = (
        [points] if isinstance(points, Point) else [getattr(points, f.name) for f in fields(points)]
    )
    return [x for p in several for pair in (p.position, p.velocity, p.acceleration) for x in pair]


def points_of(v: Any) -> kinematics.LegPoints:
    motion = walker(v)
    return kinematics.leg_points(LEG, motion.legs[0], motion.hip)


def hip_over(contact: str) -> Callable[[Any], list[Any]]:
    return lambda v: flat(
        kinematics.hip_over_contact(LEG, walker(v).legs[1], contact, (v[0], v[1]))
    )


FORMULAS: dict[str, Callable[[Any], list[Any]]] = {
    "leg_points": lambda v: flat(points_of(v)),
    "hip_over_heel": hip_over("heel"),
    "hip_over_metatarsal": hip_over("metatarsal"),
    "joint_angles": lambda v: [*kinematics.joint_angles(LEG, *(v[i] for i in range(5)))],
    "joint_rates": lambda v: [*kinematics.joint_rates(*(v[i] for i in range(5)))],
    "mass_matrix": lambda v: [x for row in dynamics.mass_matrix(C, walker(v)) for x in row],
    "centrifugal_and_gravity": lambda v: dynamics.centrifugal_and_gravity(C, walker(v)),
    "inertial_load": lambda v: dynamics.inertial_load(C, walker(v)),
    "applied_load": lambda v: dynamics.applied_load(C, walker(v), *forces(v)[:2]),
    "net_load": lambda v: dynamics.net_load(C, walker(v), *forces(v)[:2]),
    "accelerations": lambda v: dynamics.accelerations(walker(v)),
    "rates": lambda v: dynamics.rates(walker(v)),
    "total_reaction": lambda v: [*dynamics.total_reaction(C, walker(v))],
    "joint_moments_from": lambda v: [
        x for leg in dynamics.joint_moments_from(C, walker(v), forces(v)[1], v[3]) for x in leg
    ],
    "kinetic_energy": lambda v: [energy.kinetic_energy(PAPER, walker(v))],
    "potential_energy": lambda v: [energy.potential_energy(PAPER, walker(v))],
    "foot_balance": lambda v: [foot.foot_balance(points_of(v), v[22], v[23], (v[30], v[31]))],
    "toe_balance": lambda v: [foot.toe_balance(points_of(v), v[23], (v[30], v[31]), v[0])],
    "pressure_moment": lambda v: [foot.pressure_moment(points_of(v), v[22], (v[30], v[31]))],
    "ankle_moment_under": lambda v: [foot.ankle_moment_under(points_of(v), (v[30], v[31]), v[0])],
    "metatarsal_moment_under": lambda v: [
        foot.metatarsal_moment_under(points_of(v), (v[30], v[31]), v[0])
    ],
    "reaction_from_moments": lambda v: [
        *foot.reaction_from_moments(points_of(v), v[22], v[23], v[0])
    ],
}


@pytest.mark.parametrize("name", FORMULAS)
def test_symbols_and_numbers_give_the_same(name: str) -> None:
    formula, v = FORMULAS[name], ca.SX.sym("v", 33)
    symbolic = ca.Function(name, [v], [ca.vertcat(*formula(v))])
    rng = np.random.default_rng(33)
    for _ in range(5):
        sample = rng.uniform(-1.5, 1.5, 33) * np.repeat([1.0, 5.0, 40.0], 11)
        plain = np.array(formula(sample), dtype=float)
        assert np.array(symbolic(sample)).ravel() == pytest.approx(plain, rel=1e-12, abs=1e-10)


@pytest.mark.parametrize("name", FORMULAS)
def test_arrays_and_numbers_give_the_same(name: str) -> None:
    rng = np.random.default_rng(34)
    samples = rng.uniform(-1.5, 1.5, (33, 4))
    together = FORMULAS[name](samples)
    for k in range(4):
        alone = FORMULAS[name](samples[:, k])
        for many, one in zip(together, alone, strict=True):
            value = np.broadcast_to(many, 4)[k]
            assert value == pytest.approx(one, rel=1e-13, abs=1e-12)


UNLIKE = PAPER.replace(thigh_mass_kg=(8.0, 9.0), shank_length_m=(0.53, 0.50))


@cache
def functions(body: Body = UNLIKE) -> MechanicsFunctions:
    return casadi_functions(body)


def test_functions_name_their_inputs_and_state_their_shapes() -> None:
    f = functions()
    names = ["q", "qd", "qdd", "trailing_reaction", "trailing_ankle"]
    assert f.inverse_dynamics.name_in() == names
    assert [f.inverse_dynamics.size_in(i) for i in range(5)] == [
        (7, 1),
        (7, 1),
        (7, 1),
        (2, 1),
        (1, 1),
    ]
    assert f.inverse_dynamics.name_out() == ["moments", "reactions"]
    assert [f.inverse_dynamics.size_out(i) for i in range(2)] == [(3, 2), (2, 2)]
    assert f.forward_dynamics.name_in() == ["q", "qd", "moments", "reactions"]
    assert f.forward_dynamics.size_out("qdd") == (7, 1)
    assert f.mass_matrix.size_out("mass_matrix") == (7, 7)
    assert (f.kinetic_energy.name_in(), f.potential_energy.name_in()) == (["q", "qd"], ["q"])


def row(value: Any) -> Array:
    return np.array(value, dtype=float).ravel()


@LAW
@given(states, numbers(2, 500.0), numbers(1, 100.0))
def test_functions_give_the_numbers_of_the_mechanics(
    state: State, trailing: Array, ankle: Array
) -> None:
    f, motion, c = functions(), state.motion(), dynamics.coefficients(UNLIKE)
    q, qd, qdd = state.positions[:7], state.rates[:7], state.accelerations[:7]
    load = carried(UNLIKE, motion, trailing, ankle[0])
    expected = [[m.hip, m.knee, m.ankle] for m in load.moments]
    scale = np.abs(expected).max() + np.abs(load.reactions).max()
    moments, reactions = f.inverse_dynamics(q, qd, qdd, trailing, ankle[0])
    assert pytest.approx(np.array(expected), abs=1e-12 * scale) == np.array(moments).T
    assert pytest.approx(np.array(load.reactions), abs=1e-12 * scale) == np.array(reactions).T
    matrix = np.array(dynamics.mass_matrix(c, motion))
    assert np.array(f.mass_matrix(q)) == pytest.approx(matrix, abs=1e-13)
    forward = dynamics.forward_dynamics(c, motion, load.moments, load.reactions)
    result = row(f.forward_dynamics(q, qd, moments, reactions))
    assert result == pytest.approx(forward, rel=1e-9, abs=1e-9)
    assert result == pytest.approx(qdd, rel=1e-9, abs=1e-9)
    kinetic = energy.kinetic_energy(UNLIKE, motion)
    assert float(f.kinetic_energy(q, qd)) == pytest.approx(kinetic, rel=1e-12)
    height = energy.potential_energy(UNLIKE, motion)
    assert float(f.potential_energy(q)) == pytest.approx(height, abs=1e-10)


@cache
def lagrange() -> ca.Function:
    """d/dt dT/dq' - dT/dq + dV/dq by automatic differentiation of the two energies."""
    f = functions()
    q, qd, qdd = (ca.SX.sym(name, 7) for name in ("q", "qd", "qdd"))
    kinetic = f.kinetic_energy(q, qd)
    momentum = ca.gradient(kinetic, qd)
    change = ca.jtimes(momentum, q, qd) + ca.jtimes(momentum, qd, qdd)
    lines = change - ca.gradient(kinetic, q) + ca.gradient(f.potential_energy(q), q)
    return ca.Function("lagrange", [q, qd, qdd], [lines])


@LAW
@given(states)
def test_equations_of_motion_are_lagranges_of_the_energies(state: State) -> None:
    motion = state.motion()
    parts = state.positions[:7], state.rates[:7], state.accelerations[:7]
    load = np.array(dynamics.inertial_load(dynamics.coefficients(UNLIKE), motion))
    scale = UNLIKE.total_mass * (1 + np.abs(parts[1]).max() ** 2 + np.abs(parts[2]).max())
    assert row(lagrange()(*parts)) == pytest.approx(load, abs=1e-12 * scale)


def test_mechanics_load_casadi_only_when_asked() -> None:
    code = "import sys, ergowalk.mechanics.symbolic; print('casadi' in sys.modules)"
    path = os.pathsep.join(p for p in sys.path if p)
    answer = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": path},
    )
    assert answer.stdout.strip() == "False"
