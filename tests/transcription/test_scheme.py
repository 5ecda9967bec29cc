"""The Gauss scheme is exact on the polynomials that it should be exact on."""

from __future__ import annotations

from math import factorial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from ergowalk.transcription.scheme import GaussScheme

Array = NDArray[np.float64]

LAW = settings(deadline=None, max_examples=40, derandomize=True, database=None)

COUNTS = [1, 2, 3, 4, 5, 6]

counts = st.sampled_from(COUNTS)
fractions = arrays(np.float64, 5, elements=st.floats(0, 1))


@st.composite
def schemes_with_polynomials(draw: st.DrawFn, more: int = 0) -> tuple[GaussScheme, Polynomial]:
    """A scheme and a polynomial of degree m - 1 + ``more`` * m."""
    m = draw(counts)
    count = m + more * m
    coefficients = draw(arrays(np.float64, count, elements=st.floats(-3, 3)))
    return GaussScheme(m), Polynomial(coefficients)


@LAW
@given(schemes_with_polynomials(more=1))
def test_quadrature_is_exact_to_degree_2m_less_1(pair: tuple[GaussScheme, Polynomial]) -> None:
    scheme, polynomial = pair
    exact = polynomial.integ()(1.0)
    assert scheme.weights @ polynomial(scheme.points) == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize("m", COUNTS)
def test_quadrature_is_not_exact_to_degree_2m(m: int) -> None:
    """No rule with m points is: the square of the node polynomial has a positive integral."""
    scheme = GaussScheme(m)
    square = Polynomial.fromroots(scheme.points) ** 2
    assert scheme.weights @ square(scheme.points) == pytest.approx(0.0, abs=1e-15)
    norm = factorial(m) ** 4 / ((2 * m + 1) * factorial(2 * m) ** 2)  # of Legendre's polynomial
    assert square.integ()(1.0) == pytest.approx(norm, rel=1e-6)


@pytest.mark.parametrize("m", COUNTS)
def test_points_lie_inside_and_weights_share_the_interval(m: int) -> None:
    scheme = GaussScheme(m)
    assert np.all(np.diff(np.concatenate([[0.0], scheme.points, [1.0]])) > 0)
    assert np.all(scheme.weights > 0)
    assert scheme.weights.sum() == pytest.approx(1.0)
    np.testing.assert_allclose(scheme.points + scheme.points[::-1], 1.0)


@LAW
@given(schemes_with_polynomials(), fractions)
def test_curves_through_the_points_are_the_polynomial(
    pair: tuple[GaussScheme, Polynomial], s: Array
) -> None:
    scheme, polynomial = pair
    at_points = polynomial(scheme.points)
    np.testing.assert_allclose(scheme.value(s) @ at_points, polynomial(s), atol=1e-12)


@LAW
@given(schemes_with_polynomials(), fractions)
def test_integrals_are_those_of_the_polynomial(
    pair: tuple[GaussScheme, Polynomial], s: Array
) -> None:
    scheme, polynomial = pair
    at_points = polynomial(scheme.points)
    once, twice = polynomial.integ(), polynomial.integ(2)
    np.testing.assert_allclose(scheme.first_integral(s) @ at_points, once(s), atol=1e-12)
    np.testing.assert_allclose(scheme.second_integral(s) @ at_points, twice(s), atol=1e-12)


@pytest.mark.parametrize("m", COUNTS)
def test_lagrange_polynomials_are_one_at_their_own_point(m: int) -> None:
    scheme = GaussScheme(m)
    np.testing.assert_allclose(scheme.value(scheme.points), np.eye(m), atol=1e-13)


@pytest.mark.parametrize("m", COUNTS)
def test_integrals_to_the_end_are_the_weights(m: int) -> None:
    scheme = GaussScheme(m)
    np.testing.assert_allclose(scheme.first_integral(1.0)[0], scheme.weights, atol=1e-14)
    leverage = scheme.weights * (1 - scheme.points)  # Cauchy's formula of repeated integration
    np.testing.assert_allclose(scheme.second_integral(1.0)[0], leverage, atol=1e-14)


def test_one_instant_or_many_give_one_row_each() -> None:
    scheme = GaussScheme(3)
    for function in (scheme.value, scheme.first_integral, scheme.second_integral):
        assert function(0.25).shape == (1, 3)
        assert function([0.0, 0.25, 1.0]).shape == (3, 3)
        np.testing.assert_array_equal(function([0.0, 0.25])[1], function(0.25)[0])
