"""One instant of the half stride: from the free functions to motion, forces and (19).

Everything is symbolic, once per phase; evaluating many instants is one mapped function.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.corridors import ANGLES
from ergowalk.gait.footprints import leading_print, trailing_print
from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.mechanics.dynamics import coefficients
from ergowalk.mechanics.kinematics import (
    HALF_PI,
    BodyMotion,
    LegMotion,
    LegPoints,
    Vector,
    joint_angles,
    leg_points,
    sole,
)
from ergowalk.problem import DoubleSupport, GaitProblem
from ergowalk.problem import constraints as c
from ergowalk.problem.objective import eq10_joint_powers
from ergowalk.transcription.spline import motion as m
from ergowalk.transcription.spline.curves import (
    FOOT_HEEL,
    FOOT_RISE,
    FORCE_TOE,
    HIP,
    KNEE,
    SWING_FOOT,
    THIGH_SWING,
    THIGH_TOE,
    TRUNK,
)
from ergowalk.transcription.spline.jets import Jet, capped, floored
from ergowalk.transcription.spline.loads import (
    WORKING_JOINTS,
    Forces,
    forces,
    share_on_heel,
)

Array = NDArray[np.float64]

LOADED = 0.05
"""Vertical reaction [body weights] below which a centre of pressure is computed as if it were
this large: it has no meaning there, and must not be infinite."""

MARGIN = 0.05
"""How far [m] beyond its print the pressure that (12) starts from may lie."""

SHARED = ("force_x", "pressure", "force_y")
"""What all instants of double support share: R_2x and x_R2 at heel contact, R_2y at foot-flat."""

MEASURES = ("geometry", "hip", "knee", "ankle", "ground", "reaction", "pressure")
"""G_0 (what no motion can reach [m s]) and G_1 ... G_6 of (19) [rad s, m s, N s]."""


@dataclass(frozen=True)
class Local:
    """A free function at an instant: its spline, and how much later than the instant."""

    name: str
    half_strides_later: int = 0


def local_functions(phase: Phase) -> tuple[Local, ...]:
    """The free functions that a phase needs: value, rate and acceleration of each."""
    found = [Local(KNEE), Local(KNEE, 1), Local(HIP), Local(TRUNK)]
    if phase.legs[0] is not Contact.FLAT:
        found.append(Local(FOOT_HEEL if phase.legs[0] is Contact.HEEL else FOOT_RISE))
    if phase.legs[1] is Contact.SWING:
        return (*found, Local(THIGH_SWING), Local(SWING_FOOT))
    return (*found, Local(THIGH_TOE), Local(FORCE_TOE))


class Instant:
    """The walker at one instant of a phase, in CasADi symbols.

    ``toe_off`` is the instant of the other leg's toe-off [s].

    Attributes
    ----------
    variables : SX (3 n,)
        Value, rate, acceleration of each of :func:`local_functions`.
    known : SX (17,)
        Bounds of (6), lower then upper, hip, knee, ankle of leg 1 and then of leg 2 [rad]; human
        ankle angle of leg 2 with rate and acceleration; the fraction of double support and that
        of the flat phase in it which are left.
    shared : SX (3,)
        :data:`SHARED`.
    """

    def __init__(self, problem: GaitProblem, phase: Phase, toe_off: float) -> None:
        self.problem, self.phase, self.leg = problem, phase, problem.body.leg(0)
        self.toe_off = toe_off
        self.functions = local_functions(phase)
        self.variables = ca.SX.sym("v", 3 * len(self.functions))
        self.known = ca.SX.sym("k", 17)
        self.shared = ca.SX.sym("s", len(SHARED))
        self.prints = (leading_print(self.leg), trailing_print(self.leg, problem.step_length_m))
        self.coefficients = coefficients(problem.body)
        self.weight = problem.body.total_mass * problem.body.gravity_m_s2

    @cached_property
    def jets(self) -> dict[Local, Jet]:
        """The free functions."""
        return {
            f: Jet(*(self.variables[3 * i + d] for d in range(3)))
            for i, f in enumerate(self.functions)
        }

    @property
    def swing_fraction(self) -> Any:
        """How much of the swing in this half stride has passed."""
        toe_off = self.toe_off / (self.problem.stride_time_s / 2 - self.toe_off)
        return -self.known[15] * toe_off

    @cached_property
    def _motion(self) -> tuple[BodyMotion, Any]:
        leg, (lead, trail) = self.leg, self.phase.legs
        jets = {(f.name, f.half_strides_later): jet for f, jet in self.jets.items()}
        foot = Jet(HALF_PI - leg.foot_angle)
        foot = jets.get((FOOT_HEEL, 0), jets.get((FOOT_RISE, 0), foot))
        knee_1, knee_2, x = jets[KNEE, 0], jets[KNEE, 1], jets[HIP, 0]
        stance = m.standing(leg, lead, self.prints[0], knee_1, x, foot)
        psi, missing = m.trunk(x, jets[TRUNK, 0], self.problem.body.trunk_com_m)
        missing = missing + stance.missing
        thigh = jets[THIGH_SWING if trail is Contact.SWING else THIGH_TOE, 0]
        shank, ankle = m.hanging(leg, stance.hip, thigh, knee_2)
        if trail is Contact.SWING:
            human = Jet(self.known[12], self.known[13], self.known[14])
            angle = jets[SWING_FOOT, 0] + human + (HALF_PI - leg.foot_angle)
            foot_2 = (angle + Jet.of(shank)).rotation
            toes_2 = sole(leg, foot_2)
        else:
            foot_2, toes_2, off = m.toe_support(leg, ankle, self.prints[1].toe_tip)
            missing = missing + off
        two = LegMotion(thigh.rotation, shank, foot_2, toes_2)
        return BodyMotion(stance.hip, psi.rotation, (stance.leg, two)), missing

    @property
    def motion(self) -> BodyMotion:
        """The whole walker."""
        return self._motion[0]

    @property
    def missing(self) -> Any:
        """By how much the geometry is impossible [m]."""
        return self._motion[1]

    @cached_property
    def points(self) -> tuple[LegPoints, LegPoints]:
        """Points of both legs."""
        one, two = (leg_points(self.leg, g, self.motion.hip) for g in self.motion.legs)
        return one, two

    @cached_property
    def sharing(self) -> tuple[Vector, Any]:
        """Force under leg 2 [N] and where it acts [m], see :mod:`~.spline.loads`."""
        tip = self.prints[1].toe_tip
        if not self.phase.double_support:
            return (0.0, 0.0), tip
        left, since_flat = self.known[15], self.known[16]
        bend = self.jets[Local(FORCE_TOE)].value
        force_x, pressure = self.shared[0] * left + self.weight * bend, ca.SX(tip)
        if self.problem.double_support is DoubleSupport.LINEAR:
            pressure = tip + (self.shared[1] - tip) * left
        if self.phase.legs[0] is Contact.FLAT:
            return (force_x, self.shared[2] * since_flat), pressure
        force_y = share_on_heel(
            self.problem.body,
            self.coefficients,
            self.motion,
            self.points,
            force_x,
            pressure,
            self.prints[0].heel,
        )
        return (force_x, force_y), pressure

    @cached_property
    def forces(self) -> Forces:
        """Moments and reactions."""
        trailing, pressure = self.sharing
        return forces(self.coefficients, self.motion, self.points, trailing, pressure)

    @cached_property
    def powers(self) -> list[Any]:
        """Powers [W] of (10) of the joints that can do work."""
        found: list[Any] = []
        for contact, moments, leg in zip(
            self.phase.legs, self.forces.moments, self.motion.legs, strict=True
        ):
            powers = eq10_joint_powers(moments, self.motion.trunk, leg)
            found += powers[: WORKING_JOINTS[contact]]
        return found

    @cached_property
    def angles(self) -> list[Any]:
        """Hip, knee, ankle angle of (6) of leg 1, then of leg 2 [rad]."""
        psi = self.motion.trunk.angle
        found: list[Any] = []
        for g in self.motion.legs:
            segments = (r.angle for r in (g.thigh, g.shank, g.foot, g.toes))
            found += joint_angles(self.leg, psi, *segments)[: len(ANGLES)]
        return found

    @cached_property
    def pressure(self) -> Any:
        """Centre of pressure of leg 1 [m], bounded where its vertical reaction vanishes."""
        force_y = self.forces.reactions[0][1]
        return self.forces.pressure_moment / floored(force_y, LOADED * self.weight)

    @cached_property
    def measures(self) -> list[Any]:
        """Integrands of :data:`MEASURES` over the half stride, both legs together."""
        outside = [
            ca.fmax(0.0, self.known[i] - angle) + ca.fmax(0.0, angle - self.known[6 + i])
            for i, angle in enumerate(self.angles)
        ]
        heights = [p.position[1] for q in self.points for p in (q.heel, q.toe_tip)]
        reactions = [r[1] for r in self.forces.reactions[: 1 + self.phase.double_support]]
        low, high = c.eq9_pressure_edges(self.phase.legs[0], self.prints[0])
        if self.phase.legs[0] is Contact.HEEL:
            high = self.prints[0].metatarsal  # (19) asks no more before the foot is flat
        astray: Any = 0.0
        if not self.phase.double_support:
            astray = ca.fmax(0.0, low - self.pressure) + ca.fmax(0.0, self.pressure - high)
        return [
            self.missing,
            *(outside[j] + outside[3 + j] for j in range(3)),
            sum(ca.fmax(0.0, -y) for y in heights),
            sum(ca.fmax(0.0, -force) for force in reactions),
            astray,
        ]

    @cached_property
    def carried(self) -> list[Any]:
        """:data:`SHARED` as this instant determines them if it is the one that does: the load of
        leg 1 at T/2 is that of leg 2 at 0; R_2y at the end of the heel phase."""
        tip, back = self.prints[0].toe_tip, self.problem.step_length_m
        low = self.prints[0].metatarsal
        bounded = -capped(-capped(self.pressure, tip, MARGIN), -low, MARGIN)
        return [self.forces.reactions[0][0], bounded - back, self.sharing[0][1]]

    @cached_property
    def state(self) -> list[Any]:
        """Motion and sharing as one list: positions, rates, accelerations of hip x, y, trunk and
        the segments of both legs; force x, y and pressure under leg 2."""
        g, hip = self.motion, self.motion.hip
        turning = [g.trunk]
        for leg in g.legs:
            turning += [leg.thigh, leg.shank, leg.foot, leg.toes]
        (force_x, force_y), pressure = self.sharing
        return [
            *hip.position,
            *(r.angle for r in turning),
            *hip.velocity,
            *(r.rate for r in turning),
            *hip.acceleration,
            *(r.acceleration for r in turning),
            force_x,
            force_y,
            pressure,
        ]
