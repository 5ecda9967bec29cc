"""Quadrature and interpolation of a record that jumps where an instant stands twice."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ergowalk.audit.pieces import Pieces


def record_of(pieces: int, samples: int, seed: int | None = None) -> np.ndarray:
    """Time on [0, 1] in equal pieces that share their ends; irregular inside with a seed."""
    rng = np.random.default_rng(seed)
    edges = np.linspace(0.0, 1.0, pieces + 1)
    parts = []
    for a, b in itertools.pairwise(edges):
        inside = np.linspace(0.0, 1.0, samples)
        if seed is not None:
            inside[1:-1] += rng.uniform(-0.3, 0.3, samples - 2) / samples
        parts.append(a + (b - a) * inside)
    return np.concatenate(parts)


def test_pieces_end_where_an_instant_stands_twice() -> None:
    pieces = Pieces.of(record_of(4, 9))
    assert pieces.first.tolist() == [0, 9, 18, 27]
    assert pieces.last.tolist() == [8, 17, 26, 35]
    assert pieces.side[[0, 8, 9, 4]].tolist() == [1, -1, 1, 0]


@pytest.mark.parametrize("samples", [5, 6, 9, 13, 60])
def test_quartics_are_integrated_exactly_whatever_the_spacing(samples: int) -> None:
    time = record_of(3, samples, seed=samples)
    integral = Pieces.of(time).cumulative(5 * time**4 - 3 * time**2 + 1)
    assert integral == pytest.approx(time**5 - time**3 + time, abs=1e-13)


def test_nine_samples_integrate_polynomials_of_degree_eight_exactly() -> None:
    time = record_of(1, 9, seed=1)
    assert Pieces.of(time).cumulative(9 * time**8)[-1] == pytest.approx(1.0, abs=1e-13)


def test_degree_nine_is_beyond_nine_samples() -> None:
    time = record_of(1, 9)
    error = Pieces.of(time).cumulative(10 * time**9) - time**10
    assert np.max(np.abs(error)) > 1e-6


def test_error_falls_with_the_ninth_power_of_the_piece() -> None:
    def error(pieces: int) -> float:
        time = record_of(pieces, 9)
        exact = np.sin(12 * time) / 12
        return float(np.max(np.abs(Pieces.of(time).cumulative(np.cos(12 * time)) - exact)))

    assert np.log2(error(1) / error(2)) > 8.5


def test_a_jump_between_pieces_costs_nothing() -> None:
    time = record_of(2, 7)
    step = np.repeat([1.0, -2.0], 7)
    assert Pieces.of(time).cumulative(step)[-1] == pytest.approx(-0.5, abs=1e-14)


@pytest.mark.parametrize(("samples", "seed"), [(9, None), (9, 4), (33, 7)])
def test_absolute_values_are_split_at_their_zero_crossings(samples: int, seed: int | None) -> None:
    time = record_of(16, samples, seed)
    area = Pieces.of(time).absolute_integral(np.sin(6 * np.pi * time))
    assert area == pytest.approx(2 / np.pi, rel=1e-9)


def test_absolute_integral_of_a_linear_crossing_is_exact() -> None:
    time = record_of(1, 5)
    assert Pieces.of(time).absolute_integral(time - 0.3) == pytest.approx(0.29, abs=1e-14)


def test_absolute_integral_of_nothing_is_zero_and_of_nan_is_nan() -> None:
    time = record_of(2, 5)
    assert Pieces.of(time).absolute_integral(0 * time) == 0.0
    curve = np.where(time > 0.9, np.nan, time)
    assert np.isnan(Pieces.of(time).absolute_integral(curve))


def test_values_between_samples_follow_the_curve() -> None:
    time = record_of(5, 9, seed=3)
    at = np.linspace(0.01, 0.99, 37)
    values = Pieces.of(time).values(np.cos(5 * time), at, np.zeros(37, dtype=np.int8))
    assert values == pytest.approx(np.cos(5 * at), abs=1e-8)


def test_at_a_jump_the_side_chooses_the_limit() -> None:
    time = record_of(2, 5)
    step = np.repeat([1.0, -2.0], 5)
    at, side = np.array([0.5, 0.5, 0.0, 1.0]), np.array([-1, 1, 1, -1], dtype=np.int8)
    assert Pieces.of(time).values(step, at, side) == pytest.approx([1, -2, 1, -2], abs=1e-14)
