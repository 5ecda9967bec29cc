"""Collocation scheme: Gauss points, quadrature weights and exact integrals of polynomials.

Inside an element the acceleration is the polynomial of degree m - 1 through its values at the m
Gauss points; rate and position are its exact integrals. Everything is on the unit interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss
from numpy.polynomial.polynomial import polyfromroots
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class GaussScheme:
    """Collocation at the ``m`` Gauss points of the unit interval."""

    m: int

    @cached_property
    def points(self) -> Array:
        """Gauss points c_1 < ... < c_m in (0, 1)."""
        return (leggauss(self.m)[0] + 1) / 2

    @cached_property
    def weights(self) -> Array:
        """Quadrature weights, exact for polynomials of degree 2 m - 1."""
        return leggauss(self.m)[1] / 2

    def value(self, s: ArrayLike) -> Array:
        """Lagrange polynomials at s: shape (len(s), m)."""
        return self._evaluate(0, s)

    def first_integral(self, s: ArrayLike) -> Array:
        """Integrals of the Lagrange polynomials from 0 to s: shape (len(s), m)."""
        return self._evaluate(1, s)

    def second_integral(self, s: ArrayLike) -> Array:
        """Twice iterated integrals from 0 to s: shape (len(s), m)."""
        return self._evaluate(2, s)

    @cached_property
    def _basis(self) -> list[Polynomial]:
        basis = []
        for j, c in enumerate(self.points):
            others = np.delete(self.points, j)
            # Polynomial.fromroots refuses the empty product that a single point has
            basis.append(Polynomial(polyfromroots(others)) / np.prod(c - others))
        return basis

    @cached_property
    def _integrated(self) -> list[Array]:
        """Coefficients (degree + 1, m) of the basis, of its integrals from 0, and of theirs."""
        once = [b.integ() for b in self._basis]
        orders = (self._basis, once, [b.integ() for b in once])
        return [np.stack([b.coef for b in order], axis=-1) for order in orders]

    def _evaluate(self, integrations: int, s: ArrayLike) -> Array:
        s = np.atleast_1d(np.asarray(s, dtype=float))
        coefficients = self._integrated[integrations]
        powers = np.vander(s, len(coefficients), increasing=True)
        # summed term by term: a matrix product may round one instant unlike many
        found: Array = (powers[:, :, None] * coefficients).sum(axis=1)
        return found
