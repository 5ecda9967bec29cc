"""The walker as the audit sees it: points of the body in the complex plane.

A point x + iy; a rod hanging at angle theta points along -i exp(i theta). Velocities and
accelerations follow by differentiating exp(i theta). Nothing here is shared with the mechanics
that produced the gait.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import GaitFileError

Array = NDArray[np.float64]
Plane = NDArray[np.complex128]

THIGH, SHANK, FOOT, TOES = range(4)

_ONE_VALUE = ("m", "r", "J", "g")


@dataclass(frozen=True)
class Walker:
    """Body parameters under the paper's symbols, in SI units; arrays hold leg 1 and leg 2.

    Inertias are about the proximal joint; the foot mass m_f sits at the ankle.
    """

    m: float
    r: float
    J: float
    g: float
    m_a: Array
    a: Array
    r_a: Array
    J_a: Array
    m_b: Array
    b: Array
    r_b: Array
    J_b: Array
    m_f: Array
    HA: Array
    AM: Array
    l_m: Array
    l_h: Array

    @classmethod
    def from_json(cls, text: str) -> Walker:
        """Read the attribute ``body_parameters``.

        Raises
        ------
        GaitFileError
            If it is not a JSON object of positive numbers (or pairs) under every symbol, or if
            the foot triangle cannot close.
        """
        try:
            values = json.loads(text)
        except (TypeError, ValueError):
            values = None
        if not isinstance(values, dict):
            raise GaitFileError(
                "must be a JSON object", "store the parameters by symbol", field="body_parameters"
            )
        walker = cls(**{f.name: _parameter(values, f.name) for f in fields(cls)})
        sides = np.stack([walker.HA, walker.AM, walker.l_h])
        if np.any(2 * sides.max(axis=0) >= sides.sum(axis=0)):
            raise GaitFileError(
                "each of HA, AM, l_h must be shorter than the other two together",
                "store the foot triangle that was solved",
                field="body_parameters.l_h",
                value=values["l_h"],
            )
        return walker

    @property
    def mass(self) -> float:
        """Total mass M [kg]."""
        return float(self.m + np.sum(self.m_a + self.m_b + self.m_f))

    @property
    def weight(self) -> float:
        """Body weight M g [N]."""
        return self.mass * self.g

    @property
    def flat_ankle(self) -> Plane:
        """Ankle over the heel of a flat foot (2,): the triangle laid out on the ground [m]."""
        x = (self.HA**2 - self.AM**2 + self.l_h**2) / (2 * self.l_h)
        return np.asarray(x + 1j * np.sqrt(self.HA**2 - x**2))

    @property
    def sole_angle(self) -> Array:
        """phi_m (2,): angle [rad] at the metatarsal joint between sole and ankle."""
        ankle = self.flat_ankle
        return np.asarray(np.arctan2(ankle.imag, self.l_h - ankle.real))


def _parameter(values: Mapping[str, Any], symbol: str) -> Any:
    given = values.get(symbol)
    single = symbol in _ONE_VALUE
    numbers: list[Any] = given if isinstance(given, list) and not single else [given]
    usable = all(isinstance(x, int | float) and not isinstance(x, bool) for x in numbers)
    if not usable or len(numbers) not in (1, 2) or not all(0 < x < np.inf for x in numbers):
        raise GaitFileError(
            "must be a positive number" + ("" if single else ", or a pair of them"),
            "store every body parameter under its symbol",
            field=f"body_parameters.{symbol}",
            value=given,
        )
    return float(numbers[0]) if single else np.resize(np.array(numbers, dtype=float), 2)


@dataclass(frozen=True)
class Moving:
    """A point through time: position, velocity, acceleration, each (n,) or (n, 2 legs)."""

    position: Plane
    velocity: Plane
    acceleration: Plane

    def __add__(self, other: Moving) -> Moving:
        return Moving(
            self.position + other.position,
            self.velocity + other.velocity,
            self.acceleration + other.acceleration,
        )


@dataclass(frozen=True)
class Turning:
    """An angle through time: value [rad], rate [rad/s], acceleration [rad/s2]."""

    angle: Array
    rate: Array
    acceleration: Array

    def carries(self, offset: Any) -> Moving:
        """Where it carries a point that sits at ``offset`` [m] (complex) at angle zero."""
        arm = offset * np.exp(1j * self.angle)
        return Moving(arm, 1j * self.rate * arm, (1j * self.acceleration - self.rate**2) * arm)

    def hangs(self, length: Any) -> Moving:
        """Lower end of a rod of ``length`` [m] that hangs at this angle."""
        return self.carries(-1j * length)


@dataclass(frozen=True)
class Body:
    """Points of the walker through time; those of the legs are (n, 2)."""

    trunk_centre: Moving
    hip: Moving
    thigh_centre: Moving
    knee: Moving
    shank_centre: Moving
    ankle: Moving
    heel: Moving
    metatarsal: Moving
    toe_tip: Moving


def body_points(walker: Walker, hip: Moving, trunk: Turning, segments: tuple[Turning, ...]) -> Body:
    """All points of the walker from the hip (n,), the trunk (n,) and four segments (n, 2)."""
    thigh, shank, foot, toes = segments
    hips = Moving(hip.position[:, None], hip.velocity[:, None], hip.acceleration[:, None])
    knee = hips + thigh.hangs(walker.a)
    ankle = knee + shank.hangs(walker.b)
    # the foot as a rigid triangle, laid out flat and turned by its pitch
    flat = walker.flat_ankle
    flat_angle = np.angle(walker.l_h - flat) + np.pi / 2  # of A -> M, from the downward vertical
    pitch = Turning(foot.angle - flat_angle, foot.rate, foot.acceleration)
    metatarsal = ankle + pitch.carries(walker.l_h - flat)
    return Body(
        trunk_centre=hip + trunk.carries(1j * walker.r),
        hip=hip,
        thigh_centre=hips + thigh.hangs(walker.r_a),
        knee=knee,
        shank_centre=knee + shank.hangs(walker.r_b),
        ankle=ankle,
        heel=ankle + pitch.carries(-flat),
        metatarsal=metatarsal,
        toe_tip=metatarsal + toes.hangs(walker.l_m),
    )
