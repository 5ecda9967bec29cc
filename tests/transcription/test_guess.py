"""Where the search begins: a rhythm between its bounds, in the asked order, with room."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.gait.rhythm import (
    PRINTED_RHYTHM,
    PhaseOrder,
    Rhythm,
    boundary_fractions,
    half_stride_phases,
)
from ergowalk.problem import RhythmBounds, preset
from ergowalk.transcription.guess import SHORTEST_START, starting_rhythm

PROBLEM = preset("berbyuk2002")
NAMES = ("heel_end", "heel_off", "toe_off")
EDGE = 1e-6  # bounds lie strictly inside 0 ... 0.5
ROUNDING = 1e-12  # fractions of T

LAW = settings(deadline=None, max_examples=200, derandomize=True, database=None)


@st.composite
def instants(draw: st.DrawFn, earliest: float, latest: float) -> float | tuple[float, float]:
    """One number or a pair of bounds, often close together or near an end of the range."""
    near_end = st.floats(0.0, 0.03).flatmap(lambda d: st.sampled_from([earliest + d, latest - d]))
    low = min(max(draw(st.floats(earliest, latest) | near_end), earliest), latest)
    if draw(st.booleans()):
        return low
    width = draw(st.floats(0.0, 0.02) | st.floats(0.0, 0.5))
    return low, min(low + width, 0.5 - EDGE)


@st.composite
def admissible(draw: st.DrawFn) -> tuple[RhythmBounds, PhaseOrder]:
    """Bounds that a problem may have, and an order that they leave room for."""
    heel_off = draw(instants(2 * EDGE, 0.5 - EDGE))
    latest = (heel_off[1] if isinstance(heel_off, tuple) else heel_off) - EDGE
    toe_off = draw(instants(EDGE, latest))
    bounds = RhythmBounds(
        heel_end=draw(instants(EDGE, latest)),
        heel_off=heel_off,
        toe_off=later(toe_off),
    )
    return bounds, draw(st.sampled_from(bounds.orders()))


def later(instant: float | tuple[float, float]) -> float | tuple[float, float]:
    """The same half a stride later."""
    if isinstance(instant, tuple):
        return 0.5 + instant[0], 0.5 + instant[1]
    return 0.5 + instant


@st.composite
def roomy(draw: st.DrawFn) -> tuple[RhythmBounds, PhaseOrder, Rhythm]:
    """Bounds whose point nearest to the printed rhythm has room for every phase of an order."""
    order = draw(st.sampled_from(PhaseOrder))
    room = SHORTEST_START + 1e-9
    cuts = sorted(draw(st.floats(0.0, 0.5 - 4 * room)) for _ in range(3))
    first, second, heel_off = (cut + k * room for k, cut in enumerate(cuts, start=1))
    if order is PhaseOrder.TOE_OFF_FIRST:
        nearest = Rhythm(second, heel_off, 0.5 + first)
    else:
        nearest = Rhythm(first, heel_off, 0.5 + second)
    bounds: dict[str, tuple[float, float]] = {}
    for name, last in zip(NAMES, (0.5, 0.5, 1.0), strict=True):
        instant, printed = getattr(nearest, name), getattr(PRINTED_RHYTHM, name)
        away = instant + draw(st.floats(0.0, 0.999)) * (
            (last if instant > printed else last - 0.5) - instant
        )
        bounds[name] = (min(instant, away), max(instant, away))
    return RhythmBounds(**bounds), order, nearest


def started(bounds: RhythmBounds, order: PhaseOrder) -> Rhythm:
    return starting_rhythm(PROBLEM.replace(rhythm=bounds), order)


def chain(rhythm: Rhythm, order: PhaseOrder) -> list[float]:
    """The five instants that bound the phases of an order, in its sequence."""
    at = boundary_fractions(rhythm)
    return [0.0, *(at[phase.end] for phase in half_stride_phases(order))]


def lengths(rhythm: Rhythm, order: PhaseOrder) -> list[float]:
    """Durations of the four phases of an order, negative where an instant comes too early."""
    return [later - earlier for earlier, later in pairwise(chain(rhythm, order))]


@LAW
@given(admissible())
def test_every_instant_lies_between_its_bounds(case: tuple[RhythmBounds, PhaseOrder]) -> None:
    bounds, order = case
    start = started(bounds, order)
    for name in NAMES:
        low, high = bounds.bounds(name)
        assert low <= getattr(start, name) <= high


@LAW
@given(admissible())
def test_instants_stand_in_the_asked_order(case: tuple[RhythmBounds, PhaseOrder]) -> None:
    bounds, order = case
    start = started(bounds, order)
    assert min(lengths(start, order)) >= 0.0
    assert start.order is order


@LAW
@given(admissible())
def test_a_phase_is_short_only_where_its_bounds_leave_no_more(
    case: tuple[RhythmBounds, PhaseOrder],
) -> None:
    """A short phase lies between an instant at its lower bound and one at its upper bound, and
    no phase between these is longer: it could gain only from one that is as short or shorter."""
    bounds, order = case
    start = started(bounds, order)
    low, high = (
        chain(Rhythm(*(bounds.bounds(name)[side] for name in NAMES)), order) for side in (0, 1)
    )
    at, rooms = chain(start, order), lengths(start, order)
    for k, room in enumerate(rooms):
        assert room >= SHORTEST_START - ROUNDING or any(
            at[first] - low[first] <= ROUNDING
            and high[last] - at[last] <= ROUNDING
            and max(rooms[first:last]) <= room + ROUNDING
            for first in range(k + 1)
            for last in range(k + 1, len(at))
        )


@LAW
@given(roomy())
def test_what_has_room_is_not_moved(case: tuple[RhythmBounds, PhaseOrder, Rhythm]) -> None:
    bounds, order, nearest = case
    assert started(bounds, order) == nearest


@pytest.mark.parametrize(
    "bounds",
    [
        RhythmBounds(),
        RhythmBounds(heel_end=0.1, heel_off=0.23, toe_off=0.58),
        RhythmBounds(heel_end=(0.09, 0.1), heel_off=(0.2, 0.499), toe_off=(0.58, 0.7)),
    ],
    ids=["default", "fixed", "at the edge"],
)
def test_the_printed_rhythm_has_room(bounds: RhythmBounds) -> None:
    assert started(bounds, PhaseOrder.TOE_OFF_FIRST) == PRINTED_RHYTHM


def test_a_late_heel_off_leaves_room_for_the_last_phase() -> None:
    """Foot-flat after the printed heel-off: the search begins with heel-off as late as it may."""
    bounds = RhythmBounds(heel_end=(0.3, 0.35), heel_off=(0.05, 0.4999))
    start = started(bounds, PhaseOrder.TOE_OFF_FIRST)
    assert start.heel_off == pytest.approx(0.5 - SHORTEST_START, abs=ROUNDING)
    assert start.heel_end == 0.3


def test_phases_share_the_little_that_narrow_bounds_leave() -> None:
    """Foot-flat and heel-off both after 0.48: two phases in the last 2 % of T, one of 48 %."""
    bounds = RhythmBounds(heel_end=(0.48, 0.499), heel_off=(0.48, 0.4999))
    start = started(bounds, PhaseOrder.TOE_OFF_FIRST)
    assert (start.heel_end, start.heel_off) == pytest.approx((0.48, 0.49), abs=ROUNDING)
    assert start.other_toe_off == pytest.approx(0.08, abs=ROUNDING)


def test_a_phase_without_room_takes_none_from_the_others() -> None:
    """Toe-off and foot-flat held 0.2 % of T apart, heel-off wanted 1 % later and free to wait."""
    bounds = RhythmBounds(toe_off=0.718, heel_end=0.22, heel_off=(0.05, 0.4))
    start = started(bounds, PhaseOrder.TOE_OFF_FIRST)
    assert lengths(start, PhaseOrder.TOE_OFF_FIRST)[1:3] == pytest.approx(
        [0.002, SHORTEST_START], abs=ROUNDING
    )
