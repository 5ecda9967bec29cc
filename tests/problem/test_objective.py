"""Objective (10): powers, signs, and the two ways to write E."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from ergowalk.mechanics.dynamics import LegMoments
from ergowalk.mechanics.kinematics import LegMotion, Rotation
from ergowalk.problem.objective import energy_per_metre, eq10_joint_powers
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
