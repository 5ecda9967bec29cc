"""The spaces that the laws are tested on: random bodies, postures, motions and loads."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.mechanics.dynamics import (
    LegMoments,
    coefficients,
    joint_moments_from,
    motion_of,
    total_reaction,
)
from ergowalk.mechanics.kinematics import BodyMotion, Rotation, Vector

Array = NDArray[np.float64]

PAPER = Body()

LAW = settings(
    deadline=None,
    max_examples=40,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
"""How often a law is put to the test, every time on the same examples."""


def numbers(count: int, bound: float) -> st.SearchStrategy[Array]:
    """(count,) numbers within +- bound."""
    element = st.floats(-bound, bound, allow_subnormal=False)
    return arrays(np.float64, count, elements=element)


@dataclass(frozen=True)
class State:
    """Eleven coordinates with rates and accelerations: those of (1), then gamma_1, epsilon_1,
    gamma_2, epsilon_2; each (11,) or (11, n)."""

    positions: Array
    rates: Array
    accelerations: Array

    def motion(self) -> BodyMotion:
        """The same as the mechanics see it."""
        body = motion_of(self.positions, self.rates, self.accelerations)
        feet = [
            Rotation(self.positions[i], self.rates[i], self.accelerations[i]) for i in range(7, 11)
        ]
        first, second = body.legs
        return replace(
            body,
            legs=(
                replace(first, foot=feet[0], toes=feet[1]),
                replace(second, foot=feet[2], toes=feet[3]),
            ),
        )

    def swapped(self) -> State:
        """Leg 1 and leg 2 exchanged."""
        order = [0, 1, 2, 5, 6, 3, 4, 9, 10, 7, 8]
        return State(self.positions[order], self.rates[order], self.accelerations[order])

    def reflected(self) -> State:
        """Seen from the other side: forward is backward, every angle changes its sign."""
        sign = np.where(np.arange(11) == 1, 1.0, -1.0)
        return State(sign * self.positions, sign * self.rates, sign * self.accelerations)


states = st.builds(State, numbers(11, np.pi), numbers(11, 8.0), numbers(11, 60.0))
"""Any posture, with rates to 8 rad/s and accelerations to 60 rad/s2."""


@dataclass(frozen=True)
class SmoothMotion:
    """A smooth motion of the eleven coordinates: offset + sum_k amplitude_k sin(w_k t + phase_k).

    Analytic, so that time may be complex: an imaginary step of 1e-30 gives derivatives without
    a difference.
    """

    offset: Array
    amplitude: Array
    phase: Array

    def at(self, time: complex | Array) -> State:
        """State at one time or at (n,) times."""
        t = np.asarray(time)[..., None]
        frequency = 5.0 * np.arange(1, 3)
        amplitude, phase = self.amplitude.reshape(11, 2), self.phase.reshape(11, 2)
        turns = [frequency * t + phase[i] for i in range(11)]
        rows = range(11)
        return State(
            np.array([self.offset[i] + np.sin(turns[i]) @ amplitude[i] for i in rows]),
            np.array([np.cos(turns[i]) @ (amplitude[i] * frequency) for i in rows]),
            np.array([-np.sin(turns[i]) @ (amplitude[i] * frequency**2) for i in rows]),
        )


smooth_motions = st.builds(SmoothMotion, numbers(11, np.pi), numbers(22, 0.6), numbers(22, np.pi))


@dataclass(frozen=True)
class Load:
    """Joint moments, ground reactions and their points of attack of both legs."""

    moments: tuple[LegMoments, LegMoments]
    reactions: tuple[Vector, Vector]
    pressure: tuple[float, float]

    def swapped(self) -> Load:
        """Leg 1 and leg 2 exchanged."""
        return Load(self.moments[::-1], self.reactions[::-1], self.pressure[::-1])


@st.composite
def loads(draw: st.DrawFn) -> Load:
    """Moments to 150 N m, reactions to 800 N, anywhere within 1 m."""
    m, r, x = draw(numbers(8, 150.0)), draw(numbers(4, 800.0)), draw(numbers(2, 1.0))
    return Load(
        (LegMoments(*m[:4].tolist()), LegMoments(*m[4:].tolist())),
        ((float(r[0]), float(r[1])), (float(r[2]), float(r[3]))),
        (float(x[0]), float(x[1])),
    )


@st.composite
def body_fields(draw: st.DrawFn, inertia: tuple[float, float] = (1.0, 1.6)) -> dict[str, Any]:
    """Fields of a body unlike the paper's, with unlike legs; J = (a number in inertia) m r^2."""
    scale = st.floats(0.7, 1.4)
    legs = []
    for _ in (0, 1):
        leg = {name: draw(scale) * value for name, value in _LEG.items()}
        for part in ("thigh", "shank"):
            point = leg[f"{part}_mass_kg"] * leg[f"{part}_com_m"] ** 2
            leg[f"{part}_inertia_kgm2"] = draw(st.floats(*inertia)) * point
        short = abs(leg["heel_to_ankle_m"] - leg["ankle_to_metatarsal_m"])
        long = leg["heel_to_ankle_m"] + leg["ankle_to_metatarsal_m"]
        leg["heel_to_metatarsal_m"] = short + draw(st.floats(0.1, 0.9)) * (long - short)
        legs.append(leg)
    fields: dict[str, Any] = {name: (legs[0][name], legs[1][name]) for name in legs[0]}
    mass, com = draw(scale) * 46.7, draw(scale) * 0.39
    return fields | {
        "trunk_mass_kg": mass,
        "trunk_com_m": com,
        "trunk_inertia_kgm2": draw(st.floats(*inertia)) * mass * com**2,
    }


_LEG = {
    name: getattr(PAPER, name)
    for name in Body.model_fields
    if not name.startswith(("trunk", "gravity", "heel_to_metatarsal"))
}

bodies = body_fields().map(lambda fields: Body(**fields)) | st.just(PAPER)
"""The paper's body, and others with unlike legs."""


def with_legs_swapped(body: Body) -> Body:
    """Leg 1 and leg 2 exchanged."""
    fields: dict[str, Any] = {name: getattr(body, name) for name in Body.model_fields}
    swapped: dict[str, Any] = {k: v[::-1] if isinstance(v, tuple) else v for k, v in fields.items()}
    return Body(**swapped)


@dataclass(frozen=True)
class Carried:
    """A motion with moments and reactions that carry it: inverse dynamics in double support."""

    motion: BodyMotion
    moments: tuple[LegMoments, LegMoments]
    reactions: tuple[Vector, Vector]


def carried(body: Body, motion: BodyMotion, trailing: Array, ankle: float) -> Carried:
    """The loads of a motion when reaction and ankle moment of leg 2 are given."""
    c = coefficients(body)
    total = total_reaction(c, motion)
    reactions = (total[0] - trailing[0], total[1] - trailing[1]), (trailing[0], trailing[1])
    first, second = joint_moments_from(c, motion, reactions, ankle)
    moments = LegMoments(*first, metatarsal=0.0), LegMoments(*second, metatarsal=0.0)
    return Carried(motion, moments, reactions)
