"""A walk without an optimiser: feet and hip led by hand, loads by inverse dynamics.

The feet follow the phases of (4), the legs follow by the law of cosines, and the hip moves so
that the centre of pressure walks from print to print at constant speed; where both feet carry,
the load is shared so that each centre of pressure stays where its phase wants it. Toes are long
and steps are short, which leaves room. Nothing is optimal, but every law holds, so the audit must
accept it; and since no solver is involved, it does so whatever the solvers do.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from ergowalk.body import Body
from ergowalk.mechanics import dynamics, foot, kinematics
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Point, Rotation

BODY = Body(toe_length_m=0.25)
LEG = BODY.leg(0)
STEP, STRIDE = 0.55, 1.1  # L [m], T [s]
HEEL_END, OTHER_TOE_OFF, SWITCH = 0.08, 0.12, 0.03  # fractions of T
HARMONICS = 12
HIP_HEIGHT = 0.88

SWING, HEEL, FLAT, FOREFOOT, TOE = range(5)


End = tuple[Any, Any, Any]
"""Value, rate and acceleration at one end."""


def _quintic(z: Any, start: End, end: End, width: float) -> Any:
    """Polynomial on [0, 1] that joins two ends in value, rate and acceleration."""
    a, da, dda = start[0], width * start[1], width**2 * start[2] / 2
    b, db, ddb = end[0], width * end[1], width**2 * end[2] / 2
    p = b - a - da - dda
    v = db - da - 2 * dda
    c = ddb - dda
    series = (a, da, dda, 10 * p - 4 * v + c, -15 * p + 7 * v - 2 * c, 6 * p - 3 * v + c)
    return sum(coefficient * z**i for i, coefficient in enumerate(series))


class FootPath:
    """Ankle (x, y), foot pitch and toe pitch of leg 1 through its stride, as CasADi expressions.

    Pitches are counter-clockwise from flat; the heel lands at x = 0 at s = 0.
    """

    def __init__(self, heel_off: float) -> None:
        self.s = ca.SX.sym("s")
        self.times = np.array([0.0, HEEL_END, heel_off, 0.5, 0.5 + OTHER_TOE_OFF, 1.0]) * STRIDE
        x_a, y_a = self.flat_ankle
        self.from_heel = (x_a, y_a)
        self.from_toe = (x_a - LEG.heel_to_metatarsal, y_a)

    @property
    def flat_ankle(self) -> tuple[float, float]:
        """Ankle of a flat foot relative to the heel [m]."""
        height = LEG.ankle_height
        return LEG.heel_to_metatarsal - np.sqrt(LEG.ankle_to_metatarsal**2 - height**2), height

    def phase(self, contact: int) -> tuple[Any, Any, Any, Any]:
        """(x, y, foot pitch, toe pitch) in one phase."""
        starts = dict(zip((HEEL, FLAT, FOREFOOT, TOE, SWING), self.times, strict=False))
        ends = dict(zip((HEEL, FLAT, FOREFOOT, TOE, SWING), self.times[1:], strict=True))
        width = ends[contact] - starts[contact]
        z = (self.s - starts[contact]) / width
        return {
            HEEL: self._heel, FLAT: self._flat, FOREFOOT: self._forefoot, TOE: self._toe,
            SWING: self._swing,
        }[contact](z, width)  # fmt: skip

    def _heel(self, z: Any, width: float) -> tuple[Any, Any, Any, Any]:
        pitch = 0.12 * (1 - z) ** 3
        x, y = _turned(self.from_heel, pitch)
        return x, y, pitch, pitch

    def _flat(self, z: Any, width: float) -> tuple[Any, Any, Any, Any]:
        x, y = self.from_heel
        return x + 0 * z, y + 0 * z, 0 * z, 0 * z

    def _forefoot(self, z: Any, width: float) -> tuple[Any, Any, Any, Any]:
        pitch = -0.3 * z**3
        x, y = _turned(self.from_toe, pitch)
        return LEG.heel_to_metatarsal + x, y, pitch, 0 * z

    def _toe(self, z: Any, width: float) -> tuple[Any, Any, Any, Any]:
        toes = -0.2 * z**3
        before = self.times[3] - self.times[2]
        bent = (0.3, 3 * 0.3 / before, 6 * 0.3 / before**2)
        pitch = toes - _quintic(z, bent, (0.0, 0.0, 0.0), width)
        tip = LEG.heel_to_metatarsal + LEG.toe_length
        x, y = _turned(self.from_toe, pitch)
        return (
            tip - LEG.toe_length * ca.cos(toes) + x, -LEG.toe_length * ca.sin(toes) + y, pitch,
            toes,
        )  # fmt: skip

    def _swing(self, z: Any, width: float) -> tuple[Any, Any, Any, Any]:
        before, after = self._ends(TOE, self.times[4]), self._ends(HEEL, 0.0)
        after[0] = (after[0][0] + 2 * STEP, *after[0][1:])
        x, y, pitch = (_quintic(z, p, q, width) for p, q in zip(before, after, strict=True))
        y = y + 1.5 * z**3 * (1 - z) ** 3
        return x, y, pitch, pitch

    def _ends(self, contact: int, at: float) -> list[End]:
        values = ca.vertcat(*self.phase(contact)[:3])
        rates = ca.jacobian(values, self.s)
        both = ca.Function("ends", [self.s], [values, rates, ca.jacobian(rates, self.s)])
        return list(zip(*(np.array(v).ravel().tolist() for v in both(at)), strict=True))


def _turned(arm: tuple[float, float], pitch: Any) -> tuple[Any, Any]:
    c, s = ca.cos(pitch), ca.sin(pitch)
    return arm[0] * c - arm[1] * s, arm[0] * s + arm[1] * c


@dataclass(frozen=True)
class Piece:
    """A smooth stretch of [0, T/2]: instants [s] and contacts of both legs."""

    time: np.ndarray
    contacts: tuple[int, int]


class Marionette:
    """The walk for a heel-off and hip harmonics (2 x HARMONICS + 1: mean, cosines, sines)."""

    def __init__(self, heel_off: float, hip: np.ndarray) -> None:
        self.heel_off, self.hip = heel_off, hip
        self.path = FootPath(heel_off)

    @cached_property
    def pieces(self) -> list[Piece]:
        """Nine samples each, steps well under T/400."""
        edges = np.array([0.0, SWITCH, HEEL_END, OTHER_TOE_OFF, self.heel_off, 0.5]) * STRIDE
        contacts = [(HEEL, TOE), (HEEL, TOE), (FLAT, TOE), (FLAT, SWING), (FOREFOOT, SWING)]
        pieces = []
        for a, b, pair in zip(edges, edges[1:], contacts, strict=False):
            count = int(np.ceil((b - a) / (8 * STRIDE / 420)))
            inner = np.linspace(a, b, count + 1)
            pieces += [Piece(np.linspace(u, v, 9), pair) for u, v in itertools.pairwise(inner)]
        return pieces

    @cached_property
    def time(self) -> np.ndarray:
        """All instants of [0, T/2]."""
        return np.concatenate([p.time for p in self.pieces])

    @cached_property
    def contacts(self) -> np.ndarray:
        """Contact of each leg (n, 2)."""
        return np.concatenate([np.tile(p.contacts, (len(p.time), 1)) for p in self.pieces])

    @cached_property
    def motion(self) -> BodyMotion:
        """The motion on [0, T/2] with exact derivatives."""
        rows = [self._piece(p) for p in self.pieces]
        values = [np.concatenate([r[k] for r in rows], axis=1) for k in range(3)]
        hip = Point(*((v[0], v[1]) for v in values))
        rotations = [Rotation(*(v[i] for v in values)) for i in range(2, 11)]
        return BodyMotion(
            hip, rotations[0], (LegMotion(*rotations[1:5]), LegMotion(*rotations[5:9]))
        )

    def _piece(self, piece: Piece) -> list[np.ndarray]:
        if piece.contacts not in self._functions:
            self._functions[piece.contacts] = self._function(piece.contacts)
        call = self._functions[piece.contacts].map(len(piece.time))
        return [np.array(v) for v in call(piece.time[None], self.hip[:, None])]

    @cached_property
    def _functions(self) -> dict[tuple[int, int], Any]:
        return {}

    def _function(self, contacts: tuple[int, int]) -> Any:
        """(t, hip harmonics) -> hip, trunk and segment angles with two derivatives."""
        t, hip = ca.SX.sym("t"), ca.SX.sym("hip", 2 * HARMONICS + 1)
        x = 2 * STEP * t / STRIDE + hip[0]
        for k in range(1, HARMONICS + 1):
            w = 4 * np.pi * k / STRIDE
            x += hip[k] * ca.cos(w * t) + hip[HARMONICS + k] * ca.sin(w * t)
        y = HIP_HEIGHT + 0.01 * ca.cos(4 * np.pi * t / STRIDE + 0.5)
        psi = 0.02 * ca.sin(4 * np.pi * t / STRIDE)
        angles = [x, y, psi]
        for contact, delay, shift in zip(contacts, (0.0, STRIDE / 2), (0.0, -STEP), strict=True):
            path = self.path.phase(contact)
            x_a, y_a, pitch, toes = ca.substitute(list(path), [self.path.s], [t + delay])
            # leg 2 made its print at -L half a stride ago
            angles += _leg_angles(x_a + shift - x, y_a - y, pitch, toes)
        q = ca.vertcat(*angles)
        rate = ca.jacobian(q, t)
        return ca.Function("walk", [t, hip], [q, rate, ca.jacobian(rate, t)])

    @cached_property
    def total(self) -> tuple[np.ndarray, np.ndarray]:
        """Sum of the reactions (x, y) [N]."""
        return dynamics.total_reaction(dynamics.coefficients(BODY), self.motion)

    @cached_property
    def points(self) -> list[kinematics.LegPoints]:
        """Points of both legs."""
        return [kinematics.leg_points(LEG, leg, self.motion.hip) for leg in self.motion.legs]

    @cached_property
    def pressure(self) -> np.ndarray:
        """Centre of pressure of both feet together [m]."""
        zero = 0 * self.time
        upper = dynamics.joint_moments_from(
            dynamics.coefficients(BODY), self.motion, (self.total, (zero, zero)), zero
        )
        return foot.pressure_moment(self.points[0], upper[0][2], self.total) / self.total[1]

    @cached_property
    def trailing_share(self) -> np.ndarray:
        """Share of the load on leg 2, whose centre of pressure is its toe tip."""
        tip = -STEP + LEG.heel_to_metatarsal + LEG.toe_length
        lever = 1 - (self.pressure - tip) / (0.0 - tip)
        fraction = self.time / STRIDE
        at_switch, at_flat = np.interp([SWITCH, HEEL_END], fraction, lever)
        fading = at_flat * (OTHER_TOE_OFF - fraction) / (OTHER_TOE_OFF - HEEL_END)
        # leg 1 has hardly any load before SWITCH, so its centre of pressure is free
        early = np.concatenate(
            [np.full(9, p.time[-1] < (SWITCH + 1e-9) * STRIDE) for p in self.pieces]
        )
        heel, toe = self.contacts[:, 0] == HEEL, self.contacts[:, 1] == TOE
        return np.where(early, at_switch, np.where(heel, lever, np.where(toe, fading, 0.0)))


def _leg_angles(d_x: Any, d_y: Any, pitch: Any, toes: Any) -> list[Any]:
    """Thigh, shank, foot, toe angle of a leg whose ankle is at (d_x, d_y) from the hip."""
    a, b = LEG.thigh_length, LEG.shank_length
    square = d_x**2 + d_y**2
    line, distance = ca.atan2(d_x, -d_y), ca.sqrt(square)
    thigh = line + ca.acos((square + a**2 - b**2) / (2 * a * distance))
    shank = line - ca.acos((square + b**2 - a**2) / (2 * b * distance))
    return [thigh, shank, np.pi / 2 - LEG.foot_angle + pitch, np.pi / 2 + toes]


def led_by_hand() -> Marionette:
    """Move the hip until the centre of pressure goes where the feet are.

    A walker of constant height obeys z = x - (h/g) x'' harmonic by harmonic; dividing the error
    of z by 1 + (h/g) w^2 and repeating also takes care of what the swinging leg does.
    """
    hip, heel_off = np.zeros(2 * HARMONICS + 1), 0.29
    start = -STEP + LEG.heel_to_metatarsal + LEG.toe_length - 0.012
    for _ in range(25):
        walk = Marionette(heel_off, hip)
        wanted = start + 2 * STEP * walk.time / STRIDE
        steps = np.gradient(walk.time) * 2 / STRIDE
        error = walk.pressure - wanted
        hip = hip.copy()
        hip[0] -= np.sum(error * steps)
        for k in range(1, HARMONICS + 1):
            w = 4 * np.pi * k / STRIDE
            gain = 2 / (1 + (HIP_HEIGHT + 0.1) / 9.81 * w**2)
            hip[k] -= gain * np.sum(error * np.cos(w * walk.time) * steps)
            hip[HARMONICS + k] -= gain * np.sum(error * np.sin(w * walk.time) * steps)
        late = np.flatnonzero(walk.pressure[1:] * 1.0 < LEG.heel_to_metatarsal)[-1] + 1
        heel_off += 0.5 * (walk.time[late] / STRIDE - heel_off)
    return Marionette(heel_off, hip)
