"""Objective (10): powers, signs, and the two ways to write E."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from ergowalk.errors import ProblemError
from ergowalk.mechanics.dynamics import LegMoments
from ergowalk.mechanics.kinematics import LegMotion, Rotation
from ergowalk.problem import Objective
from ergowalk.problem.files import problem_from_toml
from ergowalk.problem.objective import energy_per_metre, eq10_joint_powers, squared_moments
from ergowalk.solution.energy import joint_energies

Array = NDArray[np.float64]

numbers = arrays(np.float64, 9, elements=st.floats(-50, 50))


def powers(values: Array) -> tuple[float, ...]:
    """q, u, p, w, psi', alpha', beta', gamma', epsilon' -> four powers."""
    moments = LegMoments(*values[:4])
    trunk, *segments = (Rotation(0.3, rate) for rate in values[4:])
    return eq10_joint_powers(moments, trunk, LegMotion(*segments))


@given(numbers)
def test_eq10_is_the_papers_up_to_the_sign_that_the_absolute_value_hides(values: Array) -> None:
    """(10) writes q (psi' - alpha'), u (alpha' - beta'), p (beta' - gamma'), w (gamma' -
    epsilon')."""
    q, u, p, w, psi, alpha, beta, gamma, epsilon = values
    printed = (q * (psi - alpha), u * (alpha - beta), p * (beta - gamma), w * (gamma - epsilon))
    np.testing.assert_allclose(powers(values), [-x for x in printed], atol=1e-12)
    np.testing.assert_allclose(np.abs(powers(values)), np.abs(printed), atol=1e-12)


@pytest.mark.parametrize("joint", range(4))
def test_a_moment_along_the_motion_of_the_distal_segment_does_positive_work(joint: int) -> None:
    values = np.zeros(9)
    values[joint], values[5 + joint] = 2.0, 3.0
    found = powers(values)
    assert found[joint] == 6.0
    assert all(x == 0 for j, x in enumerate(found) if j != joint)


@given(numbers, st.floats(-20, 20))
def test_turning_as_one_body_costs_nothing(values: Array, rate: float) -> None:
    turning = np.concatenate([values[:4], values[4:] + rate])
    np.testing.assert_allclose(powers(turning), powers(values), atol=1e-10)


def test_eq10_alone_is_the_default() -> None:
    assert Objective().is_eq10
    assert Objective().of_work == (1.0, 1.0)
    assert Objective().sentence() == "E"
    assert not Objective(positive_work=0.1).is_eq10
    assert not Objective(moment_squared_s_per_m2=0.1).is_eq10


def test_a_joule_costs_what_its_terms_say() -> None:
    muscles = Objective(absolute_work=0.0, muscle_work=1.0)
    assert muscles.of_work == pytest.approx((1 / 0.25, 1 / 1.2))
    assert Objective(absolute_work=0.0, positive_work=2.0).of_work == (2.0, 0.0)
    back = Objective(absolute_work=0.0, regenerative_work=1.0, regenerated_share=0.3)
    assert back.of_work == pytest.approx((1.0, -0.3))
    both = Objective(absolute_work=0.5, positive_work=1.0, muscle_work=0.25, regenerative_work=2.0)
    assert both.of_work == pytest.approx((0.5 + 1.0 + 1.0 + 2.0, 0.5 + 0.25 / 1.2 - 1.0))


def test_moments_alone_charge_no_work() -> None:
    squares = Objective(absolute_work=0.0, moment_squared_s_per_m2=0.1)
    assert not squares.charges_work
    assert squares.charges_moments
    assert squares.sentence() == "0.1 s/m2 x squared moments"
    assert squared_moments([3.0, -4.0]) == 25.0


def test_an_objective_without_a_weight_is_refused() -> None:
    with pytest.raises(ProblemError, match=r"absolute_work = 0\.0: all weights .* zero; give"):
        Objective(absolute_work=0.0)


@pytest.mark.parametrize("share", [1.0, -0.1, 2.0])
def test_not_all_negative_work_can_be_won_back(share: float) -> None:
    """With all of it, the objective of a periodic walk would be zero whatever it does."""
    with pytest.raises(ProblemError, match=r"regenerated_share = .*: should be"):
        Objective(regenerative_work=1.0, regenerated_share=share)


def test_the_cost_of_moment_rates_may_stand_where_it_once_stood() -> None:
    given = "step_length_m = 0.7\nstride_time_s = 1.1\n[limits]\nmoment_rate_cost_s3_per_m2 = "
    assert problem_from_toml(given + '"off"').objective.is_eq10
    moved = problem_from_toml(given + "0.001").objective
    assert moved == Objective(moment_rate_squared_s3_per_m2=0.001)
    with pytest.raises(ProblemError, match=r"objective\.moment_rate_squared_s3_per_m2 = -1"):
        problem_from_toml(given + "-1")


def test_e_of_the_half_stride_is_e_of_the_stride() -> None:
    """1/(2L) over T equals 1/L over T/2, both legs counted each time."""
    half, step = 0.57, 0.76
    t = np.linspace(0, half, 201)
    rng = np.random.default_rng(5)
    waves = rng.normal(size=(4, 3))
    power = np.stack([np.polynomial.polynomial.polyval(t, wave) for wave in waves])
    half_integral = sum(float(np.sum(np.abs(p[:-1] + p[1:]) / 2) * t[1]) for p in power)
    legs = np.stack([power[:2], power[2:]]).transpose(2, 0, 1)  # two joints of each leg
    stride = np.concatenate([legs, legs[:, ::-1]])  # then the legs change places
    dataset = xr.Dataset(
        {"joint_power": (("time", "leg", "joint"), stride)},
        coords={"time": np.concatenate([t, t + half]), "joint": ["hip", "knee"]},
    )
    whole = sum(joint_energies(dataset).values()) / (2 * step)
    assert whole == pytest.approx(energy_per_metre(half_integral, step), rel=1e-4)


def test_a_longer_step_for_the_same_work_is_cheaper() -> None:
    assert energy_per_metre(76.0, 0.76) == pytest.approx(100.0)
    assert energy_per_metre(76.0, 1.52) == pytest.approx(50.0)
