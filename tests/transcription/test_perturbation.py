"""Disturbed starts: as large as asked, smooth, symmetric, and the same for the same seed."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.gait.rhythm import PhaseOrder, boundary_fractions, half_stride_phases
from ergowalk.problem import preset
from ergowalk.transcription.curves import Samples, Trajectory
from ergowalk.transcription.guess import starting_rhythm, starting_times
from ergowalk.transcription.perturbation import Perturbation

LAW = settings(deadline=None, max_examples=30, derandomize=True, database=None)
PROBLEM = preset("berbyuk2002")
STRIDE = PROBLEM.stride_time_s
ORDER = PhaseOrder.FLAT_FIRST
NAMES = ("trunk", "thigh_1", "shank_1", "thigh_2", "shank_2", "foot_1", "foot_2")


def nothing(i: int, fractions: np.ndarray) -> Samples:
    zero = np.zeros_like(fractions)
    flat = dict.fromkeys(NAMES, zero)
    return Samples(flat, flat, flat, {"hip_1": zero}, {"reaction_x_1": zero})


def disturbance(perturbation: Perturbation, count: int = 4001) -> Samples:
    """What is added, over the first half of the stride."""
    times = starting_times(PROBLEM, starting_rhythm(PROBLEM, ORDER))
    guess = perturbation.curves(Trajectory(times, ()), nothing, ORDER, STRIDE)
    parts = []
    for i, _ in enumerate(half_stride_phases(ORDER)):
        parts.append(guess(i, np.linspace(0, 1, count)))
    return parts


@LAW
@given(st.integers(0, 2**31), st.integers(0, 1000), st.floats(0.5, 20))
def test_segment_angles_move_by_what_was_asked_over_the_stride(
    seed: int, index: int, rms: float
) -> None:
    times = starting_times(PROBLEM, starting_rhythm(PROBLEM, ORDER))
    whole = dict.fromkeys(times, 0.0) | {"half_stride": STRIDE}
    last = half_stride_phases(ORDER)[-1]
    whole[last.start] = 0.0  # the last phase made to last all the stride
    guess = Perturbation(seed, index, rms).curves(Trajectory(whole, ()), nothing, ORDER, STRIDE)
    s = np.arange(400) / 400
    samples = guess(3, s)
    for name in NAMES:
        assert np.degrees(np.sqrt(np.mean(samples.value[name] ** 2))) == pytest.approx(rms)
    for segment in ("thigh", "shank", "foot"):
        one, two = samples.value[f"{segment}_1"], samples.value[f"{segment}_2"]
        np.testing.assert_allclose(np.roll(one, 200), two, atol=1e-12)


def test_rates_and_accelerations_are_those_of_the_angles() -> None:
    times = starting_times(PROBLEM, starting_rhythm(PROBLEM, ORDER))
    guess = Perturbation(3, 4).curves(Trajectory(times, ()), nothing, ORDER, STRIDE)
    s = np.linspace(0, 1, 2001)
    phase = half_stride_phases(ORDER)[2]
    seconds = s * (times[phase.end] - times[phase.start])
    samples = guess(2, s)
    for name in NAMES:
        slope = np.gradient(samples.value[name], seconds, edge_order=2)
        np.testing.assert_allclose(samples.rate[name], slope, atol=1e-4)
        slope = np.gradient(samples.rate[name], seconds, edge_order=2)
        np.testing.assert_allclose(samples.acceleration[name], slope, atol=1e-2)


def test_curves_join_from_phase_to_phase() -> None:
    parts = disturbance(Perturbation(1, 2), 5)
    for before, after in itertools.pairwise(parts):
        for name in NAMES:
            assert before.value[name][-1] == pytest.approx(after.value[name][0], abs=1e-12)


def test_loads_stay_as_they_are() -> None:
    for part in disturbance(Perturbation(1, 2), 5):
        assert not np.any(part.control["hip_1"])
        assert not np.any(part.algebraic["reaction_x_1"])


def test_the_same_start_is_the_same_and_another_is_another() -> None:
    one, same, other, seed = (
        disturbance(Perturbation(*key), 5)[0].value["trunk"]
        for key in ((1, 2), (1, 2), (1, 3), (2, 2))
    )
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 1e-3
    assert np.abs(one - seed).max() > 1e-3


@LAW
@given(st.integers(0, 1000), st.floats(0.0, 0.2), st.sampled_from(PhaseOrder))
def test_a_moved_rhythm_is_inside_the_bounds_and_in_order(
    index: int, sd: float, order: PhaseOrder
) -> None:
    base = starting_rhythm(PROBLEM, order)
    rhythm = Perturbation(0, index, rhythm_sd=sd).rhythm(PROBLEM, order, base)
    fractions = boundary_fractions(rhythm)
    for phase in half_stride_phases(order):
        assert fractions[phase.end] - fractions[phase.start] > 0.01
    for name in ("heel_end", "heel_off", "toe_off"):
        low, high = PROBLEM.rhythm.bounds(name)
        assert low <= getattr(rhythm, name) <= high


def test_no_deviation_moves_no_instant() -> None:
    base = starting_rhythm(PROBLEM, ORDER)
    assert Perturbation(0, 1, rhythm_sd=0.0).rhythm(PROBLEM, ORDER, base) == base
