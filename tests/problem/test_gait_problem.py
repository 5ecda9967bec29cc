"""Problem A as a value: what may stand in it, and what follows from it."""

from __future__ import annotations

import re

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.errors import CorridorError, InputError, ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM, PhaseOrder, Rhythm, boundary_fractions
from ergowalk.problem import (
    Corridors,
    GaitProblem,
    JointBounds,
    Limits,
    Objective,
    RhythmBounds,
)

fractions = st.floats(0.001, 0.499)
pairs = st.tuples(fractions, fractions).map(lambda pair: tuple(sorted(pair)))
instants = fractions | pairs


@st.composite
def rhythms(draw):
    """Any bounds that inequality (3) leaves room for."""
    toe_off = draw(instants)
    shifted = tuple(0.5 + x for x in toe_off) if isinstance(toe_off, tuple) else 0.5 + toe_off
    fields = {"heel_end": draw(instants), "heel_off": draw(instants), "toe_off": shifted}
    try:
        return RhythmBounds(**fields)
    except InputError:
        assume(False)


def problem(**changes):
    return GaitProblem(**{"step_length_m": 0.76, "stride_time_s": 1.14, **changes})


def test_problems_are_equal_by_value_and_cannot_be_changed():
    assert problem() == problem()
    assert problem() != problem(stride_time_s=1.15)
    with pytest.raises(ValueError, match="frozen"):
        problem().stride_time_s = 2.0


def test_replace_validates_anew():
    assert problem().replace(stride_time_s=1.0).stride_time_s == 1.0
    with pytest.raises(ProblemError, match=r"stride_time_s = -1\.0: .*greater than 0"):
        problem().replace(stride_time_s=-1.0)


@given(rhythms())
def test_the_search_starts_inside_the_bounds_and_in_order(bounds):
    start = bounds.start()
    for name in ("heel_end", "heel_off", "toe_off"):
        low, high = bounds.bounds(name)
        assert low <= getattr(start, name) <= high
    assert 0 < start.heel_end < start.heel_off < 0.5
    assert 0 < start.other_toe_off < start.heel_off


def test_the_search_starts_at_the_printed_rhythm_where_that_is_allowed():
    assert RhythmBounds().start() == PRINTED_RHYTHM


@given(rhythms())
def test_at_least_one_phase_order_is_left(bounds):
    assert bounds.orders()
    assert set(bounds.orders()) <= set(PhaseOrder)


@given(rhythms())
def test_a_fixed_rhythm_has_the_order_of_its_instants(bounds):
    start = bounds.start()
    fixed = RhythmBounds(heel_end=start.heel_end, heel_off=start.heel_off, toe_off=start.toe_off)
    assert fixed.fixed
    assert fixed.start() == start
    assert fixed.orders() == (start.order,)


@given(rhythms(), st.sampled_from(PhaseOrder))
def test_an_order_that_the_bounds_exclude_is_refused(bounds, order):
    if order in bounds.orders():
        assert bounds.replace(order=order).orders() == (order,)
    else:
        with pytest.raises(ProblemError, match=r"order = .*contradicts heel_end.*'best'"):
            bounds.replace(order=order)


def test_free_bounds_are_not_fixed():
    assert not RhythmBounds().fixed
    assert not RhythmBounds(heel_end=0.1, heel_off=0.23).fixed


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        ({"heel_end": 0.0}, r"heel_end = 0\.0: must lie between 0\.0 and 0\.5"),
        ({"heel_off": 0.5}, r"heel_off = 0\.5: must lie between 0\.0 and 0\.5"),
        ({"toe_off": 0.5}, r"toe_off = 0\.5: must lie between 0\.5 and 1\.0"),
        ({"toe_off": (0.6, 0.55)}, "toe_off = .*lower bound first"),
        ({"heel_end": 0.3, "heel_off": 0.3}, "heel_end = 0.3: foot-flat must come before heel-off"),
        ({"toe_off": 0.7, "heel_off": (0.1, 0.19)}, "toe_off = 0.7: the other leg must leave"),
        ({"order": "flat-first", "heel_end": 0.1, "toe_off": 0.58}, "order = 'flat-first'"),
        ({"order": "toe-off-first", "heel_end": 0.1, "toe_off": 0.65}, "order = 'toe-off-first'"),
    ],
)
def test_a_rhythm_out_of_order_is_refused(fields, match):
    with pytest.raises(ProblemError, match=match):
        RhythmBounds(**fields)


def test_the_printed_rhythm_has_the_boundaries_of_section_5():
    assert boundary_fractions(PRINTED_RHYTHM) == pytest.approx(
        {
            "heel_contact": 0.0,
            "other_toe_off": 0.08,
            "heel_end": 0.1,
            "heel_off": 0.23,
            "half_stride": 0.5,
        }
    )


def test_limits_stand_in_one_sentence():
    assert Limits().sentence() == (
        "R_y <= 1.3 body weights, |R_x| <= 0.6 R_y, "
        "moment rate <= 25 N m/(kg s) at hip, knee, ankle"
    )
    off = Limits(
        vertical_reaction_body_weights="off",
        friction_coefficient="off",
        moment_rate_nm_per_kg_s=JointBounds(),
    )
    assert off.sentence() == "no limits"
    strong = off.replace(moment_nm_per_kg=JointBounds(hip=2.0, ankle=2.5))
    assert strong.sentence() == "moment <= 2 N m/kg at hip, moment <= 2.5 N m/kg at ankle"


def test_only_a_bound_or_a_cost_on_all_moment_rates_makes_the_problem_well_posed():
    assert Limits().bounds_moment_rate
    some = Limits(moment_rate_nm_per_kg_s=JointBounds(hip=25.0, knee=25.0))
    assert not some.bounds_moment_rate
    assert not some.replace(moment_nm_per_kg=JointBounds(ankle=2.0)).bounds_moment_rate
    assert not problem(limits=some).well_posed
    assert problem(limits=some, objective=Objective(moment_rate_squared_s3_per_m2=0.01)).well_posed


def test_a_step_beyond_the_legs_is_refused():
    with pytest.raises(ProblemError, match=r"out of reach: these legs span at most 2\.69 m"):
        problem(step_length_m=2.7)
    legs = Body(thigh_length_m=0.2, shank_length_m=0.3, thigh_com_m=0.1, shank_com_m=0.1)
    with pytest.raises(ProblemError, match=r"step_length_m = 1\.8: out of reach"):
        problem(step_length_m=1.8, body=legs)


def test_legs_that_differ_need_the_whole_stride_and_equal_pairs_do_not():
    equal = problem(body=Body(foot_mass_kg=(1.2, 1.2)))
    assert equal.body.leg(1).foot_mass == 1.2
    assert not equal.full_stride
    assert problem(body={"foot_mass_kg": (1.2, 1.3)}).full_stride
    assert problem(devices={"leg_2": {"knee": {"kind": "free"}}}).full_stride
    assert problem(stride={"legs": "each"}).full_stride
    with pytest.raises(ProblemError, match=r"stride\.legs = 'mirrored': the legs differ"):
        problem(body={"foot_mass_kg": (1.2, 1.3)}, stride={"legs": "mirrored"})


def test_what_is_said_of_one_leg_holds_for_that_leg_alone():
    both = problem(
        limits={"friction_coefficient": 0.5, "leg_2": {"moment_nm_per_kg": {"ankle": 1.2}}},
        rhythm={"leg_1": {"toe_off": 0.6}},
        corridors={"leg_2": {"ankle_width_sd": "off"}},
        devices={"hip": {"kind": "free"}, "leg_1": {"hip": {"kind": "locked"}}},
    )
    assert [both.limits_of(leg).moment_nm_per_kg.ankle for leg in (0, 1)] == ["off", 1.2]
    assert [both.limits_of(leg).friction_coefficient for leg in (0, 1)] == [0.5, 0.5]
    assert both.limits_of(1).moment_rate_nm_per_kg_s.ankle == 25.0
    assert [both.rhythm_of(leg).bounds("toe_off") for leg in (0, 1)] == [(0.6, 0.6), (0.52, 0.66)]
    assert [both.corridors_of(leg).width("ankle") for leg in (0, 1)] == [1.0, None]
    kinds = [dict(both.devices_of(leg))["hip"].kind for leg in (0, 1)]
    assert kinds == ["locked", "free"]
    assert both.limits_of(0) == both.mirrored().limits
    assert not both.mirrored().legs_differ


def test_exchanging_the_legs_twice_changes_nothing():
    both = problem(
        body={"foot_mass_kg": (1.2, 1.3)},
        rhythm={"leg_1": {"toe_off": 0.6}},
        stride={"step_length_asymmetry": (-0.02, 0.1)},
    )
    other = both.exchanged()
    assert other.body.foot_mass_kg == (1.3, 1.2)
    assert other.rhythm_of(1).bounds("toe_off") == (0.6, 0.6)
    assert other.stride.bounds("length") == (-0.1, 0.02)
    assert other.exchanged() == both


def test_corridors_follow_source_and_width():
    one = problem().angle_corridors()
    two = problem(corridors=Corridors(width_sd=2.0)).angle_corridors()
    assert list(one) == ["hip", "knee", "ankle"]
    for joint in one:
        width = one[joint].upper(0.3) - one[joint].lower(0.3)
        assert two[joint].upper(0.3) - two[joint].lower(0.3) == pytest.approx(2 * width)
    slow = problem(corridors=Corridors(source="winter-slow")).angle_corridors()
    assert slow["hip"].mean(0.3) != one["hip"].mean(0.3)


def test_a_missing_table_is_told_when_it_is_needed(tmp_path):
    lost = problem(corridors=Corridors(source="lost.csv"), folder=tmp_path)
    with pytest.raises(CorridorError, match=re.escape("corridors.source = 'lost.csv': cannot be")):
        lost.human()


def test_rhythms_know_their_order():
    assert PRINTED_RHYTHM.order is PhaseOrder.TOE_OFF_FIRST
    assert Rhythm(0.078, 0.233, 0.618).order is PhaseOrder.FLAT_FIRST
