"""Inverse dynamics of a half stride: moments, reactions and centre of pressure from the motion.

In single support the motion determines everything. In double support the force under the
trailing foot is given; where both feet touch in a point, its vertical part is not free either.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.gait.footprints import leading_print
from ergowalk.gait.rhythm import Contact
from ergowalk.mechanics.dynamics import (
    LegMoments,
    coefficients,
    joint_moments_from,
    total_reaction,
)
from ergowalk.mechanics.foot import (
    ankle_moment_under,
    metatarsal_moment_under,
    pressure_moment,
)
from ergowalk.mechanics.kinematics import BodyMotion, Vector, leg_points

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sharing:
    """What the trailing foot carries in double support, zero in swing.

    ``force_x``, ``force_y`` [N] and the abscissa ``pressure`` [m] where they act; arrays (n,).
    """

    force_x: Array
    force_y: Array
    pressure: Array


@dataclass(frozen=True)
class Loads:
    """Moments [N m], reactions [N] and centres of pressure [m] of both legs, arrays (n,).

    A centre of pressure is NaN in swing and where the vertical reaction is exactly zero.
    """

    moments: tuple[LegMoments, LegMoments]
    reactions: tuple[Vector, Vector]
    pressures: tuple[Array, Array]


def inverse_dynamics(
    body: Body, motion: BodyMotion, contacts: tuple[Contact, Contact], sharing: Sharing
) -> Loads:
    """Loads of one phase that satisfy (1) to rounding.

    Parameters
    ----------
    motion : BodyMotion
        Arrays (n,); leg 1 leads and stands on its print at the origin.
    sharing : Sharing
        In heel+toe support ``force_y`` is replaced by :func:`vertical_share`.
    """
    if contacts == (Contact.HEEL, Contact.TOE):
        two = (sharing.force_x, sharing.force_y)
        force_y = vertical_share(body, motion, two, sharing.pressure)
        sharing = Sharing(sharing.force_x, force_y, sharing.pressure)
    return _loads(body, motion, contacts, sharing)


FIRM = 0.5
"""Load on the leading heel, in body weights, from which its centre of pressure takes the error."""


def vertical_share(body: Body, motion: BodyMotion, trailing: Vector, pressure: Any) -> Any:
    """Vertical force [N] under the trailing toe while both feet touch in a point.

    A motion between the nodes of a transcription has no force that puts both centres of pressure
    exactly on their points and also joins smoothly. While the leading heel bears little, the
    force is the only one for which its pressure is at the heel; the more it bears, the closer to
    the given ``trailing`` force (x, y) [N], since then the pressure hardly moves. The error shows
    in the centre of pressure, far below a millimetre on a sound mesh.

    The moment of all ground forces about the origin does not depend on how the legs share them,
    so the force is a ratio of lever arms. Numbers, arrays or CasADi symbols; the force acts at
    ``pressure`` [m].
    """
    c, heel = coefficients(body), leading_print(body.leg(0)).heel
    total = total_reaction(c, motion)
    leading = leg_points(body.leg(0), motion.legs[0], motion.hip)
    (_, _, ankle), _ = joint_moments_from(c, motion, (total, (0.0, 0.0)), 0.0)
    moment = pressure_moment(leading, ankle, total)
    miss = moment - pressure * trailing[1] - heel * (total[1] - trailing[1])
    load = (total[1] - trailing[1]) / (body.total_mass * body.gravity_m_s2)
    return trailing[1] + miss / ((pressure - heel) * (1 + (load / FIRM) ** 4))


def _loads(
    body: Body, motion: BodyMotion, contacts: tuple[Contact, Contact], sharing: Sharing
) -> Loads:
    c = coefficients(body)
    total = total_reaction(c, motion)
    two = (sharing.force_x, sharing.force_y)
    one = (total[0] - two[0], total[1] - two[1])
    points = [leg_points(body.leg(i), motion.legs[i], motion.hip) for i in (0, 1)]
    swing = contacts[1] is Contact.SWING
    zero = np.zeros_like(sharing.force_x)
    p_2 = zero if swing else ankle_moment_under(points[1], two, sharing.pressure)
    w_2 = zero if swing else metatarsal_moment_under(points[1], two, sharing.pressure)
    first, second = joint_moments_from(c, motion, (one, two), p_2)
    under = pressure_moment(points[0], first[2], one)
    x_m, y_m = points[0].metatarsal.position
    w_1 = x_m * one[1] - y_m * one[0] - under  # the toe line of (1), also where R_y is zero
    nowhere = np.full_like(zero, np.nan)
    pressure = np.divide(under, one[1], out=nowhere.copy(), where=one[1] != 0)
    return Loads(
        (LegMoments(*first, w_1), LegMoments(*second, w_2)),
        (one, two),
        (pressure, nowhere if swing else sharing.pressure),
    )
