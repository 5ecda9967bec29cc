"""A file that no audit can read is refused in one line: what, the rule, the remedy."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr

from ergowalk.audit import audit, check_readable
from ergowalk.audit.reading import VARIABLES
from ergowalk.errors import GaitFileError

from .conftest import Gait

REMEDY = "write the gait again"


@pytest.fixture
def gait(marionette: Gait) -> xr.Dataset:
    """A good gait to break."""
    return marionette.dataset.copy(deep=True)


def refusal(gait: xr.Dataset) -> str:
    """The message, which must be one line and name the file."""
    with pytest.raises(GaitFileError, match=r"gait\.nc") as caught:
        check_readable(gait, "gait.nc")
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_a_good_file_is_readable(gait: xr.Dataset) -> None:
    assert check_readable(gait, "gait.nc") is None


@pytest.mark.parametrize("name", sorted(VARIABLES))
def test_a_missing_variable_is_named(gait: xr.Dataset, name: str) -> None:
    message = refusal(gait.drop_vars(name))
    assert name in message
    assert REMEDY in message


def test_a_file_without_time_is_refused(gait: xr.Dataset) -> None:
    assert "time: required but missing" in refusal(gait.drop_vars("time"))


@pytest.mark.parametrize(
    "name",
    ["energy_per_metre", "step_length", "stride_time", "rhythm", "body_parameters", "problem"],
)
def test_a_missing_attribute_is_named(gait: xr.Dataset, name: str) -> None:
    del gait.attrs[name]
    assert f"{name}: global attribute is missing" in refusal(gait)


@pytest.mark.parametrize(
    ("name", "value", "rule"),
    [
        ("energy_per_metre", "much", "must be a finite number"),
        ("energy_per_metre", np.nan, "must be a finite number"),
        ("step_length", 0.0, "must be positive"),
        ("stride_time", -1.14, "must be positive"),
        ("rhythm", "{}", "must be a fraction of the stride time"),
        ("rhythm", "[1", "must be a fraction of the stride time"),
        ("rhythm", '{"heel_end": true}', "must be a fraction of the stride time"),
        ("rhythm", '{"heel_end": NaN}', "must be a fraction of the stride time"),
        ("problem", "step = = 1", "must be the text of a problem file"),
        ("problem", 3.0, "must be the text of a problem file"),
        ("body_parameters", "walker", "must be a JSON object"),
        ("body_parameters", "{}", "must be a positive number"),
    ],
)
def test_a_malformed_attribute_is_named(gait: xr.Dataset, name: str, value: Any, rule: str) -> None:
    gait.attrs[name] = value
    message = refusal(gait)
    assert name in message
    assert rule in message


@pytest.mark.parametrize(
    ("symbol", "value", "rule"),
    [
        ("m", -1, "must be a positive number;"),
        ("m", [40, 41], "must be a positive number;"),
        ("a", [0.4, 0.4, 0.4], "must be a positive number, or a pair of them"),
        ("a", [], "must be a positive number, or a pair of them"),
        ("J_b", "light", "must be a positive number, or a pair of them"),
        ("l_h", 0.5, "must be shorter than the other two together"),
    ],
)
def test_an_impossible_body_is_refused(
    gait: xr.Dataset, symbol: str, value: Any, rule: str
) -> None:
    body = json.loads(gait.attrs["body_parameters"])
    gait.attrs["body_parameters"] = json.dumps({**body, symbol: value})
    message = refusal(gait)
    assert f"body_parameters.{symbol}" in message
    assert rule in message


def test_wrong_dimensions_are_told(gait: xr.Dataset) -> None:
    gait["trunk_angle"] = gait["joint_angle"]
    assert "trunk_angle = ('time', 'leg', 'joint'): must have the dimensions time;" in refusal(gait)


def test_a_missing_label_is_told(gait: xr.Dataset) -> None:
    assert "leg = [1]: must hold 1, 2" in refusal(gait.isel(leg=[0]))


def test_other_labels_are_told(gait: xr.Dataset) -> None:
    renamed = gait.assign_coords(joint=["hip", "knee", "ankle", "toe"])
    assert "must hold hip, knee, ankle, metatarsal" in refusal(renamed)


def test_dimensions_without_labels_are_told(gait: xr.Dataset) -> None:
    assert "segment: required but missing" in refusal(gait.drop_vars("segment"))


def test_phases_without_meanings_are_told(gait: xr.Dataset) -> None:
    gait["contact_phase"].attrs.clear()
    assert "flag_values and flag_meanings must name swing" in refusal(gait)


def test_text_for_numbers_is_told(gait: xr.Dataset) -> None:
    gait["trunk_angle"] = ("time", np.full(gait.sizes["time"], "upright"))
    assert "trunk_angle: must hold numbers" in refusal(gait)


def test_time_that_runs_backwards_is_told_with_its_sample(gait: xr.Dataset) -> None:
    time = gait["time"].values.copy()
    time[17] = time[15]
    assert "must never decrease, and pass (sample 17)" in refusal(gait.assign_coords(time=time))


def test_time_that_stands_still_is_told(gait: xr.Dataset) -> None:
    still = gait.assign_coords(time=np.zeros(gait.sizes["time"]))
    assert "must never decrease, and pass" in refusal(still)


@pytest.mark.parametrize("keep", [0, 4])
def test_too_few_instants_are_told(gait: xr.Dataset, keep: int) -> None:
    assert "must hold five finite instants or more" in refusal(gait.isel(time=slice(0, keep)))


def test_a_time_that_is_no_number_is_told(gait: xr.Dataset) -> None:
    time = gait["time"].values.copy()
    time[3] = np.nan
    assert "must hold five finite instants" in refusal(gait.assign_coords(time=time))


def test_the_audit_refuses_what_is_not_readable(gait: xr.Dataset) -> None:
    with pytest.raises(GaitFileError, match="joint_power: required but missing"):
        audit(gait.drop_vars("joint_power"))


def test_legs_may_differ_where_the_body_says_so(gait: xr.Dataset, marionette: Gait) -> None:
    body = json.loads(gait.attrs["body_parameters"])
    gait.attrs["body_parameters"] = json.dumps({**body, "m_f": [1.24, 1.24], "a": [0.47, 0.47]})
    assert audit(gait, marionette.folder) == marionette.audited()
