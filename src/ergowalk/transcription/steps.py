"""The two steps of a stride whose legs may differ, seen from the half in which one leg leads."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ergowalk.problem import GaitProblem
from ergowalk.transcription.phases import Unknown

STEP_1 = "step_1"
"""Length [m] of the step with which leg 1 lands; an unknown of the whole stride."""


@dataclass(frozen=True)
class Steps:
    """The steps around half a stride.

    ``behind`` [m] from the print of the trailing foot to that of the leading one, ``ahead`` [m]
    from there to where the trailing leg lands, ``other`` [s] how long the other half lasts. Numbers
    or symbols.
    """

    behind: Any
    ahead: Any
    other: Any

    @classmethod
    def equal(cls, problem: GaitProblem) -> Steps:
        """Of legs that mirror each other."""
        length = problem.step_length_m
        return cls(length, length, problem.stride_time_s / 2)


@dataclass(frozen=True)
class UnequalSteps:
    """Steps that are unknown: half ``half`` (0: leg 1 leads) of a stride of ``length`` [m].

    ``step_1`` bounds the length of step 1 [m], ``duration`` how long the half lasts [s];
    ``other_end`` is the boundary instant at which the other half ends, on its own clock.
    """

    half: int
    length: float
    step_1: tuple[float, float]
    duration: tuple[float, float]
    other_end: str

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """What is unknown of the whole stride."""
        return (Unknown(STEP_1, *self.step_1),)

    @property
    def seen(self) -> tuple[Unknown, ...]:
        """What the phases see of it, the duration of the other half too."""
        return (*self.unknowns, Unknown(self.other_end))

    def given(self, values: Mapping[str, Any]) -> Steps:
        """The steps from values of what is seen; at a boundary no duration is needed."""
        first = values[STEP_1]
        steps = (first, self.length - first)
        behind, ahead = steps if self.half == 0 else steps[::-1]
        return Steps(behind, ahead, values.get(self.other_end))
