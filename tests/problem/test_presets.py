"""Presets: the paper's case in three readings, and Winter's three cadences."""

from __future__ import annotations

import pytest

from ergowalk.body import Body
from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM
from ergowalk.problem import DEFAULT_PRESET, PRESETS, preset


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_carries_its_own_name_and_one_line_about_it(name):
    assert preset(name).name == PRESETS[name].name == name
    assert PRESETS[name].summary
    assert "\n" not in PRESETS[name].summary


@pytest.mark.parametrize("name", PRESETS)
def test_the_summary_tells_the_step_that_the_problem_has(name):
    problem = preset(name)
    if "L = " in PRESETS[name].summary:
        assert f"L = {problem.step_length_m:g} m" in PRESETS[name].summary
        stated = float(PRESETS[name].summary.split("T = ")[1].split()[0])
        assert stated == problem.stride_time_s


@pytest.mark.parametrize("name", PRESETS)
def test_human_data_of_a_preset_are_there(name):
    assert set(preset(name).angle_corridors()) == {"hip", "knee", "ankle"}


def test_the_default_is_the_case_of_the_paper():
    problem = preset(DEFAULT_PRESET)
    assert DEFAULT_PRESET == "berbyuk2002"
    assert (problem.step_length_m, problem.stride_time_s) == (0.76, 1.14)
    assert problem.body == Body()
    assert problem.body.total_mass == pytest.approx(73.18, abs=1e-9)
    assert problem.corridors.source == "winter-natural"
    assert problem.corridors.width_sd == 1.0
    assert not problem.rhythm.fixed


def test_the_rhythm_preset_differs_only_in_its_rhythm():
    fixed, free = preset("berbyuk2002-rhythm"), preset("berbyuk2002")
    assert fixed.rhythm.fixed
    assert fixed.rhythm.start() == PRINTED_RHYTHM
    assert fixed.replace(name=free.name, rhythm=free.rhythm) == free


def test_the_printed_preset_has_no_limits():
    printed = preset("berbyuk2002-printed")
    assert printed.limits.sentence() == "no limits"
    assert not printed.limits.bounds_moment_rate
    assert printed.replace(name="berbyuk2002", limits=preset("berbyuk2002").limits) == preset(
        "berbyuk2002"
    )


@pytest.mark.parametrize("cadence", ["slow", "natural", "fast"])
def test_each_cadence_walks_in_its_own_corridors(cadence):
    assert preset(f"winter-{cadence}").corridors.source == f"winter-{cadence}"


def test_cadences_are_ordered_by_speed():
    speeds = [
        2 * p.step_length_m / p.stride_time_s
        for p in map(preset, ("winter-slow", "winter-natural", "winter-fast"))
    ]
    assert speeds == sorted(speeds)
    assert speeds[0] < speeds[1] < speeds[2]


def test_an_unknown_preset_is_told_with_all_names():
    with pytest.raises(ProblemError, match=r"preset = 'berbyuk': no such preset; choose one of"):
        preset("berbyuk")
