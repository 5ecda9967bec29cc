"""(1) against Kane's method, against Newton's and Euler's laws, and against its own inverse."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given

from ergowalk.body import Body
from ergowalk.mechanics.dynamics import (
    COORDINATES,
    Coefficients,
    LegMoments,
    accelerations,
    applied_load,
    coefficients,
    forward_dynamics,
    inertial_load,
    joint_moments_from,
    motion_of,
    rates,
    total_reaction,
)
from ergowalk.mechanics.foot import foot_balance, toe_balance
from ergowalk.mechanics.kinematics import BodyMotion, leg_points

from .independent import kane_residual, newton_euler
from .spaces import (
    LAW,
    PAPER,
    Array,
    Load,
    State,
    bodies,
    loads,
    numbers,
    states,
)

ROUNDING = 1e-12
"""Allowed difference over the largest term."""


def equations(body: Body, state: State, load: Load) -> tuple[Array, float]:
    """Left minus right side of the eleven lines of (1), and the size of their terms."""
    motion, c = state.motion(), coefficients(body)
    left = inertial_load(c, motion)
    right = applied_load(c, motion, load.moments, load.reactions)
    feet = []
    for i in (0, 1):
        points = leg_points(body.leg(i), motion.legs[i], motion.hip)
        m, r, x = load.moments[i], load.reactions[i], load.pressure[i]
        feet += [-foot_balance(points, m.ankle, m.metatarsal, r)]
        feet += [-toe_balance(points, m.metatarsal, r, x)]
    lines = np.array([*np.subtract(left, right), *feet])
    # what each acceleration, rate and force may contribute, added without cancelling
    heavy = body.total_mass * (
        1 + np.abs(state.accelerations).max() + np.abs(state.rates).max() ** 2
    )
    reach = 1 + np.abs(state.positions[:2]).max() + np.abs(load.pressure).max()
    forces = np.abs(load.reactions).max() * reach + body.total_mass * body.gravity_m_s2
    return lines, float(heavy + forces + max(abs(m.hip) for m in load.moments))


@LAW
@given(bodies, states, loads())
def test_all_lines_agree_with_kanes_method(body: Body, state: State, load: Load) -> None:
    ours, scale = equations(body, state, load)
    assert np.abs(ours - kane_residual(body, state, load)).max() <= ROUNDING * scale


@LAW
@given(bodies, states, loads())
def test_inverse_dynamics_agrees_with_newton_and_euler(
    body: Body, state: State, load: Load
) -> None:
    motion, c = state.motion(), coefficients(body)
    ankles = [m.ankle for m in load.moments]
    law, lacking = newton_euler(body, state, load.reactions, ankles)
    moments = tuple(LegMoments(law[i, 1], law[i, 0], ankles[i], 0.0) for i in (0, 1))
    _, scale = equations(body, state, load)
    left = inertial_load(c, motion)
    right = applied_load(c, motion, (moments[0], moments[1]), load.reactions)
    expected = np.array([*lacking, 0.0, 0.0, 0.0, 0.0])
    assert np.abs(np.subtract(left, right) - expected).max() <= ROUNDING * scale


BENT = State(
    np.array([0.1, 0.9, -0.1, 0.5, -0.4, -0.3, -0.9, 0.6, 1.5, 0.4, 1.4]),
    np.array([1.3, 0.2, 0.3, 3.0, -2.0, -2.5, 1.5, 1.0, -1.0, 2.0, 0.5]),
    np.array([1.0, -2.0, 5.0, 20.0, -30.0, 10.0, 25.0, 0.0, 0.0, 0.0, 0.0]),
)
"""A posture of a step with both knees bent and both thighs turning."""

PUSH = Load(
    (LegMoments(30.0, -20.0, 10.0, 1.0), LegMoments(-40.0, 15.0, -70.0, -8.0)),
    ((-80.0, 400.0), (90.0, 350.0)),
    (0.05, -0.4),
)


def printed_sign(body: Body, state: State, lines: Array) -> Array:
    """The lines of (1) with + alpha'^2 sin(alpha - beta) in the shank line, as printed."""
    printed = lines.copy()
    for row, part in zip((4, 6), coefficients(body).legs, strict=True):
        alpha, beta, rate = state.positions[row - 1], state.positions[row], state.rates[row - 1]
        printed[row] += 2 * part.a * part.K_b * rate**2 * np.sin(alpha - beta)
    return printed


def test_printed_sign_of_the_shank_line_fails_kanes_method() -> None:
    lines, scale = equations(PAPER, BENT, PUSH)
    expected = kane_residual(PAPER, BENT, PUSH)
    assert np.abs(lines - expected).max() <= ROUNDING * scale
    wrong = np.abs(printed_sign(PAPER, BENT, lines) - expected)
    assert wrong[4] > 5.0  # N m
    assert wrong[6] > 2.0


def test_printed_sign_of_the_shank_line_fails_newton_and_euler() -> None:
    ankles = [m.ankle for m in PUSH.moments]
    law, _ = newton_euler(PAPER, BENT, PUSH.reactions, ankles)
    moments = [LegMoments(law[i, 1], law[i, 0], ankles[i], 0.0) for i in (0, 1)]
    lines, scale = equations(PAPER, BENT, Load((moments[0], moments[1]), PUSH.reactions, (0, 0)))
    assert np.abs(lines[3:7]).max() <= ROUNDING * scale
    wrong = np.abs(printed_sign(PAPER, BENT, lines)[3:7])
    assert wrong[1] > 5.0
    assert wrong[3] > 2.0


def inverse_dynamics(
    c: Coefficients, motion: BodyMotion, trailing: Array, ankle: float
) -> tuple[Any, Any]:
    """Reactions of both legs and (hip, knee, ankle) moments of each, under a trailing leg."""
    total = total_reaction(c, motion)
    reactions = (total[0] - trailing[0], total[1] - trailing[1]), (trailing[0], trailing[1])
    return reactions, joint_moments_from(c, motion, reactions, ankle)


@LAW
@given(bodies, states, numbers(2, 800.0), numbers(1, 150.0))
def test_joint_moments_satisfy_the_five_moment_lines(
    body: Body, state: State, trailing: Array, ankle: Array
) -> None:
    motion, c = state.motion(), coefficients(body)
    reactions, legs = inverse_dynamics(c, motion, trailing, ankle[0])
    moments = tuple(LegMoments(*leg, metatarsal=0.0) for leg in legs)
    left = np.array(inertial_load(c, motion))
    right = np.array(applied_load(c, motion, (moments[0], moments[1]), reactions))
    scale = np.abs(left).max() + np.abs(reactions).max() + np.abs(legs).max()
    assert np.abs(left - right).max() <= ROUNDING * scale
    assert legs[1][2] == ankle[0]


@LAW
@given(bodies, states, numbers(2, 800.0), numbers(1, 150.0))
def test_forward_dynamics_undoes_inverse_dynamics(
    body: Body, state: State, trailing: Array, ankle: Array
) -> None:
    motion, c = state.motion(), coefficients(body)
    reactions, legs = inverse_dynamics(c, motion, trailing, ankle[0])
    moments = LegMoments(*legs[0], metatarsal=0.0), LegMoments(*legs[1], metatarsal=0.0)
    at_rest = motion_of(state.positions, state.rates)  # knows nothing of the accelerations
    result = forward_dynamics(c, at_rest, moments, reactions)
    assert result == pytest.approx(np.array(accelerations(motion)), rel=1e-9, abs=1e-9)


def test_forward_dynamics_of_arrays_is_that_of_each_sample() -> None:
    rng = np.random.default_rng(7)
    positions, speeds = rng.uniform(-1, 1, (2, 7, 5))
    c = coefficients(PAPER)
    together = forward_dynamics(c, motion_of(positions, speeds), PUSH.moments, PUSH.reactions)
    assert together.shape == (7, 5)
    for k in range(5):
        one = forward_dynamics(
            c, motion_of(positions[:, k], speeds[:, k]), PUSH.moments, PUSH.reactions
        )
        assert one.shape == (7,)
        assert together[:, k] == pytest.approx(one, rel=1e-12, abs=1e-12)


def test_walker_in_free_fall_only_falls() -> None:
    nothing = LegMoments(0.0, 0.0, 0.0, 0.0)
    still = motion_of([0.0, 1.0, 0.2, 0.3, -0.2, -0.4, -0.5])
    result = forward_dynamics(
        coefficients(PAPER), still, (nothing, nothing), ((0.0, 0.0), (0.0, 0.0))
    )
    assert result == pytest.approx([0.0, -PAPER.gravity_m_s2, *5 * [0.0]], abs=1e-12)


def test_standing_upright_takes_no_moment_and_half_the_weight_on_each_leg() -> None:
    still = motion_of([0.0, 1.1, *5 * [0.0]])
    c = coefficients(PAPER)
    half = (0.0, PAPER.total_mass * PAPER.gravity_m_s2 / 2)
    assert total_reaction(c, still) == pytest.approx((0.0, 2 * half[1]))
    assert np.array(joint_moments_from(c, still, (half, half), 0.0)) == pytest.approx(0.0)


@LAW
@given(states)
def test_coordinates_of_a_motion_come_back_in_their_order(state: State) -> None:
    motion = motion_of(state.positions, state.rates, state.accelerations)
    legs = [angle for leg in motion.legs for angle in (leg.thigh.angle, leg.shank.angle)]
    assert [*motion.hip.position, motion.trunk.angle, *legs] == state.positions[:7].tolist()
    assert rates(motion) == state.rates[:7].tolist()
    assert accelerations(motion) == state.accelerations[:7].tolist()
    assert len(COORDINATES) == 7
