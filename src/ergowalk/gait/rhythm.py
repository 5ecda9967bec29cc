"""Rhythm parameters and the phases of the half stride that follow from them.

The legs mirror each other half a stride apart, so [0, T/2] says everything. Leg 1 lands on its
heel at t = 0; leg 2 starts to turn over its toe tip at the same instant (tau_2^t = T = 0 mod T).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, StrEnum


class Contact(IntEnum):
    """How one leg touches the ground; the integers of ``contact_phase`` in a gait file."""

    SWING = 0
    HEEL = 1
    FLAT = 2
    FOREFOOT = 3
    TOE = 4


class PhaseOrder(StrEnum):
    """What comes first after heel contact: the other leg's toe-off, or the own foot going flat.

    Inequality (3) allows both.
    """

    TOE_OFF_FIRST = "toe-off-first"
    FLAT_FIRST = "flat-first"


@dataclass(frozen=True)
class Rhythm:
    """Instants of leg 1 as fractions of the stride time T.

    ``heel_end`` tau^h, ``heel_off`` tau^m, ``toe_tip_start`` tau^t (half a stride: the other
    leg's heel contact) and ``toe_off`` tau^s of the paper.
    """

    heel_end: float
    heel_off: float
    toe_off: float
    toe_tip_start: float = 0.5

    @property
    def other_toe_off(self) -> float:
        """Toe-off of leg 2 inside the first half stride, tau_2^s / T."""
        return self.toe_off - 0.5

    @property
    def order(self) -> PhaseOrder:
        """Which phase order this rhythm has."""
        first = self.other_toe_off <= self.heel_end
        return PhaseOrder.TOE_OFF_FIRST if first else PhaseOrder.FLAT_FIRST

    def as_dict(self) -> dict[str, float]:
        """The four fractions under the names of the gait file."""
        return {
            "heel_end": self.heel_end,
            "heel_off": self.heel_off,
            "toe_tip_start": self.toe_tip_start,
            "toe_off": self.toe_off,
        }


PRINTED_RHYTHM = Rhythm(heel_end=0.10, heel_off=0.23, toe_off=0.58)
"""The rhythm printed in section 5 of the paper."""


@dataclass(frozen=True)
class Phase:
    """One interval of the half stride in which neither leg changes its contact.

    ``start`` and ``end`` name the rhythm parameters that bound it (:data:`BOUNDARIES`).
    """

    legs: tuple[Contact, Contact]
    start: str
    end: str

    @property
    def name(self) -> str:
        """Contacts of both legs, as in "heel+toe"."""
        return "+".join(contact.name.lower() for contact in self.legs)

    @property
    def double_support(self) -> bool:
        """Whether both legs carry load."""
        return Contact.SWING not in self.legs


BOUNDARIES = ("heel_contact", "heel_end", "other_toe_off", "heel_off", "half_stride")
"""Instants that bound the phases of [0, T/2]."""


def half_stride_phases(order: PhaseOrder) -> tuple[Phase, ...]:
    """The four phases of [0, T/2] in time order, leg 1 leading (section 3, inequality (3))."""
    if order is PhaseOrder.TOE_OFF_FIRST:
        second = Phase((Contact.HEEL, Contact.SWING), "other_toe_off", "heel_end")
    else:
        second = Phase((Contact.FLAT, Contact.TOE), "heel_end", "other_toe_off")
    return (
        Phase((Contact.HEEL, Contact.TOE), "heel_contact", second.start),
        second,
        Phase((Contact.FLAT, Contact.SWING), second.end, "heel_off"),
        Phase((Contact.FOREFOOT, Contact.SWING), "heel_off", "half_stride"),
    )


def boundary_fractions(rhythm: Rhythm) -> dict[str, float]:
    """Each of :data:`BOUNDARIES` as a fraction of T."""
    return {
        "heel_contact": 0.0,
        "heel_end": rhythm.heel_end,
        "other_toe_off": rhythm.other_toe_off,
        "heel_off": rhythm.heel_off,
        "half_stride": 0.5,
    }
