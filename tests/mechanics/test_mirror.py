"""Mirror symmetry: exchanging the legs, and looking from the other side, change no law."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from ergowalk.body import Body
from ergowalk.mechanics.dynamics import (
    applied_load,
    centrifugal_and_gravity,
    coefficients,
    inertial_load,
    mass_matrix,
)
from ergowalk.mechanics.energy import kinetic_energy, potential_energy

from .spaces import (
    LAW,
    Array,
    Load,
    State,
    bodies,
    carried,
    loads,
    numbers,
    states,
    with_legs_swapped,
)

SWAP = [0, 1, 2, 5, 6, 3, 4]
"""The coordinates of (1) with leg 1 and leg 2 exchanged."""


@LAW
@given(bodies, states, loads())
def test_swapping_the_legs_swaps_the_equations(body: Body, state: State, load: Load) -> None:
    c, d = coefficients(body), coefficients(with_legs_swapped(body))
    ours, theirs = state.motion(), state.swapped().motion()
    swapped = load.swapped()
    matrix = np.array(mass_matrix(c, ours))
    assert np.array(mass_matrix(d, theirs)) == pytest.approx(matrix[np.ix_(SWAP, SWAP)], rel=1e-13)
    for mine, other in (
        (centrifugal_and_gravity(c, ours), centrifugal_and_gravity(d, theirs)),
        (inertial_load(c, ours), inertial_load(d, theirs)),
        (
            applied_load(c, ours, load.moments, load.reactions),
            applied_load(d, theirs, swapped.moments, swapped.reactions),
        ),
    ):
        scale = np.abs(mine).max()
        assert np.array(other) == pytest.approx(np.array(mine)[SWAP], abs=1e-13 * scale)


@LAW
@given(bodies, states, numbers(2, 500.0), numbers(1, 100.0))
def test_swapping_the_legs_swaps_moments_and_leaves_the_energy(
    body: Body, state: State, trailing: Array, ankle: Array
) -> None:
    other = with_legs_swapped(body)
    motion, mirror = state.motion(), state.swapped().motion()
    load = carried(body, motion, trailing, ankle[0])
    given_now = np.array(load.reactions[0])
    swapped = carried(other, mirror, given_now, load.moments[0].ankle)
    scale = np.abs(load.reactions).max() + max(abs(m.hip) for m in load.moments)
    for mine, theirs in zip(load.moments, swapped.moments[::-1], strict=True):
        for joint in ("hip", "knee", "ankle"):
            expected = getattr(mine, joint)
            assert getattr(theirs, joint) == pytest.approx(expected, abs=1e-11 * scale)
    assert kinetic_energy(other, mirror) == pytest.approx(kinetic_energy(body, motion), rel=1e-12)
    height = potential_energy(body, motion)
    assert potential_energy(other, mirror) == pytest.approx(height, abs=1e-10)


@LAW
@given(bodies, states, numbers(2, 500.0), numbers(1, 100.0))
def test_walking_backwards_mirrors_forces_and_moments(
    body: Body, state: State, trailing: Array, ankle: Array
) -> None:
    mirror = state.reflected().motion()
    ours = carried(body, state.motion(), trailing, ankle[0])
    theirs = carried(body, mirror, trailing * [-1.0, 1.0], -ankle[0])
    scale = np.abs(ours.reactions).max() + max(abs(m.hip) for m in ours.moments)
    for mine, other in zip(ours.reactions, theirs.reactions, strict=True):
        assert (-other[0], other[1]) == pytest.approx(mine, abs=1e-12 * scale)
    for left, right in zip(ours.moments, theirs.moments, strict=True):
        for joint in ("hip", "knee", "ankle"):
            expected = -getattr(left, joint)
            assert getattr(right, joint) == pytest.approx(expected, abs=1e-12 * scale)
    assert kinetic_energy(body, mirror) == pytest.approx(
        kinetic_energy(body, state.motion()), rel=1e-12
    )
