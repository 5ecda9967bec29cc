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
LEG_TABLES = ("leg_1", "leg_2")
RHYTHM = ("heel_end", "heel_off", "toe_tip_start", "toe_off")


@dataclass(frozen=True)
class Record:
    """The content of a gait file in plain arrays, SI units, legs in order.

    Motion: ``hip`` (n,), ``trunk`` (n,), ``segments``: four of (n, 2). ``raw`` holds every
    variable as stored; ``phase`` (n, 2) indexes :data:`PHASES`; ``stated`` names the
    attributes that are there. ``step_lengths`` are those with which leg 1 and leg 2 land;
    ``rhythm_leg_2`` is None where that of leg 1 is that of both.
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
    rhythm_leg_2: Mapping[str, float] | None
    step_lengths: tuple[float, float]
    problem: Mapping[str, Any]
    mesh_history: tuple[Mapping[str, Any], ...]

    def table(self, name: str) -> Mapping[str, Any]:
        """A table of the stored problem; empty where there is none."""
        stored = self.problem.get(name)
        return stored if isinstance(stored, dict) else {}

    def leg_table(self, name: str, leg: int) -> Mapping[str, Any]:
        """What a table of the stored problem says of one leg (0, 1)."""
        common = {k: v for k, v in self.table(name).items() if k not in LEG_TABLES}
        own = self.table(name).get(LEG_TABLES[leg])
        return _laid_over(common, own) if isinstance(own, dict) else common

    @property
    def each_leg(self) -> bool:
        """Whether each leg has its own curves, so that none is told by the other's."""
        return self.rhythm_leg_2 is not None

    @property
    def rhythms(self) -> tuple[Mapping[str, float], Mapping[str, float]]:
        """The rhythm of each leg, as fractions of T after its own heel contact."""
        return self.rhythm, self.rhythm if self.rhythm_leg_2 is None else self.rhythm_leg_2

    @property
    def contacts(self) -> Array:
        """Heel contact of leg 1 and of leg 2 in the stride (2,) [s]."""
        second = self.rhythm["toe_tip_start"] if self.each_leg else 0.5
        return np.array([0.0, second * self.stride_time])

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
        stride = np.floor((self.time[:, None] - self.contacts) / self.stride_time + 1e-9)
        return np.asarray(2 * self.step_length * stride + [0.0, self.step_lengths[1]])


_ORDERS = ("position", "velocity", "acceleration")
_ANGULAR = ("angle", "angular_velocity", "angular_acceleration")


def as_number(stated: object) -> float:
    """What a stored problem states, as a number; NaN where it is none."""
    if isinstance(stated, bool) or not isinstance(stated, int | float):
        return float("nan")
    return float(stated)


def _laid_over(common: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """A table with what another says instead; "same" says nothing."""
    found = dict(common)
    for key, value in own.items():
        under = found.get(key)
        if isinstance(value, dict) and isinstance(under, dict):
            found[key] = _laid_over(under, value)
        elif value != "same" or key not in found:
            found[key] = value
    return found


def _complex(pairs: Array) -> NDArray[np.complex128]:
    return np.asarray(pairs[..., 0] + 1j * pairs[..., 1])
