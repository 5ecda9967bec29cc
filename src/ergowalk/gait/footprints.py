"""Where the feet stand: the abscissas of (4) and (5), with leg 1's heel at the origin."""

from __future__ import annotations

from dataclasses import dataclass

from ergowalk.body import LegParameters


@dataclass(frozen=True)
class Footprint:
    """Abscissas [m] of heel, metatarsal joint and toe tip of a flat foot: x_h0, x_m0, x_t0."""

    heel: float
    metatarsal: float
    toe_tip: float


def footprint(leg: LegParameters, heel: float) -> Footprint:
    """The print of a foot whose heel landed at ``heel`` [m]; below (4)."""
    metatarsal = heel + leg.heel_to_metatarsal
    return Footprint(heel, metatarsal, metatarsal + leg.toe_length)


def leading_print(leg: LegParameters) -> Footprint:
    """Leg 1 in [0, T/2]: heel at 0, (5)."""
    return footprint(leg, 0.0)


def trailing_print(leg: LegParameters, step_length: float) -> Footprint:
    """Leg 2 at t = 0: one step behind, x_m2(0) = -L + l_h, (5)."""
    return footprint(leg, -step_length)
