"""Springs and dampers: moments are slopes of energies, and power has the right sign."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.mechanics.devices import ROUNDING, SENSE, Law, joint_rotation
from ergowalk.mechanics.kinematics import LegMotion, Rotation, joint_rates

LEG = Body().leg(0)
deflections = st.floats(-1.5, 1.5)
stiffnesses = st.floats(0.0, 800.0)


@given(deflections, stiffnesses, stiffnesses)
def test_the_moment_of_a_spring_is_the_slope_of_its_energy(
    x: float, up: float, down: float
) -> None:
    law, step = Law(up, down, 0.0), 1e-5
    slope = (law.stored(x + step) - law.stored(x - step)) / (2 * step)
    assert law.spring(x) == pytest.approx(slope, rel=1e-5, abs=1e-5)
    bend = (law.spring(x + step) - law.spring(x - step)) / (2 * step)
    assert law.slope(x) == pytest.approx(bend, rel=1e-4, abs=1e-4)


@given(stiffnesses, stiffnesses)
def test_a_spring_is_slack_at_rest(up: float, down: float) -> None:
    law = Law(up, down, 0.0)
    assert law.spring(0.0) == pytest.approx(0.0, abs=1e-12)
    assert law.stored(0.0) == pytest.approx(0.0, abs=1e-12)


def test_two_slopes_are_those_that_were_given_away_from_rest() -> None:
    law = Law(100.0, 300.0, 0.0)
    assert law.slope(0.5) == pytest.approx(100.0, rel=1e-3)
    assert law.slope(-0.5) == pytest.approx(300.0, rel=1e-3)
    assert law.spring(0.5) == pytest.approx(50.0, abs=200 * ROUNDING)
    assert law.spring(-0.5) == pytest.approx(-150.0, abs=200 * ROUNDING)


def test_equal_slopes_are_a_linear_spring() -> None:
    x = np.linspace(-1, 1, 11)
    linear = Law(200.0, 200.0, 0.0)
    np.testing.assert_allclose(linear.spring(x), 200.0 * x, atol=1e-12)
    np.testing.assert_allclose(linear.stored(x), 100.0 * x**2, atol=1e-12)


@given(deflections, st.floats(-8, 8), st.floats(-80, 80))
def test_the_rate_of_a_moment_is_its_time_derivative(x: float, v: float, a: float) -> None:
    law, step = Law(120.0, 40.0, 3.0), 1e-6

    def moment(t: float) -> float:
        return float(law.moment(x + v * t + a * t**2 / 2, v + a * t))

    found = (moment(step) - moment(-step)) / (2 * step)
    assert law.moment_rate(x, v, a) == pytest.approx(found, rel=1e-4, abs=1e-3)


def test_symbols_go_through_the_same_lines() -> None:
    x, law = ca.SX.sym("x"), Law(120.0, 40.0, 3.0)
    out = [law.spring(x), law.slope(x), law.stored(x), law.moment(x, 2.0)]
    found = ca.Function("f", [x], out)(0.07)
    wanted = (law.spring(0.07), law.slope(0.07), law.stored(0.07), law.moment(0.07, 2.0))
    np.testing.assert_allclose([float(v) for v in found], wanted, rtol=1e-12)


@pytest.mark.parametrize("joint", SENSE)
def test_what_a_device_gives_it_loses(joint: str) -> None:
    """Moment on the distal segment times relative rate is minus the growth of the energy."""
    law, step = Law(150.0, 60.0, 0.0), 1e-6
    angles, rates = (0.02, 0.4, -0.3, 0.9, 1.9), (0.3, -1.2, 2.1, 0.7, -1.5)

    def at(t: float) -> tuple[Rotation, LegMotion]:
        trunk, *legs = (Rotation(a + w * t, w) for a, w in zip(angles, rates, strict=True))
        return trunk, LegMotion(*legs)

    def stored(t: float) -> float:
        return float(law.stored(joint_rotation(LEG, joint, *at(t)).angle))

    x = joint_rotation(LEG, joint, *at(0.0))
    moment = -SENSE[joint] * law.moment(x.angle, x.rate)
    power = moment * joint_rates(*rates)[list(SENSE).index(joint)]
    assert power == pytest.approx(-(stored(step) - stored(-step)) / (2 * step), rel=1e-6)


@pytest.mark.parametrize("joint", SENSE)
def test_a_damper_only_takes(joint: str) -> None:
    rates = (0.3, -1.2, 2.1, 0.7, -1.5)
    trunk, *legs = (Rotation(0.1, w) for w in rates)
    x = joint_rotation(LEG, joint, trunk, LegMotion(*legs))
    moment = -SENSE[joint] * Law(0.0, 0.0, 2.0).moment(x.angle, x.rate)
    power = moment * joint_rates(*rates)[list(SENSE).index(joint)]
    assert power == pytest.approx(-2.0 * x.rate**2)
    assert power < 0
