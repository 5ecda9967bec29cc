"""Forces by inverse dynamics: what the motion and a closure of double support determine.

Single support has as many equations as unknowns. In double support (12) gives R_2x, a line in
time from its value at heel contact to zero at toe-off, and with :attr:`DoubleSupport.LINEAR` also
x_R2, a line to the toe tip; by default x_R2 = x_T, the only point of the foot that touches the
ground. One force is left, R_2y: while leg 1 stands on its heel it is the one for which
x_R1 = x_H, an affine equation. If toe-off comes after the foot is flat, R_2y runs from its last
value linearly to zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ergowalk.body import Body
from ergowalk.gait.rhythm import Contact
from ergowalk.mechanics.dynamics import (
    Coefficients,
    LegMoments,
    joint_moments_from,
    total_reaction,
)
from ergowalk.mechanics.foot import (
    ankle_moment_under,
    metatarsal_moment_under,
    pressure_moment,
)
from ergowalk.mechanics.kinematics import BodyMotion, LegPoints, Vector


@dataclass(frozen=True)
class Forces:
    """Moments [N m], reactions [N] and x_R R_y [N m] of both legs at one instant."""

    moments: tuple[LegMoments, LegMoments]
    reactions: tuple[Vector, Vector]
    pressure_moment: Any


def forces(
    c: Coefficients,
    motion: BodyMotion,
    points: tuple[LegPoints, LegPoints],
    trailing: Vector,
    pressure: Any,
) -> Forces:
    """Everything else, the force ``trailing`` [N] under leg 2 at ``pressure`` [m] being given."""
    total = total_reaction(c, motion)
    one = (total[0] - trailing[0], total[1] - trailing[1])
    p_2 = ankle_moment_under(points[1], trailing, pressure)
    w_2 = metatarsal_moment_under(points[1], trailing, pressure)
    first, second = joint_moments_from(c, motion, (one, trailing), p_2)
    under = pressure_moment(points[0], first[2], one)
    x_m, y_m = points[0].metatarsal.position
    w_1 = x_m * one[1] - y_m * one[0] - under
    return Forces((LegMoments(*first, w_1), LegMoments(*second, w_2)), (one, trailing), under)


def share_on_heel(
    body: Body,
    c: Coefficients,
    motion: BodyMotion,
    points: tuple[LegPoints, LegPoints],
    force_x: Any,
    pressure: Any,
    heel: float,
) -> Any:
    """R_2y [N] for which the centre of pressure of leg 1 is its heel: root of an affine line."""
    weight = body.total_mass * body.gravity_m_s2

    def miss(force_y: Any) -> Any:
        found = forces(c, motion, points, (force_x, force_y), pressure)
        return found.pressure_moment - heel * found.reactions[0][1]

    none = miss(0.0)
    return -weight * none / (miss(weight) - none)


WORKING_JOINTS = {
    Contact.SWING: 2,
    Contact.HEEL: 3,
    Contact.FLAT: 3,
    Contact.FOREFOOT: 4,
    Contact.TOE: 4,
}
"""How many of hip, knee, ankle, metatarsal joint can do work in each contact."""
