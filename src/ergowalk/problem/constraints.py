"""Constraints (2)-(9) and the physical limits, one function per equation.

Each function returns expressions and says what must hold of them; they take numbers, NumPy arrays
or CasADi symbols. Leg 1 leads in [0, T/2], leg 2 trails; (2) and (7) for the second half follow
from the exchange of the legs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ergowalk.body import LegParameters
from ergowalk.gait.footprints import Footprint
from ergowalk.gait.rhythm import Contact, PhaseOrder
from ergowalk.mechanics.kinematics import LegMotion, LegPoints, Vector

SHORTEST_PHASE = 0.005
"""Shortest phase that the transcriptions allow, as a fraction of T."""


def eq2_exchange(coordinates: tuple[str, ...]) -> dict[str, str]:
    """(2) with mirrored legs: which quantity at T/2 is which at 0.

    The state of leg 1 at half stride is that of leg 2 at the start, and the other way round;
    values and rates alike. Names end in "_1" or "_2", or belong to the trunk.
    """
    swap = {"_1": "_2", "_2": "_1"}
    return {name: name[:-2] + swap.get(name[-2:], name[-2:]) for name in coordinates}


def eq3_rhythm_order(order: PhaseOrder) -> tuple[tuple[str, str], ...]:
    """(3) as pairs (earlier, later) of boundary names of the half stride.

    tau_1^h <= tau_1^m and tau_2^s <= tau_1^m; the phase order decides between tau_1^h and tau_2^s.
    """
    if order is PhaseOrder.TOE_OFF_FIRST:
        middle = ("other_toe_off", "heel_end")
    else:
        middle = ("heel_end", "other_toe_off")
    return (
        ("heel_contact", middle[0]),
        middle,
        (middle[1], "heel_off"),
        ("heel_off", "half_stride"),
    )


def eq4_resting_point(contact: Contact, points: LegPoints, print_: Footprint) -> tuple[Any, ...]:
    """(4), equalities: position [m] and velocity [m/s] of the resting point minus what they
    must be; all zero. Heel phase: H; flat and forefoot: M; toe phase: T; swing: none."""
    if contact is Contact.SWING:
        return ()
    point, place = {
        Contact.HEEL: (points.heel, print_.heel),
        Contact.FLAT: (points.metatarsal, print_.metatarsal),
        Contact.FOREFOOT: (points.metatarsal, print_.metatarsal),
        Contact.TOE: (points.toe_tip, print_.toe_tip),
    }[contact]
    return (point.position[0] - place, point.position[1], *point.velocity)


def eq4_clearances(contact: Contact, points: LegPoints) -> tuple[Any, ...]:
    """(4), inequalities: heights [m] of the points that must not be below the ground.

    Where the toes are in line with the sole, its ends (or the free end) say everything.
    """
    heel, metatarsal, toe_tip = (
        p.position[1] for p in (points.heel, points.metatarsal, points.toe_tip)
    )
    return {
        Contact.SWING: (heel, toe_tip),
        Contact.HEEL: (metatarsal,),
        Contact.FLAT: (),
        Contact.FOREFOOT: (heel,),
        Contact.TOE: (heel, metatarsal),
    }[contact]


def eq5_landing(points: LegPoints, step_length: float) -> tuple[Any, ...]:
    """(5) at T/2: the swinging heel is at (L, 0), at rest (walking without impact); all zero."""
    return (points.heel.position[0] - step_length, points.heel.position[1], *points.heel.velocity)


def eq6_corridor_position(angle: Any, middle: Any, half_width: Any) -> Any:
    """(6): place of a joint angle [rad] in its corridor, -1 at the lower and 1 at the upper edge.

    ``middle`` is the human mean and ``half_width`` the width of the corridor times the standard
    deviation [rad], both at the same instant.
    """
    return (angle - middle) / half_width


def eq7_toe_rotation(contact: Contact, leg: LegParameters, motion: LegMotion) -> Any:
    """(7), inequality of the toe phase: epsilon - gamma - phi_m >= 0 [rad].

    In the other phases (7) is an identity, :func:`eq7_toes_angle`.
    """
    if contact is not Contact.TOE:
        raise ValueError(f"toes bend in the toe phase only, not in {contact.name}")
    return motion.toes.angle - motion.foot.angle - leg.foot_angle


def eq7_toes_in_line(contact: Contact) -> bool:
    """(7), identities: whether the toes are in line with the sole (heel phase and swing)."""
    return contact in (Contact.HEEL, Contact.SWING)


def eq8_vertical_reaction(reaction: Vector) -> Any:
    """(8): R_y >= 0 [N]; the ground does not hold the foot down."""
    return reaction[1]


def eq9_pressure_edges(contact: Contact, print_: Footprint) -> tuple[float, float]:
    """(9): first and last abscissa [m] between which the centre of pressure must be.

    Heel phase: the heel; flat: heel to metatarsal joint; forefoot: metatarsal joint to toe tip;
    toe phase: the toe tip, the only point that touches the ground (the paper allows the whole
    length of the toes there).
    """
    return {
        Contact.HEEL: (print_.heel, print_.heel),
        Contact.FLAT: (print_.heel, print_.metatarsal),
        Contact.FOREFOOT: (print_.metatarsal, print_.toe_tip),
        Contact.TOE: (print_.toe_tip, print_.toe_tip),
    }[contact]


def eq9_pressure(
    contact: Contact, print_: Footprint, pressure_moment: Any, reaction: Vector
) -> tuple[Any, Any]:
    """(9) times R_y: (x_R - first) R_y >= 0 and (last - x_R) R_y >= 0 [N m].

    The product stays finite where the reaction vanishes; where both edges coincide it is zero.
    """
    first, last = eq9_pressure_edges(contact, print_)
    return pressure_moment - first * reaction[1], last * reaction[1] - pressure_moment


def limit_friction(reaction: Vector, coefficient: float) -> tuple[Any, Any]:
    """Friction cone: mu R_y - R_x >= 0 and mu R_y + R_x >= 0 [N]."""
    return coefficient * reaction[1] - reaction[0], coefficient * reaction[1] + reaction[0]


def fixed_at_boundaries(flat: float) -> Mapping[tuple[str, str, str], float]:
    """Values that (4), (8), (9) fix at phase boundaries: (boundary, name, kind) -> number.

    The sole is flat and at rest at foot-flat and heel-off (``flat`` = pi/2 - phi_m). A massless
    swing foot carries no moment, so p_1 = 0 at heel contact and p_2 = w_2 = 0 at toe-off; the
    load reaches the metatarsal joint at heel-off, so w_1 = 0 there.
    """
    return {
        ("heel_end", "foot_1", "value"): flat,
        ("heel_end", "foot_1", "rate"): 0.0,
        ("heel_off", "foot_1", "value"): flat,
        ("heel_off", "foot_1", "rate"): 0.0,
        ("heel_off", "metatarsal_1", "control"): 0.0,
        ("heel_contact", "ankle_1", "control"): 0.0,
        ("other_toe_off", "ankle_2", "control"): 0.0,
        ("other_toe_off", "metatarsal_2", "control"): 0.0,
    }
