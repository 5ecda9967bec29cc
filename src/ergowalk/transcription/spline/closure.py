"""What the equality constraints (2), (4), (5), (7) say of the data of the splines.

Walked in this order each line knows all it needs: hip and trunk at heel contact, rate of the
rising foot at T/2, thigh of leg 2 at both ends, toe-off, ends of the swing foot.
"""

from __future__ import annotations

from typing import Any, Protocol

from ergowalk.gait.footprints import leading_print, trailing_print
from ergowalk.gait.rhythm import Contact
from ergowalk.mechanics.functions import sin
from ergowalk.mechanics.kinematics import HALF_PI
from ergowalk.problem import GaitProblem
from ergowalk.transcription.spline import motion
from ergowalk.transcription.spline.curves import (
    END_SLOPE,
    FOOT_HEEL,
    FOOT_RISE,
    HIP,
    KNEE,
    START_SLOPE,
    SWING_FOOT,
    THIGH_SWING,
    THIGH_TOE,
    TRUNK,
    Curves,
)
from ergowalk.transcription.spline.jets import Jet, floored

LEAST_LEVER = 0.03
"""Rise of the hip per turn of the foot at T/2 [m] below which its rate is bounded."""


LAST = -3
"""Datum of a clamped spline that is its value at the last knot."""


class Ledger(Protocol):
    """Where the data stand: reads functions, settles data that the constraints determine."""

    def at(self, name: str, time: float) -> Jet:
        """Value and rate of a function."""

    def settle(self, name: str, datum: int, value: Any) -> None:
        """A datum must have this value."""

    @property
    def psi(self) -> Any:
        """Trunk angle at heel contact."""


def settle_all(problem: GaitProblem, curves: Curves, ledger: Ledger) -> Any:
    """Settle every datum that (2), (4), (5), (7) determine; returns what was missing [m]."""
    flat = HALF_PI - problem.body.leg(0).foot_angle
    # the sole lies flat and at rest at foot-flat and at heel-off
    ledger.settle(FOOT_HEEL, LAST, flat)
    ledger.settle(FOOT_HEEL, END_SLOPE, 0.0)
    ledger.settle(FOOT_RISE, 0, flat)
    ledger.settle(FOOT_RISE, START_SLOPE, 0.0)
    missing = _heel_contact(problem, curves, ledger)
    first, last = _exchange(problem, curves, ledger)
    # leg 2 starts as leg 1 ends, and ends as leg 1 starts
    _clamp(ledger, THIGH_TOE, 0, last)
    _clamp(ledger, THIGH_SWING, LAST, first)
    off = _toe_off(problem, curves, ledger, flat)
    _clamp(ledger, THIGH_TOE, LAST, off.thigh)
    _clamp(ledger, THIGH_SWING, 0, off.thigh)
    _swing_foot(problem, curves, ledger, off, first)
    return missing + off.missing


def _heel_contact(problem: GaitProblem, curves: Curves, ledger: Ledger) -> Any:
    """Hip over both legs on their prints, and the trunk above it."""
    leg = problem.body.leg(0)
    front, back = leading_print(leg), trailing_print(leg, problem.step_length_m)
    landing, rising = ledger.at(FOOT_HEEL, 0.0), ledger.at(FOOT_RISE, curves.half)
    knees = ledger.at(KNEE, 0.0), ledger.at(KNEE, curves.half)
    ankles = (
        motion.ankle_over(leg, Contact.HEEL, front, landing),
        motion.ankle_over(leg, Contact.FOREFOOT, back, Jet(rising.value)),
    )
    hip_x, missing = motion.hip_at_contact(leg, knees, ankles)
    ledger.settle(HIP, 0, hip_x)
    ledger.settle(TRUNK, 0, hip_x - problem.body.trunk_com_m * sin(ledger.psi))
    return missing


def _exchange(problem: GaitProblem, curves: Curves, ledger: Ledger) -> tuple[Jet, Jet]:
    """Rate of the rising foot for which the hip's vertical velocity is the same at 0 and T/2;
    returns the thigh of leg 1 at both."""
    leg, half = problem.body.leg(0), curves.half
    front = leading_print(leg)

    def start() -> motion.Standing:
        angles = ledger.at(KNEE, 0.0), ledger.at(HIP, 0.0), ledger.at(FOOT_HEEL, 0.0)
        return motion.standing(leg, Contact.HEEL, front, *angles)

    def end(foot: Jet) -> motion.Standing:
        knee, hip_x = ledger.at(KNEE, half), ledger.at(HIP, half)
        return motion.standing(leg, Contact.FOREFOOT, front, knee, hip_x, foot)

    angle, first = ledger.at(FOOT_RISE, half).value, start()
    still, turning = (end(Jet(angle, rate)).hip.velocity[1] for rate in (0.0, 1.0))
    lever = floored(still - turning, LEAST_LEVER)
    ledger.settle(FOOT_RISE, END_SLOPE, -(first.hip.velocity[1] - still) / lever)
    last = end(ledger.at(FOOT_RISE, half))
    return Jet.of(first.leg.thigh), Jet.of(last.leg.thigh)


def _toe_off(problem: GaitProblem, curves: Curves, ledger: Ledger, flat: float) -> motion.ToeOff:
    """Leg 2 at toe-off, hanging from the hip over leg 1."""
    leg, time = problem.body.leg(0), curves.times["other_toe_off"]
    early = curves.phases[0].end == "other_toe_off"
    contact = Contact.HEEL if early else Contact.FLAT
    foot = ledger.at(FOOT_HEEL, time) if early else Jet(flat)
    knee, hip_x = ledger.at(KNEE, time), ledger.at(HIP, time)
    stance = motion.standing(leg, contact, leading_print(leg), knee, hip_x, foot)
    tip = trailing_print(leg, problem.step_length_m).toe_tip
    return motion.toe_off(leg, stance.hip, ledger.at(KNEE, time + curves.half), tip)


def _swing_foot(
    problem: GaitProblem, curves: Curves, ledger: Ledger, off: motion.ToeOff, landing: Jet
) -> None:
    """Ends of the swing foot, as ankle angles less the human mean half a stride later."""
    leg, half, stride = problem.body.leg(0), curves.half, problem.stride_time_s
    mean = problem.angle_corridors()["ankle"].mean
    time = curves.times["other_toe_off"]

    def ankle(thigh: Jet, knee: Jet, foot: Jet, later: float) -> Jet:
        human = [float(mean(later / stride, d)) / stride**d for d in (0, 1)]
        angle = foot - (thigh - knee) + (leg.foot_angle - HALF_PI)
        return angle - Jet(human[0], human[1])

    at_off = ankle(off.thigh, ledger.at(KNEE, time + half), off.foot, time + half)
    at_landing = ankle(landing, ledger.at(KNEE, 0.0), ledger.at(FOOT_HEEL, 0.0), stride)
    _clamp(ledger, SWING_FOOT, 0, at_off)
    _clamp(ledger, SWING_FOOT, LAST, at_landing)


def _clamp(ledger: Ledger, name: str, datum: int, jet: Jet) -> None:
    """Value and slope of a function at its first (datum 0) or last knot."""
    ledger.settle(name, datum, jet.value)
    ledger.settle(name, START_SLOPE if datum == 0 else END_SLOPE, jet.rate)
