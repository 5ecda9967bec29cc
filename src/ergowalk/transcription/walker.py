"""The walker of a gait problem as functions of an instant: unknowns, motion, what must hold."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from ergowalk.body import LegParameters
from ergowalk.corridors import ANGLES
from ergowalk.gait.footprints import Footprint, leading_print, trailing_print
from ergowalk.gait.loads import vertical_share
from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.mechanics.dynamics import (
    Coefficients,
    LegMoments,
    applied_load,
    coefficients,
    inertial_load,
    total_reaction,
)
from ergowalk.mechanics.foot import foot_balance, pressure_moment, toe_balance
from ergowalk.mechanics.kinematics import (
    HALF_PI,
    BodyMotion,
    LegMotion,
    LegPoints,
    Rotation,
    Vector,
    hip_over_contact,
    joint_angles,
    leg_points,
    sole,
)
from ergowalk.problem import JOINTS, DoubleSupport, GaitProblem
from ergowalk.problem import constraints as c
from ergowalk.transcription.charges import charge_own_moments, work_price
from ergowalk.transcription.design import (
    design_unknowns,
    designed,
    frees_toes,
    reference_mass,
    structural,
)
from ergowalk.transcription.devices import LOADED_JOINTS, Fittings
from ergowalk.transcription.edges import BAND, corridor_edges
from ergowalk.transcription.phases import (
    Instant,
    State,
    Terms,
    TimeCurves,
    Unknown,
)
from ergowalk.transcription.steps import Steps, UnequalSteps
from ergowalk.transcription.unknowns import FORCE, algebraics

METRE = 0.1
"""Typical height [m] by which rows are divided."""


@dataclass(frozen=True)
class Smoothing:
    """Small costs that single out one of many nearly equal optima; they are not part of E.

    ``moment_rate`` weighs the squared rates of hip, knee and ankle moments per kg,
    ``metatarsal_rate`` those of the metatarsal moment, which has no limit by default, and
    ``swing_foot`` the squared acceleration of the massless swing foot, which nothing else sees.
    The integrals over half a stride are added to the absolute work per kg [J/kg].
    """

    moment_rate: float = 1e-5
    metatarsal_rate: float = 1e-4
    swing_foot: float = 1e-6

    def scaled(self, factor: float) -> Smoothing:
        """The same beside an objective that charges work ``factor`` times as dearly as E."""
        return Smoothing(*(factor * weight for weight in vars(self).values()))


class Walker:
    """What all phases of a gait problem share, and the functions of an instant."""

    def __init__(
        self, problem: GaitProblem, smoothing: Smoothing, unequal: UnequalSteps | None = None
    ) -> None:
        def seen(given: GaitProblem) -> GaitProblem:
            """The problem with the leg that leads in this half as leg 1."""
            return given.exchanged() if unequal is not None and unequal.half else given

        self.asked, self.smoothing, self.unequal = problem, smoothing, unequal
        self.problem = problem = seen(problem)
        self.small = smoothing.scaled(work_price(problem.objective))
        self.legs: tuple[LegParameters, LegParameters] = (problem.body.leg(0), problem.body.leg(1))
        self.mass, self.gravity = problem.body.total_mass, problem.body.gravity_m_s2
        self.coefficients: Coefficients = coefficients(problem.body)
        self.corridors = (problem.angle_corridors(0), problem.angle_corridors(1))
        self.bands = (problem.corridors_of(0), problem.corridors_of(1))
        self.limits = (problem.limits_of(0), problem.limits_of(1))
        self.steps = Steps.equal(problem)
        self.leg = self.legs[0]
        self.flats = tuple(HALF_PI - leg.foot_angle for leg in self.legs)
        self.flat = self.flats[0]
        self.fittings = Fittings(seen(structural(self.asked)))
        self.reference_mass = reference_mass(self.asked)
        self.linear_sharing = problem.double_support is DoubleSupport.LINEAR

    # --- unknowns -------------------------------------------------------------------------

    @property
    def shared(self) -> tuple[Unknown, ...]:
        """Unknowns that belong to no instant."""
        steps = () if self.unequal is None else self.unequal.unknowns
        return (*design_unknowns(self.asked), *steps)

    @property
    def seen(self) -> tuple[Unknown, ...]:
        """These, and instants of other phases, as the phases see them."""
        steps = () if self.unequal is None else self.unequal.seen
        return (*design_unknowns(self.asked), *steps)

    def at(self, shared: Mapping[str, Any]) -> Walker:
        """The walker that has these values, symbols or numbers, of what its phases see."""
        found = designed(self, shared)
        if self.unequal is not None:
            found = copy(found)
            found.steps = self.unequal.given(shared)
        return found

    @property
    def prints(self) -> tuple[Footprint, Footprint]:
        """Where the leading and the trailing foot stand [m]."""
        return leading_print(self.legs[0]), trailing_print(self.legs[1], self.steps.behind)

    # --- the motion at an instant ---------------------------------------------------------

    def motion(self, phase: Phase, instant: Instant) -> BodyMotion:
        """The whole walker from the minimal coordinates."""
        q = instant.coordinates
        foot_1 = _rotation(q["foot_1"]) if "foot_1" in q else Rotation(self.flat)
        in_line = c.eq7_toes_in_line(phase.legs[0])
        toes_1 = sole(self.legs[0], foot_1) if in_line else Rotation(HALF_PI)
        if phase.legs[1] is Contact.SWING:
            foot_2 = _rotation(q["foot_2"])
            toes_2 = sole(self.legs[1], foot_2)
        else:
            z = instant.algebraics
            foot_2 = Rotation(z.get("foot_2", 0.0), z.get("foot_2_rate", 0.0))
            toes_2 = Rotation(z.get("toes_2", 0.0), z.get("toes_2_rate", 0.0))
        legs = (
            LegMotion(_rotation(q["thigh_1"]), _rotation(q["shank_1"]), foot_1, toes_1),
            LegMotion(_rotation(q["thigh_2"]), _rotation(q["shank_2"]), foot_2, toes_2),
        )
        return BodyMotion(self.hip(phase.legs[0], legs[0]), _rotation(q["trunk"]), legs)

    def hip(self, contact: Contact, leg: LegMotion) -> Any:
        """Hip point over the print of leg 1."""
        if contact is Contact.HEEL:
            return hip_over_contact(self.legs[0], leg, "heel", (self.prints[0].heel, 0.0))
        rests = (self.prints[0].metatarsal, 0.0)
        return hip_over_contact(self.legs[0], leg, "metatarsal", rests)

    def points(self, motion: BodyMotion) -> tuple[LegPoints, LegPoints]:
        """Points of both legs."""
        one, two = (
            leg_points(leg, moving, motion.hip)
            for leg, moving in zip(self.legs, motion.legs, strict=True)
        )
        return one, two

    # --- what must hold -------------------------------------------------------------------

    def corridor_rows(self, phase: Phase, instant: Instant, motion: BodyMotion) -> Terms:
        """(6) for every joint whose angle is known at this instant."""
        terms = Terms()
        for label, place in self.corridor_places(phase, instant, motion):
            _, joint, leg, _ = label.split()
            if self.bands[int(leg) - 1].width(joint) is not None:
                terms.between(label, place, -1.0, 1.0)
        return terms

    def corridor_places(
        self, phase: Phase, instant: Instant, motion: BodyMotion
    ) -> list[tuple[str, Any]]:
        """Places of hip, knee, ankle angles in their corridors, -1 ... 1."""
        places = []
        for i, leg in enumerate(motion.legs):
            known = i == 0 or phase.legs[1] is Contact.SWING or "foot_2" in instant.algebraics
            angles = joint_angles(
                self.legs[i],
                motion.trunk.angle,
                *(r.angle for r in (leg.thigh, leg.shank, leg.foot, leg.toes)),
            )
            for joint, angle in zip(ANGLES, angles, strict=False):
                if joint != "ankle" or known:
                    mean, half = (instant.curves[f"{joint}_{i + 1} {edge}"] for edge in BAND)
                    place = c.eq6_corridor_position(angle, mean, half)
                    places.append((f"corridor {joint} {i + 1} (6)", place))
        return places

    @cached_property
    def corridor_curves(self) -> tuple[TimeCurves, ...]:
        """Middle and half width of every corridor of both legs as functions of time [rad].

        The trailing leg met the ground as long before as the other half lasts.
        """
        stride = self.problem.stride_time_s
        if self.unequal is None:
            return (corridor_edges(self.corridors, stride, {1: 0.0, 2: 0.5}),)
        trailing = corridor_edges(self.corridors, stride, {2: 0.0})
        return (
            corridor_edges(self.corridors, stride, {1: 0.0}),
            replace(trailing, later=self.unequal.other_end),
        )

    def clearance_rows(self, phase: Phase, instant: Instant, motion: BodyMotion) -> Terms:
        """(4): no point of a foot below the ground; (7): toes bend only upward."""
        terms = Terms()
        points = self.points(motion)
        for i, contact in enumerate(phase.legs):
            if i == 0 or contact is Contact.SWING or "foot_2" in instant.algebraics:
                heights = c.eq4_clearances(contact, points[i])
                terms.nonnegative("clearance (4)", *(y / METRE for y in heights))
                if contact is Contact.TOE:
                    bend = c.eq7_toe_rotation(contact, self.legs[i], motion.legs[i])
                    terms.nonnegative("toe rotation (7)", bend)
        return terms

    def friction_rows(self, phase: Phase, instant: Instant) -> Terms:
        """Friction cone of each loaded foot."""
        terms = Terms()
        reactions = self.reactions(instant)
        for contact, reaction, limits in zip(phase.legs, reactions, self.limits, strict=True):
            coefficient = limits.friction_coefficient
            if contact is not Contact.SWING and coefficient != "off":
                cone = c.limit_friction(reaction, coefficient)
                terms.nonnegative("friction", *(x / FORCE for x in cone))
        return terms

    def load_rows(self, phase: Phase, instant: Instant, motion: BodyMotion) -> Terms:
        """(8), the cap, and (9) at the ends of elements.

        There the forces are those that inverse dynamics finds for the motion, not
        extrapolations: without this they overshoot between the points of two elements.
        """
        terms, limits = Terms(), algebraics(self, phase)
        _, trailing = self.reactions(instant)
        if phase.legs == (Contact.HEEL, Contact.TOE):
            pressure = self.prints[1].toe_tip
            if self.linear_sharing:
                pressure = pressure + instant.coordinates["pressure_shift"].value
            two = (self.mass * trailing[0], self.mass * trailing[1])
            share = vertical_share(self.problem.body, motion, two, pressure)
            trailing = (trailing[0], share / self.mass)
        total = total_reaction(self.coefficients, motion)
        leading = tuple(a / self.mass - b for a, b in zip(total, trailing, strict=True))
        reactions = (leading, trailing)
        for i, contact in enumerate(phase.legs):
            if contact is not Contact.SWING:
                highest = next(z.upper for z in limits if z.name == f"reaction_y_{i + 1}")
                value = c.eq8_vertical_reaction(reactions[i]) / FORCE
                terms.between("vertical reaction (8)", value, 0.0, highest / FORCE)
        terms.rows += self.pressure_rows(phase, instant, motion, reactions).rows
        return terms

    def pressure_rows(
        self, phase: Phase, instant: Instant, motion: BodyMotion, reactions: Any
    ) -> Terms:
        """(9) where the centre of pressure has room; where it has none it is an equation."""
        terms = Terms()
        points, moments = self.points(motion), self.moments(phase, instant, motion)
        for i, contact in enumerate(phase.legs):
            if contact in (Contact.FLAT, Contact.FOREFOOT):
                pressure = pressure_moment(points[i], moments[i].ankle, reactions[i])
                edges = c.eq9_pressure(contact, self.prints[i], pressure, reactions[i])
                terms.nonnegative("centre of pressure (9)", *edges)
        return terms

    def dynamics_rows(self, phase: Phase, instant: Instant, motion: BodyMotion) -> Terms:
        """(1), the foot lines included, per kg; and powers of (10)."""
        terms = Terms()
        moments, reactions = self.moments(phase, instant, motion), self.reactions(instant)
        one, two = (LegMoments(*(self.mass * getattr(m, j) for j in JOINTS)) for m in moments)
        forces = (_scaled(self.mass, reactions[0]), _scaled(self.mass, reactions[1]))
        left = inertial_load(self.coefficients, motion)
        right = applied_load(self.coefficients, motion, (one, two), forces)
        terms.equal(
            "equations of motion (1)",
            *((a - b) / self.mass for a, b in zip(left, right, strict=True)),
        )
        points = self.points(motion)
        if phase.legs[0] is Contact.HEEL:
            pressure = pressure_moment(points[0], moments[0].ankle, reactions[0])
            edges = c.eq9_pressure(Contact.HEEL, self.prints[0], pressure, reactions[0])
            terms.equal("centre of pressure (9)", edges[0])
        if phase.legs[0] is Contact.FOREFOOT:
            balance = foot_balance(points[0], moments[0].ankle, moments[0].metatarsal, reactions[0])
            terms.equal("foot (1)", balance)
        if phase.legs[1] is Contact.TOE:
            self._toe_phase_rows(terms, instant, points[1], moments[1], reactions[1])
        self.fittings.equations(terms, phase, instant, motion)
        charge_own_moments(self, terms, phase, instant, motion)
        if "foot_2" in instant.coordinates:
            acceleration = instant.coordinates["foot_2"].acceleration
            terms.integrand = terms.integrand + self.small.swing_foot * acceleration**2
        return terms

    def _toe_phase_rows(
        self, terms: Terms, instant: Instant, points: LegPoints, moments: LegMoments, reaction: Any
    ) -> None:
        """Trailing foot: load through the toe tip, or through the moving point of (12)."""
        x_r = self.prints[1].toe_tip
        if self.linear_sharing:
            shift, share = (instant.coordinates[name] for name in SHARING)
            x_r = x_r + shift.value
            terms.equal("sharing (12)", (reaction[0] - share.value) / FORCE)
            terms.equal("sharing (12)", shift.acceleration, share.acceleration)
            if frees_toes(self.problem):
                room = shift.value + self.legs[1].toe_length
                terms.nonnegative("sharing (12)", room / METRE)
        terms.equal("foot (1)", foot_balance(points, moments.ankle, moments.metatarsal, reaction))
        terms.equal("foot (1)", toe_balance(points, moments.metatarsal, reaction, x_r))
        self.toe_contact_rows(terms, points)

    def toe_contact_rows(self, terms: Terms, points: LegPoints) -> None:
        """(4): the toe tip of leg 2 rests."""
        rest = c.eq4_resting_point(Contact.TOE, points, self.prints[1])
        terms.equal("toe contact (4)", *(e / METRE for e in rest[:2]), *rest[2:])

    def moments(
        self, phase: Phase, instant: Instant, motion: BodyMotion
    ) -> tuple[LegMoments, LegMoments]:
        """Joint moments of both legs per kg, the walker's own and those of devices.

        A massless foot in swing bears none.
        """
        own = self.own_moments(instant)
        if not self.fittings.devices:
            return own
        devices = self.fittings.at(phase, instant, motion)
        one, two = (
            LegMoments(
                *(
                    getattr(own[i], joint) + devices[i].get(joint, 0.0)
                    if joint in LOADED_JOINTS[contact]
                    else 0.0
                    for joint in JOINTS
                )
            )
            for i, contact in enumerate(phase.legs)
        )
        return one, two

    def own_moments(self, instant: Instant) -> tuple[LegMoments, LegMoments]:
        """The walker's own moments of both legs per kg; those that do not occur are zero."""
        one, two = (
            LegMoments(*(instant.controls.get(f"{joint}_{i}", 0.0) for joint in JOINTS))
            for i in (1, 2)
        )
        return one, two

    def reactions(self, instant: Instant) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """Ground reactions of both legs per kg."""
        z = instant.algebraics
        one, two = ((z.get(f"reaction_x_{i}", 0.0), z.get(f"reaction_y_{i}", 0.0)) for i in (1, 2))
        return one, two

    def toe_off(self, contact: Contact, instant: Instant) -> Terms:
        """(4), (7) at toe-off of leg 2: toe tip at rest, toes and their rate in line."""
        terms = Terms()
        motion = self.motion(Phase((contact, Contact.SWING), "", ""), instant)
        self.toe_contact_rows(terms, self.points(motion)[1])
        return terms

    def landing(self, instant: Instant) -> Terms:
        """(5) at T/2."""
        terms = Terms()
        motion = self.motion(Phase((Contact.FOREFOOT, Contact.SWING), "", ""), instant)
        rest = c.eq5_landing(self.points(motion)[1], self.steps.ahead)
        terms.equal("landing (5)", *(e / METRE for e in rest[:2]), *rest[2:])
        return terms


SHARING = ("pressure_shift", "reaction_share")
"""The two lines of (12): from the toe tip to the centre of pressure [m], and R_2x per kg."""


def _rotation(state: State) -> Rotation:
    return Rotation(state.value, state.rate, state.acceleration)


def _scaled(factor: float, vector: Vector) -> Vector:
    return factor * vector[0], factor * vector[1]
