"""Seeded disturbances of a start, to see which other optima a search can end in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.rhythm import PhaseOrder, Rhythm, half_stride_phases
from ergowalk.problem import GaitProblem
from ergowalk.transcription.curves import Guess, Samples, Trajectory
from ergowalk.transcription.guess import rhythm_with_room
from ergowalk.transcription.walker import SHARING

Array = NDArray[np.float64]

HARMONICS = 4
"""Waves of a disturbance over the stride."""

SEGMENTS = ("thigh", "shank", "foot")


@dataclass(frozen=True)
class Perturbation:
    """Start number ``index`` of the family ``seed``.

    Smooth periodic curves of ``angle_rms_deg`` degrees r.m.s. are added to every segment angle,
    the same for both legs half a stride apart; every free instant of the rhythm is moved by a
    normal deviate of ``rhythm_sd`` strides, then back into its bounds and order.
    """

    seed: int
    index: int
    angle_rms_deg: float = 5.0
    rhythm_sd: float = 0.03

    def curves(self, start: Trajectory, guess: Guess, order: PhaseOrder, stride: float) -> Guess:
        """The guess with the disturbed angles; loads stay as they are.

        ``start`` tells when the phases of the guess begin and end, ``stride`` is T [s].
        """
        phases, waves = half_stride_phases(order), self._waves()

        def disturbed(i: int, fractions: Array) -> Samples:
            begin, end = (start.times[name] for name in (phases[i].start, phases[i].end))
            s = (begin + (end - begin) * fractions) / stride
            samples = guess(i, fractions)

            def kind(curves: Mapping[str, Array], derivative: int) -> dict[str, Array]:
                scale = stride**-derivative
                return {
                    name: curve
                    if name in SHARING
                    else curve + scale * _wave(waves, name, s, derivative)
                    for name, curve in curves.items()
                }

            return Samples(
                kind(samples.value, 0),
                kind(samples.rate, 1),
                kind(samples.acceleration, 2),
                samples.control,
                samples.algebraic,
            )

        return disturbed

    def rhythm(self, problem: GaitProblem, order: PhaseOrder, rhythm: Rhythm) -> Rhythm:
        """The rhythm with its free instants moved."""
        moves = self._generator(1).normal(0.0, self.rhythm_sd, 3)
        moved = Rhythm(
            heel_end=rhythm.heel_end + float(moves[0]),
            heel_off=rhythm.heel_off + float(moves[1]),
            toe_off=rhythm.toe_off + float(moves[2]),
        )
        return rhythm_with_room(problem, order, moved)

    def _generator(self, part: int) -> np.random.Generator:
        return np.random.default_rng([self.seed, self.index, part])

    def _waves(self) -> dict[str, NDArray[np.complex128]]:
        """Complex amplitudes of the harmonics 1 ... by segment [rad]."""
        generator, waves = self._generator(0), {}
        for name in ("trunk", *SEGMENTS):
            amplitudes = generator.normal(size=(HARMONICS, 2)) @ np.array([1.0, 1.0j])
            power = np.sqrt(np.sum(np.abs(amplitudes) ** 2) / 2)
            waves[name] = amplitudes * np.radians(self.angle_rms_deg) / power
        return waves


def _wave(waves: dict[str, NDArray[np.complex128]], name: str, s: Array, derivative: int) -> Array:
    """Disturbance of a coordinate, or its derivative with respect to s, at stride fractions s."""
    segment, _, leg = name.partition("_")
    turns = 2j * np.pi * np.arange(1, HARMONICS + 1)
    place = s + (0.5 if leg == "2" else 0.0)
    powers = np.exp(turns * place[:, None]) * turns**derivative
    value: Array = (powers @ waves[segment]).real
    return value
