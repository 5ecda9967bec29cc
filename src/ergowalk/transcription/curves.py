"""Curves of a phased problem: piecewise polynomials, element by element."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ergowalk.transcription.phases import PhaseModel
from ergowalk.transcription.scheme import GaussScheme

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Samples:
    """Curves of one phase at given instants: dictionaries of arrays by name."""

    value: Mapping[str, Array]
    rate: Mapping[str, Array]
    acceleration: Mapping[str, Array]
    control: Mapping[str, Array]
    algebraic: Mapping[str, Array]


Guess = Callable[[int, Array], Samples]
"""(phase number, fractions of the phase) -> curves."""


@dataclass(frozen=True)
class PhaseCurves:
    """Curves of one phase, element by element; arrays as in :class:`PhaseIndices`."""

    phase: PhaseModel
    scheme: GaussScheme
    fractions: Array
    start: float
    duration: float
    values: Array
    rates: Array
    controls: Array
    bulges: Array
    accelerations: Array
    algebraics: Array

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.fractions) - 1

    def in_element(self, k: int, s: Array) -> Samples:
        """Curves inside element ``k`` at local fractions ``s`` of the element (both ends count)."""
        h = self.duration * (self.fractions[k + 1] - self.fractions[k])
        a = self.accelerations[k]
        acceleration = self.scheme.value(s) @ a
        rate = self.rates[k] + h * self.scheme.first_integral(s) @ a
        value = self.values[k] + h * s[:, None] * self.rates[k]
        value = value + h**2 * self.scheme.second_integral(s) @ a
        control = self.controls[k] + s[:, None] * (self.controls[k + 1] - self.controls[k])
        control = control + (4 * s * (1 - s))[:, None] * self.bulges[k]
        algebraic = self.scheme.value(s) @ self.algebraics[k]
        names = [c.name for c in self.phase.coordinates]
        return Samples(
            _columns(names, value),
            _columns(names, rate),
            _columns(names, acceleration),
            _columns([u.name for u in self.phase.controls], control),
            _columns([z.name for z in self.phase.algebraics], algebraic),
        )

    def at(self, fraction: Array) -> Samples:
        """Curves at fractions of the phase, in ascending order."""
        k = np.clip(np.searchsorted(self.fractions, fraction, "right") - 1, 0, self.elements - 1)
        s = (fraction - self.fractions[k]) / np.diff(self.fractions)[k]
        return joined([self.in_element(int(e), s[k == e]) for e in np.unique(k)])


@dataclass(frozen=True)
class Trajectory:
    """All phases of a solved (or guessed) problem, the boundary instants [s], what is shared."""

    times: Mapping[str, float]
    phases: tuple[PhaseCurves, ...]
    shared: Mapping[str, float] = field(default_factory=dict)

    def as_guess(self) -> Guess:
        """These curves as a guess on another mesh of the same phases."""
        return lambda i, fractions: self.phases[i].at(fractions)


def joined(parts: Sequence[Samples]) -> Samples:
    """Curves of several stretches one after the other."""

    def join(kind: str) -> dict[str, Array]:
        names = getattr(parts[0], kind)
        return {n: np.concatenate([getattr(p, kind)[n] for p in parts]) for n in names}

    return Samples(*(join(k) for k in ("value", "rate", "acceleration", "control", "algebraic")))


def _columns(names: list[str], values: Array) -> dict[str, Array]:
    return {name: values[:, i] for i, name in enumerate(names)}
