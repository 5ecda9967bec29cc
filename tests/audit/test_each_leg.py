"""Gaits in which each leg has its own curves: what the audit asks of them."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from ergowalk.errors import GaitFileError

from .conftest import Gait
from .tampering import edit_json, set_problem

ASYMMETRIES = ("step_length_asymmetry", "step_time_asymmetry")


def each_leg(gait: Gait) -> Gait:
    """The same gait as one of two halves that were both solved."""
    both = gait.copy()
    attributes = both.dataset.attrs
    length = float(attributes["step_length"])
    attributes["rhythm_leg_2"] = attributes["rhythm"]
    attributes["step_lengths"] = json.dumps([length, length])
    set_problem(both.dataset, "stride", "legs", '"each"')
    return both


def test_two_equal_halves_are_accepted(good: Gait) -> None:
    report = each_leg(good).audited()
    assert report.accepted, report.table()
    assert report.line("steps_as_asked").note == "asymmetry of length +0.0000, of time +0.0000"
    assert report.line("leg_symmetry").value is None


def test_mirrored_legs_have_no_line_about_their_steps(good: Gait) -> None:
    with pytest.raises(Exception, match="no such line"):
        good.audited().line("steps_as_asked")


def test_each_leg_has_its_own_curves_only_where_the_problem_says_so(good: Gait) -> None:
    gait = each_leg(good)
    set_problem(gait.dataset, "stride", "legs", '"auto"')
    failed = {line.key for line in gait.audited().failed}
    assert failed == {"leg_symmetry", "load_symmetry"}
    set_problem(gait.dataset, "body", "foot_mass_kg", "[1.24, 1.24]")
    assert "leg_symmetry" in {line.key for line in gait.audited().failed}


def steps_that_are_not_those_of_the_feet(gait: xr.Dataset) -> None:
    first, second = json.loads(gait.attrs["step_lengths"])
    gait.attrs["step_lengths"] = json.dumps([first + 0.01, second - 0.01])


def steps_that_do_not_make_the_stride(gait: xr.Dataset) -> None:
    first, second = json.loads(gait.attrs["step_lengths"])
    gait.attrs["step_lengths"] = json.dumps([first + 0.01, second])


def asymmetries_that_were_not_asked(gait: xr.Dataset) -> None:
    for name in ASYMMETRIES:
        set_problem(gait, "stride", name, "[0.01, 0.1]")


def another_heel_off_of_leg_2(gait: xr.Dataset) -> None:
    rhythm = json.loads(gait.attrs["rhythm_leg_2"])
    edit_json(gait, "rhythm_leg_2", heel_off=rhythm["heel_off"] + 0.01)


def a_heel_contact_of_leg_2_that_is_not_that_of_leg_1(gait: xr.Dataset) -> None:
    edit_json(gait, "rhythm_leg_2", toe_tip_start=0.49)


def a_tighter_rhythm_of_leg_2(gait: xr.Dataset) -> None:
    gait.attrs["problem"] += "\n[rhythm.leg_2]\ntoe_off = 0.53\n"


def a_tighter_cap_of_leg_2(gait: xr.Dataset) -> None:
    gait.attrs["problem"] += "\n[limits.leg_2]\nvertical_reaction_body_weights = 0.7\n"


def a_weaker_ankle_of_leg_1(gait: xr.Dataset) -> None:
    gait.attrs["problem"] += "\n[limits.leg_1.moment_nm_per_kg]\nankle = 0.3\n"


def wider_corridors_of_leg_2(gait: xr.Dataset) -> None:
    gait.attrs["problem"] += "\n[corridors.leg_2]\nwidth_sd = 3.0\n"


@pytest.mark.parametrize(
    ("lie", "lines"),
    [
        (steps_that_are_not_those_of_the_feet, {"feet_fixed"}),
        (steps_that_do_not_make_the_stride, {"steps_as_asked"}),
        (asymmetries_that_were_not_asked, {"steps_as_asked"}),
        (another_heel_off_of_leg_2, {"phases"}),
        (a_heel_contact_of_leg_2_that_is_not_that_of_leg_1, {"rhythm_order"}),
        (a_tighter_rhythm_of_leg_2, {"rhythm_as_asked"}),
        (a_tighter_cap_of_leg_2, {"vertical_reaction_cap"}),
        (a_weaker_ankle_of_leg_1, {"moment_limits"}),
        (wider_corridors_of_leg_2, {"corridors_as_asked"}),
    ],
)
def test_the_audit_names_what_is_wrong_with_one_leg(
    good: Gait, lie: Callable[[xr.Dataset], None], lines: set[str]
) -> None:
    gait = each_leg(good)
    lie(gait.dataset)
    failed = gait.audited().failed
    assert lines <= {line.key for line in failed}
    leg = {"a_tighter_cap_of_leg_2": "leg 2", "a_weaker_ankle_of_leg_1": "leg 1"}.get(lie.__name__)
    if leg is not None:
        assert leg in next(line.where for line in failed if line.key in lines)


@pytest.mark.parametrize("name", ["rhythm_leg_2", "step_lengths"])
def test_a_file_that_tells_half_of_it_cannot_be_read(marionette: Gait, name: str) -> None:
    gait = each_leg(marionette)
    del gait.dataset.attrs[name]
    with pytest.raises(GaitFileError, match=f"{name}: global attribute is missing"):
        gait.audited()


@pytest.mark.parametrize("steps", ["[0.7]", "[0.7, -0.1]", '["a", 1]', "{}", "nonsense"])
def test_steps_that_are_no_lengths_cannot_be_read(marionette: Gait, steps: str) -> None:
    gait = each_leg(marionette)
    gait.dataset.attrs["step_lengths"] = steps
    with pytest.raises(GaitFileError, match="step_lengths.* two lengths of the steps"):
        gait.audited()


def test_a_step_to_one_side_in_time_is_seen_by_the_corridors(good: Gait) -> None:
    """Leg 2's corridors start at its own heel contact."""
    gait = each_leg(good)
    edit_json(gait.dataset, "rhythm", toe_tip_start=0.51)
    edit_json(gait.dataset, "rhythm_leg_2", toe_tip_start=0.49)
    report = gait.audited()
    assert not report.line("corridors_as_asked").accepted
    assert "leg 2" in report.line("corridors_as_asked").where
    assert np.isclose(float(report.line("steps_as_asked").note.split()[-1]), -0.02)
