"""The content of a gait file in plain arrays, as the lines of the audit read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.audit.balance import Loads
from ergowalk.audit.pieces import Pieces
from ergowalk.audit.walker import Array, Body, Moving, Turning, Walker, body_points

JOINTS = ("hip", "knee", "ankle", "metatarsal")
SEGMENTS = ("thigh", "shank", "foot", "toes")
PHASES = ("swing", "heel", "flat", "forefoot", "toe")
SWING, HEEL, FLAT, FOREFOOT, TOE = range(5)
UNKNOWN_PHASE = -1
RHYTHM = ("heel_end", "heel_off", "toe_tip_start", "toe_off")


@dataclass(frozen=True)
class Record:
    """The content of a gait file in plain arrays, SI units, legs in order.

    Motion: ``hip`` (n,), ``trunk`` (n,), ``segments``: four of (n, 2). ``raw`` holds every
    variable as stored; ``phase`` (n, 2) indexes :data:`PHASES`; ``stated`` names the
    attributes that are there.
    """

    time: Array
    raw: Mapping[str, Array]
    phase: NDArray[np.int64]
    walker: Walker
    step_length: float
    stride_time: float
    energy_per_metre: float
    objective_per_metre: float
    stated: frozenset[str]
    rhythm: Mapping[str, float]
    problem: Mapping[str, Any]
    mesh_history: tuple[Mapping[str, Any], ...]

    def table(self, name: str) -> Mapping[str, Any]:
        """A table of the stored problem; empty where there is none."""
        stored = self.problem.get(name)
        return stored if isinstance(stored, dict) else {}

    @cached_property
    def pieces(self) -> Pieces:
        """The record split where an instant stands twice."""
        return Pieces.of(self.time)

    @cached_property
    def hip(self) -> Moving:
        """The hip, complex."""
        return Moving(*(_complex(self.raw[f"hip_{k}"]) for k in _ORDERS))

    @cached_property
    def trunk(self) -> Turning:
        """The trunk angle psi."""
        return Turning(*(self.raw[f"trunk_{k}"] for k in _ANGULAR))

    @cached_property
    def segments(self) -> tuple[Turning, ...]:
        """Angles alpha, beta, gamma, epsilon, each (n, 2)."""
        stored = [self.raw[f"segment_{k}"] for k in _ANGULAR]
        return tuple(Turning(*(values[..., s] for values in stored)) for s in range(4))

    @cached_property
    def body(self) -> Body:
        """Points of the walker that follow from hip and angles."""
        return body_points(self.walker, self.hip, self.trunk, self.segments)

    @cached_property
    def loads(self) -> Loads:
        """Moments and reactions; where nothing presses, the pressure acts on the metatarsal.

        A centre of pressure that is missing under load stays NaN, and what needs it fails.
        """
        reaction = _complex(self.raw["ground_reaction_force"])
        pressure = self.raw["center_of_pressure"]
        free = (self.phase == SWING) | (np.abs(reaction.imag) <= 1e-9 * self.walker.weight)
        at = self.body.metatarsal.position.real
        pressure = np.where(free & ~np.isfinite(pressure), at, pressure)
        return Loads(self.raw["joint_moment"], reaction, pressure)

    @cached_property
    def heel_print(self) -> Array:
        """Where the heel of the current or last footprint stands (n, 2) [m]."""
        delay = np.array([0.0, self.stride_time / 2])
        stride = np.floor((self.time[:, None] - delay) / self.stride_time + 1e-9)
        return np.asarray(2 * self.step_length * stride + [0.0, self.step_length])


_ORDERS = ("position", "velocity", "acceleration")
_ANGULAR = ("angle", "angular_velocity", "angular_acceleration")


def as_number(stated: object) -> float:
    """What a stored problem states, as a number; NaN where it is none."""
    if isinstance(stated, bool) or not isinstance(stated, int | float):
        return float("nan")
    return float(stated)


def _complex(pairs: Array) -> NDArray[np.complex128]:
    return np.asarray(pairs[..., 0] + 1j * pairs[..., 1])
