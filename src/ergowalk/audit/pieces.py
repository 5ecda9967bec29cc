"""A sampled record as smooth pieces: integrals and values between samples.

The record jumps only where an instant stands twice; between such instants every curve is smooth.
Each step between two samples of a piece is read through the polynomial of up to nine samples of
that piece, wherever they lie, so nothing is assumed about spacing or count, and curves that are
polynomials of degree eight or less (four, with the five samples a piece must hold) are exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

WINDOW = 9
BISECTIONS = 40
SAME_INSTANT = 1e-12
"""Samples closer than this share of the stride are one instant."""


@dataclass(frozen=True)
class Pieces:
    """Smooth pieces of a record and, for every step inside them, the samples that describe it.

    Attributes
    ----------
    time : (n,) array
        Instants [s], never decreasing.
    first, last : (p,) arrays
        First and last sample of each piece.
    step : (k,) array
        Left sample of each step inside a piece.
    window : (k, 9) array
        Samples that each step is read through; shorter windows repeat their last sample.
    size : (k,) array
        How many of them count.
    """

    time: Array
    first: Index
    last: Index
    step: Index
    window: Index
    size: Index

    @classmethod
    def of(cls, time: Array) -> Pieces:
        """Split a record at the instants that stand twice."""
        jump = np.flatnonzero(np.diff(time) <= SAME_INSTANT * (time[-1] - time[0]))
        first = np.concatenate([[0], jump + 1])
        last = np.concatenate([jump, [len(time) - 1]])
        count = last - first + 1
        step = np.concatenate([np.arange(a, b) for a, b in zip(first, last, strict=True)])
        piece = np.repeat(np.arange(len(first)), count - 1)
        size = np.minimum(count[piece], WINDOW)
        start = np.clip(step - size // 2 + 1, first[piece], last[piece] - size + 1)
        reach = np.minimum(np.arange(WINDOW), size[:, None] - 1)
        return cls(time, first, last, step, start[:, None] + reach, size)

    @property
    def side(self) -> NDArray[np.int8]:
        """-1 where a sample is a limit from the left, +1 from the right, 0 inside a piece."""
        side = np.zeros(len(self.time), dtype=np.int8)
        side[self.last] = -1
        side[self.first] = 1
        return side

    def increments(self, rate: Array) -> Array:
        """Integral of sampled curves (n, ...) over each step between samples (n - 1, ...).

        Zero across an instant that stands twice.
        """
        result = np.zeros((len(self.time) - 1, *rate.shape[1:]))
        result[self.step] = np.einsum("kw,kw...->k...", self._quadrature, rate[self.window])
        return result

    def cumulative(self, rate: Array) -> Array:
        """Integral of sampled curves (n, ...) from the first sample to each sample (n, ...)."""
        total = np.cumsum(self.increments(rate), axis=0)
        return np.concatenate([np.zeros((1, *rate.shape[1:])), total])

    def absolute_integral(self, curve: Array) -> float:
        """Integral of |curve| over the record, split where the interpolant changes sign."""
        if not np.all(np.isfinite(curve)):
            return float("nan")
        total = float(np.abs(self.increments(curve)).sum())
        crossing = np.flatnonzero(curve[self.step] * curve[self.step + 1] < 0)
        for size in np.unique(self.size[crossing]):
            total += self._lost_to_sign_changes(crossing[self.size[crossing] == size], curve)
        return total

    def squared_slope_integral(self, curve: Array) -> float:
        """Integral of the squared derivative of a curve (n,); jumps between pieces count nothing.

        In every step the polynomial through its window is differentiated; the square of that is
        integrated exactly.
        """
        nodes, weights = legendre.leggauss(WINDOW)
        total = 0.0
        for size in np.unique(self.size):
            steps = np.flatnonzero(self.size == size)
            scaled, centre, half = self._scaled(steps)
            basis = legendre.legvander(scaled[:, :size], size - 1)
            samples = curve[self.window[steps, :size]]
            series = np.linalg.solve(basis, samples[..., None])[..., 0]
            slope = legendre.legder(series.T)
            left, right = self.time[self.step[steps]], self.time[self.step[steps] + 1]
            at = (left + right)[:, None] / 2 + (right - left)[:, None] / 2 * nodes
            inside = (at - centre[:, None]) / half[:, None]
            rate = legendre.legval(inside.T, slope[:, None, :], tensor=False) / half
            total += float(np.sum((right - left) / 2 * (weights @ rate**2)))
        return total

    def values(self, curve: Array, at: Array, side: NDArray[np.int8]) -> Array:
        """Sampled curves (n, ...) at other instants ``at`` (m,) of the record: (m, ...).

        At an instant that stands twice, ``side`` (m,) chooses the limit.
        """
        steps = self._steps_at(at, side)
        weights = self._weights(steps, at)
        return np.asarray(np.einsum("kw,kw...->k...", weights, curve[self.window[steps]]))

    @cached_property
    def _quadrature(self) -> Array:
        """Weights (k, 9) that integrate over each step."""
        return self._weights(np.arange(len(self.step)), None)

    def _steps_at(self, at: Array, side: NDArray[np.int8]) -> Index:
        slack = 1e-9 * (self.time[-1] - self.time[0])
        after = np.searchsorted(self.time[self.first], at + slack, side="right") - 1
        before = np.searchsorted(self.time[self.last], at - slack, side="left")
        inside = np.searchsorted(self.time[self.first], at, side="right") - 1
        piece = np.where(side > 0, after, np.where(side < 0, before, inside))
        piece = np.clip(piece, 0, len(self.first) - 1)
        sample = np.searchsorted(self.time, at, side="right") - 1
        sample = np.clip(sample, self.first[piece], np.maximum(self.last, 1)[piece] - 1)
        return np.clip(np.searchsorted(self.step, sample), 0, len(self.step) - 1)

    def _scaled(self, steps: Index) -> tuple[Array, Array, Array]:
        """Window instants on [-1, 1], with centre [s] and half width [s] of each window."""
        instants = self.time[self.window[steps]]
        centre = (instants[:, -1:] + instants[:, :1]) / 2
        half = (instants[:, -1:] - instants[:, :1]) / 2
        return (instants - centre) / half, centre[:, 0], half[:, 0]

    def _weights(self, steps: Index, at: Array | None) -> Array:
        """Weights of the window samples (k, 9): value at ``at``, or integral over the step."""
        scaled, centre, half = self._scaled(steps)
        sizes = self.size[steps]
        weights = np.zeros((len(steps), WINDOW))
        for size in np.unique(sizes):
            rows = np.flatnonzero(sizes == size)
            basis = legendre.legvander(scaled[rows, :size], size - 1)
            if at is None:
                left = self.step[steps[rows]]
                ends = (self.time[np.stack([left, left + 1])] - centre[rows]) / half[rows]
                low, high = _antiderivatives(ends, size)
                wanted = half[rows, None] * (high - low)
            else:
                wanted = legendre.legvander((at[rows] - centre[rows]) / half[rows], size - 1)
            solved = np.linalg.solve(basis.transpose(0, 2, 1), wanted[..., None])
            weights[rows, :size] = solved[..., 0]
        return weights

    def _lost_to_sign_changes(self, steps: Index, curve: Array) -> float:
        """How much the |integrals| of steps fall short of the integrals of |curve|.

        The curve has opposite signs at the ends of these steps, whose windows have one size; its
        zero is bisected.
        """
        size = self.size[steps[0]]
        scaled, centre, half = self._scaled(steps)
        basis = legendre.legvander(scaled[:, :size], size - 1)
        series = np.linalg.solve(basis, curve[self.window[steps, :size], None])[..., 0].T
        low, high = ((self.time[self.step[steps] + end] - centre) / half for end in (0, 1))
        falling = curve[self.step[steps]] > 0
        a, b = low, high
        for _ in range(BISECTIONS):
            middle = (a + b) / 2
            before = (legendre.legval(middle, series, tensor=False) > 0) == falling
            a, b = np.where(before, middle, a), np.where(before, b, middle)
        integral = legendre.legint(series)
        at_low, at_zero, at_high = (
            half * legendre.legval(end, integral, tensor=False) for end in (low, (a + b) / 2, high)
        )
        parts = np.abs(at_zero - at_low) + np.abs(at_high - at_zero)
        return float(np.sum(parts - np.abs(at_high - at_low)))


def _antiderivatives(at: Array, size: int) -> Array:
    """Antiderivatives of the Legendre polynomials of degree 0 ... size - 1: (..., size)."""
    values = legendre.legvander(at, size)
    degree = np.arange(1, size)
    rest = (values[..., 2:] - values[..., : size - 1]) / (2 * degree + 1)
    return np.concatenate([values[..., 1:2], rest], axis=-1)
