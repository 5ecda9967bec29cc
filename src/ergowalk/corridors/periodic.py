"""Smooth periodic curves through tabulated points, and corridors around them.

A table gives mean and standard deviation at equal steps of the stride. Its first and last row
(0 % and 100 %, the same instant of a periodic gait) differ slightly in measured data: their
average is used for both. Through the remaining points goes the trigonometric polynomial of the
lowest degree, so every other row is reproduced exactly, and first and second derivatives are
exact too. Tables finer than 2 % are fitted by least squares with 25 harmonics.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

MAX_HARMONICS = 25


@dataclass(frozen=True)
class PeriodicCurve:
    """Trigonometric polynomial of the stride fraction s, period 1.

    ``cosine[k]`` and ``sine[k]`` multiply cos(2 pi k s) and sin(2 pi k s).
    """

    cosine: tuple[float, ...]
    sine: tuple[float, ...]

    @classmethod
    def through(cls, samples: ArrayLike) -> PeriodicCurve:
        """Curve through equally spaced samples of one period, both ends given.

        Parameters
        ----------
        samples : (n + 1,) array
            Values at s = 0, 1/n, ..., 1; the first and the last are averaged.
        """
        values = np.asarray(samples, dtype=float)
        n = len(values) - 1
        ring = np.concatenate([[(values[0] + values[-1]) / 2], values[1:-1]])
        spectrum = np.fft.rfft(ring) / n
        degree = min(n // 2, MAX_HARMONICS)
        cosine, sine = 2 * spectrum.real[: degree + 1], -2 * spectrum.imag[: degree + 1]
        cosine[0] /= 2
        sine[0] = 0.0
        if 2 * degree == n:  # the highest harmonic of an even ring is its own alias
            cosine[-1] /= 2
            sine[-1] = 0.0
        return cls(tuple(cosine.tolist()), tuple(sine.tolist()))

    def __call__(self, s: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """Value, or ``derivative``-th derivative with respect to s, at stride fractions s.

        Returns an array shaped like ``s``.
        """
        s = np.asarray(s, dtype=float)
        k = np.arange(len(self.cosine))
        phase = 2 * np.pi * k * s[..., None]
        turn = derivative * np.pi / 2  # each derivative advances the phase by a right angle
        scale = (2 * np.pi * k) ** derivative
        even = np.cos(phase + turn) @ (scale * np.array(self.cosine))
        odd = np.sin(phase + turn) @ (scale * np.array(self.sine))
        return np.asarray(even + odd, dtype=float)

    def combined(self, other: PeriodicCurve, factor: float) -> PeriodicCurve:
        """self + factor * other."""
        return PeriodicCurve(
            tuple(a + factor * b for a, b in zip(self.cosine, other.cosine, strict=True)),
            tuple(a + factor * b for a, b in zip(self.sine, other.sine, strict=True)),
        )

    def coefficients(self, shift: float = 0.0, degree: int = MAX_HARMONICS) -> NDArray[np.float64]:
        """Cosine, then sine coefficients of the curve s -> self(s + shift), padded with zeros.

        Returns an array (2 degree + 2,); ValueError if the curve has higher harmonics.
        """
        if degree < self.degree:
            raise ValueError(
                f"degree = {degree}: the curve has {self.degree} harmonics; ask for no fewer"
            )
        turn = 2 * np.pi * shift * np.arange(self.degree + 1)
        a, b = np.array(self.cosine), np.array(self.sine)
        shifted = (a * np.cos(turn) + b * np.sin(turn), b * np.cos(turn) - a * np.sin(turn))
        padding = np.zeros(degree - self.degree)
        return np.concatenate([shifted[0], padding, shifted[1], padding])

    @property
    def degree(self) -> int:
        """Highest harmonic."""
        return len(self.cosine) - 1


@dataclass(frozen=True)
class Corridor:
    """Band mean - width * sd ... mean + width * sd around a human curve (6)."""

    mean: PeriodicCurve
    sd: PeriodicCurve
    width: float = 1.0

    @cached_property
    def lower(self) -> PeriodicCurve:
        """Lower bound theta(t) of (6)."""
        return self.mean.combined(self.sd, -self.width)

    @cached_property
    def upper(self) -> PeriodicCurve:
        """Upper bound Theta(t) of (6)."""
        return self.mean.combined(self.sd, self.width)
