"""The mass matrix of (1): symmetric, positive definite, the matrix of the kinetic energy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.errors import BodyError
from ergowalk.mechanics.dynamics import (
    accelerations,
    centrifugal_and_gravity,
    coefficients,
    inertial_load,
    mass_matrix,
    motion_of,
)
from ergowalk.mechanics.energy import kinetic_energy, potential_energy

from .spaces import LAW, PAPER, Array, State, bodies, body_fields, numbers, states

STEP = 1e-30
"""Size of an imaginary step: derivatives without a difference."""


def matrix_at(body: Body, positions: Array) -> Array:
    return np.array(mass_matrix(coefficients(body), motion_of(positions)))


@LAW
@given(bodies, numbers(7, np.pi))
def test_symmetric_and_positive_definite_in_every_posture(body: Body, posture: Array) -> None:
    matrix = matrix_at(body, posture)
    assert np.array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix)[0] > 0


def test_smallest_eigenvalue_of_the_papers_body() -> None:
    """Its inertias are a hair under m r^2; 0.029 in 5000 postures when first computed."""
    rng = np.random.default_rng(2002)
    postures = rng.uniform(-np.pi, np.pi, (3000, 7))
    smallest = min(np.linalg.eigvalsh(matrix_at(PAPER, p))[0] for p in postures)
    assert 0.028 < smallest < 0.031


@LAW
@given(body_fields(inertia=(0.02, 1.2)), st.floats(-np.pi, np.pi), numbers(140, np.pi))
def test_a_body_is_accepted_exactly_when_its_matrix_is_definite_with_parallel_links(
    fields: dict[str, Any], angle: float, postures: Array
) -> None:
    body = Body.model_construct(**fields)  # as it is, without the checks
    for trunk in (angle, angle + np.pi):
        parallel = np.array([0.0, 0.0, trunk, *4 * [angle]])
        definite = np.linalg.eigvalsh(matrix_at(body, parallel))[0] > 0
        assert definite == accepted(fields)
    if definite:
        for posture in postures.reshape(20, 7):
            assert np.linalg.eigvalsh(matrix_at(body, posture))[0] > 0


def accepted(fields: dict[str, Any]) -> bool:
    try:
        Body(**fields)
    except BodyError as error:
        if "the mass matrix is not positive definite" not in str(error):
            raise
        return False
    return True


@pytest.mark.parametrize(("share", "expected"), [(1.5, True), (1.0, True), (0.9, False)])
def test_inertias_clearly_under_m_r_squared_are_refused(share: float, expected: bool) -> None:
    fields: dict[str, Any] = {
        "trunk_inertia_kgm2": share * PAPER.trunk_inertia_kgm2,
        "thigh_inertia_kgm2": share * 0.57,
        "shank_inertia_kgm2": share * 0.16,
    }
    assert accepted(fields) is expected


@LAW
@given(bodies, states)
def test_kinetic_energy_is_half_the_form_of_the_mass_matrix(body: Body, state: State) -> None:
    rates = state.rates[:7]
    form = rates @ matrix_at(body, state.positions) @ rates / 2
    scale = body.total_mass * np.abs(rates).max() ** 2
    assert kinetic_energy(body, state.motion()) == pytest.approx(form, abs=1e-13 * scale)


@LAW
@given(bodies, numbers(7, np.pi))
def test_gravity_load_is_the_gradient_of_potential_energy(body: Body, posture: Array) -> None:
    gradient = [
        potential_energy(body, motion_of(posture + STEP * 1j * np.eye(7)[i])).imag / STEP
        for i in range(7)
    ]
    load = centrifugal_and_gravity(coefficients(body), motion_of(posture))
    weight = body.total_mass * body.gravity_m_s2
    assert load == pytest.approx(gradient, abs=1e-14 * weight)


@LAW
@given(bodies, states)
def test_centrifugal_terms_keep_the_energy(body: Body, state: State) -> None:
    """q' . centrifugal = q' (dM/dt) q' / 2: what the changing matrix asks for, no more."""
    positions, rates = state.positions[:7], state.rates[:7]
    c = coefficients(body)
    turning = centrifugal_and_gravity(c, motion_of(positions, rates))
    resting = centrifugal_and_gravity(c, motion_of(positions))
    moved = matrix_at(body, positions + 1j * STEP * rates)
    form = rates @ (moved.imag / STEP) @ rates / 2
    scale = body.total_mass * (1 + np.abs(rates).max() ** 3)
    assert rates @ np.subtract(turning, resting) == pytest.approx(form, abs=1e-13 * scale)


@LAW
@given(bodies, states)
def test_left_side_is_matrix_times_acceleration_and_the_rest(body: Body, state: State) -> None:
    motion, c = state.motion(), coefficients(body)
    expected = matrix_at(body, state.positions) @ accelerations(motion)
    expected = expected + centrifugal_and_gravity(c, motion)
    scale = np.abs(expected).max()
    assert inertial_load(c, motion) == pytest.approx(expected, abs=1e-12 * scale)
