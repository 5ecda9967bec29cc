"""The massless two-link foot: balance of moments, centre of pressure, toe-tip chain."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.mechanics.foot import (
    ankle_moment_under,
    foot_balance,
    metatarsal_moment_under,
    pressure_moment,
    reaction_from_moments,
    toe_balance,
    toe_chain,
)
from ergowalk.mechanics.kinematics import LegPoints, Point, Rotation, Vector, leg_points, link

from .spaces import LAW, PAPER, Array, State, bodies, numbers, states

LEG = PAPER.leg(0)


def moment(arm: Vector, force: Vector) -> float:
    """Counter-clockwise moment of a force at the end of an arm."""
    return float(arm[0] * force[1] - arm[1] * force[0])


def points_of(body: Body, state: State) -> LegPoints:
    motion = state.motion()
    return leg_points(body.leg(0), motion.legs[0], motion.hip)


@LAW
@given(bodies, states, numbers(2, 800.0), st.floats(-1, 1))
def test_ankle_and_metatarsal_moments_balance_foot_and_toes(
    body: Body, state: State, force: Array, x_r: float
) -> None:
    points, reaction = points_of(body, state), (force[0], force[1])
    ankle = ankle_moment_under(points, reaction, x_r)
    metatarsal = metatarsal_moment_under(points, reaction, x_r)
    scale = 1e-13 * (1 + np.abs(force).max()) * 10
    assert foot_balance(points, ankle, metatarsal, reaction) == pytest.approx(0, abs=scale)
    assert toe_balance(points, metatarsal, reaction, x_r) == pytest.approx(0, abs=scale)


@LAW
@given(bodies, states, numbers(2, 800.0), numbers(2, 150.0), st.floats(-1, 1))
def test_balances_are_the_moments_about_the_metatarsal_joint(
    body: Body, state: State, force: Array, moments: Array, x_r: float
) -> None:
    """The shank pushes the foot's ankle with -R, the ground the toes with +R."""
    points, reaction = points_of(body, state), (force[0], force[1])
    opposite = (-force[0], -force[1])
    arm = (points.ankle - points.metatarsal).position
    expected = moments[0] - moments[1] + moment(arm, opposite)
    assert foot_balance(points, moments[0], moments[1], reaction) == pytest.approx(
        expected, abs=1e-9
    )
    arm = (Point((x_r, 0.0)) - points.metatarsal).position
    expected = moments[1] + moment(arm, reaction)
    assert toe_balance(points, moments[1], reaction, x_r) == pytest.approx(expected, abs=1e-9)


@LAW
@given(bodies, states, numbers(2, 800.0), st.floats(-1, 1))
def test_pressure_moment_finds_the_centre_of_pressure_again(
    body: Body, state: State, force: Array, x_r: float
) -> None:
    points, reaction = points_of(body, state), (force[0], force[1])
    ankle = ankle_moment_under(points, reaction, x_r)
    scale = 1e-13 * (1 + np.abs(force).max()) * 10
    assert pressure_moment(points, ankle, reaction) == pytest.approx(x_r * force[1], abs=scale)


@LAW
@given(bodies, states, numbers(2, 800.0), st.floats(-1, 1))
def test_reaction_from_moments_undoes_the_moments(
    body: Body, state: State, force: Array, x_r: float
) -> None:
    points, reaction = points_of(body, state), (force[0], force[1])
    (x_a, y_a), (x_m, y_m) = points.ankle.position, points.metatarsal.position
    determinant = y_a * (x_r - x_m) - y_m * (x_r - x_a)
    assume(abs(determinant) > 1e-2)  # ankle, metatarsal and pressure not in one line
    ankle = ankle_moment_under(points, reaction, x_r)
    metatarsal = metatarsal_moment_under(points, reaction, x_r)
    found = reaction_from_moments(points, ankle, metatarsal, x_r)
    assert found == pytest.approx(tuple(force), rel=1e-9, abs=1e-9)


def chain(gamma: Rotation, epsilon: Rotation, toe_tip: Vector) -> Point:
    """The ankle of a foot with these rotations whose toe tip rests at ``toe_tip``."""
    return Point(toe_tip) - link(LEG.toe_length, epsilon) - link(LEG.ankle_to_metatarsal, gamma)


@LAW
@given(
    st.floats(-1.0, 1.5),
    st.floats(0.05, 2.5),
    numbers(4, 1.0).map(lambda v: v * [5.0, 5.0, 50.0, 50.0]),
    numbers(2, 1.0),
)
def test_toe_chain_closes_and_moves_with_the_ankle(
    foot: float, bend: float, moving: Array, tip: Array
) -> None:
    gamma = Rotation(foot, moving[0], moving[2])
    epsilon = Rotation(foot + bend, moving[1], moving[3])
    toe_tip = (tip[0], tip[1])
    found = toe_chain(LEG, chain(gamma, epsilon, toe_tip), toe_tip)
    digits = 1e-12 / np.sin(bend) ** 4  # a stretched chain magnifies rounding
    for ours, expected in zip(found, (gamma, epsilon), strict=True):
        assert ours.angle == pytest.approx(expected.angle, abs=digits)
        assert ours.rate == pytest.approx(expected.rate, abs=10 * digits)
        assert ours.acceleration == pytest.approx(expected.acceleration, abs=1000 * digits)


def test_toe_chain_rates_are_derivatives_along_a_path_of_the_ankle() -> None:
    def ankle(t: float | Array) -> Point:
        return Point(
            (0.05 * np.sin(3 * t), 0.18 + 0.02 * np.cos(5 * t)),
            (0.15 * np.cos(3 * t), -0.1 * np.sin(5 * t)),
            (-0.45 * np.sin(3 * t), -0.5 * np.cos(5 * t)),
        )

    h, times = 2e-4, np.linspace(0, 0.5, 11)
    here = toe_chain(LEG, ankle(times), (0.15, 0.0))
    near = [toe_chain(LEG, ankle(times + k * h), (0.15, 0.0)) for k in (-2, -1, 1, 2)]
    for link_index in (0, 1):
        now = here[link_index]
        for value, rate in (("angle", "rate"), ("rate", "acceleration")):
            f = [getattr(sample[link_index], value) for sample in near]
            slope = (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * h)
            assert np.abs(slope).max() > 0.5
            assert getattr(now, rate) == pytest.approx(slope, abs=1e-8 * np.abs(slope).max())


def test_toe_chain_bends_with_the_metatarsal_joint_down_and_forward() -> None:
    gamma, epsilon = toe_chain(LEG, Point((0.0, 0.15)), (0.15, 0.0))
    assert gamma.angle < epsilon.angle
    metatarsal = (Point((0.0, 0.15)) + link(LEG.ankle_to_metatarsal, gamma)).position
    # right of the line from the ankle (0, 0.15) to the toe tip (0.15, 0) means below it
    assert metatarsal[0] + metatarsal[1] < 0.15


@pytest.mark.parametrize("height", [0.271, 1.0, 0.069, 0.0])
def test_toe_chain_out_of_reach_is_nan_without_a_warning(height: float) -> None:
    """0.27 m is the stretched chain, 0.07 m the folded one."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gamma, epsilon = toe_chain(LEG, Point((0.0, height)), (0.0, 0.0))
    for rotation in (gamma, epsilon):
        assert np.isnan([rotation.angle, rotation.rate, rotation.acceleration]).all()


def test_toe_chain_reaches_sample_by_sample() -> None:
    heights = np.array([0.1, 0.3, 0.2])
    gamma, epsilon = toe_chain(LEG, Point((np.zeros(3), heights)), (0.0, 0.0))
    assert np.isnan(gamma.angle).tolist() == [False, True, False]
    assert np.isnan(epsilon.acceleration).tolist() == [False, True, False]


def test_toe_chain_exactly_stretched_has_no_finite_rate() -> None:
    leg = Body(ankle_to_metatarsal_m=0.5, heel_to_metatarsal_m=0.5, toe_length_m=0.25).leg(0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gamma, epsilon = toe_chain(leg, Point((0.0, 0.75), (0.0, 1.0)), (0.0, 0.0))
    assert (gamma.angle, epsilon.angle) == (0.0, 0.0)
    assert not np.isfinite([gamma.rate, epsilon.rate]).any()
