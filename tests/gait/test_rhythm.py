"""Rhythm and phases: (3), in both orders that it allows."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from ergowalk.gait.rhythm import (
    BOUNDARIES,
    PRINTED_RHYTHM,
    Contact,
    Phase,
    PhaseOrder,
    Rhythm,
    boundary_fractions,
    half_stride_phases,
)

LAW = settings(deadline=None, max_examples=100, derandomize=True, database=None)

ORDERS = list(PhaseOrder)

SWING, HEEL, FLAT, FOREFOOT, TOE = Contact


@st.composite
def rhythms(draw: st.DrawFn) -> Rhythm:
    """Any rhythm that (3) allows."""
    heel_off = draw(st.floats(0.02, 0.48))
    early = st.floats(0.001, heel_off)
    return Rhythm(heel_end=draw(early), heel_off=heel_off, toe_off=0.5 + draw(early))


def test_printed_rhythm_is_the_papers() -> None:
    expected = {"heel_end": 0.10, "heel_off": 0.23, "toe_tip_start": 0.5, "toe_off": 0.58}
    assert PRINTED_RHYTHM.as_dict() == expected
    assert PRINTED_RHYTHM.other_toe_off == pytest.approx(0.08)
    assert PRINTED_RHYTHM.order is PhaseOrder.TOE_OFF_FIRST


@pytest.mark.parametrize(
    ("toe_off", "order"),
    [
        (0.58, PhaseOrder.TOE_OFF_FIRST),
        (0.625, PhaseOrder.TOE_OFF_FIRST),
        (0.63, PhaseOrder.FLAT_FIRST),
    ],
)
def test_order_says_what_comes_first_after_heel_contact(toe_off: float, order: PhaseOrder) -> None:
    assert Rhythm(heel_end=0.125, heel_off=0.3, toe_off=toe_off).order is order


def test_toe_off_first_runs_through_the_phases_of_the_paper() -> None:
    phases = half_stride_phases(PhaseOrder.TOE_OFF_FIRST)
    assert [phase.name for phase in phases] == [
        "heel+toe",
        "heel+swing",
        "flat+swing",
        "forefoot+swing",
    ]
    bounds = ["heel_contact", "other_toe_off", "heel_end", "heel_off", "half_stride"]
    assert [*(phase.start for phase in phases), phases[-1].end] == bounds
    assert [phase.double_support for phase in phases] == [True, False, False, False]


def test_flat_first_puts_the_foot_down_before_the_other_leaves() -> None:
    phases = half_stride_phases(PhaseOrder.FLAT_FIRST)
    assert [phase.name for phase in phases] == [
        "heel+toe",
        "flat+toe",
        "flat+swing",
        "forefoot+swing",
    ]
    bounds = ["heel_contact", "heel_end", "other_toe_off", "heel_off", "half_stride"]
    assert [*(phase.start for phase in phases), phases[-1].end] == bounds
    assert [phase.double_support for phase in phases] == [True, True, False, False]


@pytest.mark.parametrize("order", ORDERS)
def test_each_phase_starts_where_the_last_one_ends(order: PhaseOrder) -> None:
    phases = half_stride_phases(order)
    assert phases[0].start == "heel_contact"
    assert phases[-1].end == "half_stride"
    for before, after in itertools.pairwise(phases):
        assert before.end == after.start
    assert {phase.start for phase in phases} | {"half_stride"} == set(BOUNDARIES)


@pytest.mark.parametrize("order", ORDERS)
def test_leading_leg_never_leaves_the_ground_and_rolls_forward(order: PhaseOrder) -> None:
    contacts = [phase.legs[0] for phase in half_stride_phases(order)]
    assert SWING not in contacts
    assert TOE not in contacts  # the toe phase begins when the other heel lands, at T/2
    assert contacts == sorted(contacts)
    assert set(contacts) == {HEEL, FLAT, FOREFOOT}


@pytest.mark.parametrize("order", ORDERS)
def test_trailing_leg_stands_on_its_toe_tip_and_then_swings(order: PhaseOrder) -> None:
    contacts = [phase.legs[1] for phase in half_stride_phases(order)]
    assert contacts == sorted(contacts, reverse=True)
    assert set(contacts) == {TOE, SWING}


@pytest.mark.parametrize("order", ORDERS)
def test_exactly_one_leg_changes_its_contact_between_phases(order: PhaseOrder) -> None:
    phases = half_stride_phases(order)
    for before, after in itertools.pairwise(phases):
        changed = [a is not b for a, b in zip(before.legs, after.legs, strict=True)]
        assert sum(changed) == 1


@LAW
@given(rhythms())
def test_phases_of_a_rhythm_follow_each_other_in_time(rhythm: Rhythm) -> None:
    fractions = boundary_fractions(rhythm)
    assert set(fractions) == set(BOUNDARIES)
    phases = half_stride_phases(rhythm.order)
    times = [fractions[phase.start] for phase in phases] + [fractions[phases[-1].end]]
    for before, after in itertools.pairwise(times):
        assert before <= after + 1e-15  # toe_off - 0.5 is rounded
    assert (times[0], times[-1]) == (0.0, 0.5)
    changes = {"heel_end": rhythm.heel_end, "heel_off": rhythm.heel_off}
    changes["other_toe_off"] = rhythm.toe_off - 0.5
    assert {name: fractions[name] for name in changes} == changes


@LAW
@given(rhythms(), st.floats(0, 0.5))
def test_contact_at_any_instant_is_that_of_the_rhythm(rhythm: Rhythm, instant: float) -> None:
    fractions = boundary_fractions(rhythm)
    assume(min(abs(instant - change) for change in fractions.values()) > 1e-12)
    (phase,) = [
        phase
        for phase in half_stride_phases(rhythm.order)
        if fractions[phase.start] < instant < fractions[phase.end]
    ]
    leading = HEEL if instant < rhythm.heel_end else FLAT
    leading = leading if instant < rhythm.heel_off else FOREFOOT
    trailing = TOE if instant < rhythm.other_toe_off else SWING
    assert phase.legs == (leading, trailing)


def test_contact_integers_are_those_of_the_gait_file() -> None:
    assert [(c.name.lower(), int(c)) for c in Contact] == [
        ("swing", 0),
        ("heel", 1),
        ("flat", 2),
        ("forefoot", 3),
        ("toe", 4),
    ]


def test_name_of_a_phase_says_both_contacts() -> None:
    phase = Phase((Contact.FLAT, Contact.TOE), "heel_end", "other_toe_off")
    assert phase.name == "flat+toe"
    assert phase.double_support
