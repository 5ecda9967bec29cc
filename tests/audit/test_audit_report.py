"""What an audit hands out: lines, table, plain values."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ergowalk.audit import AuditLine, AuditReport
from ergowalk.audit.report import Residual, worst
from ergowalk.errors import InputError

from .conftest import Gait

GOOD = AuditLine("feet", "feet at rest", 1e-6, 1e-4, "m", True, "t = 0.1000 s, leg 1")
BAD = AuditLine("work", "work against energy", None, 1e-3, "1", False, "", "not a number")


def test_one_failing_line_fails_the_report() -> None:
    assert AuditReport((GOOD,)).accepted
    report = AuditReport((GOOD, BAD))
    assert not report.accepted
    assert report.failed == (BAD,)


def test_lines_are_found_by_key() -> None:
    assert AuditReport((GOOD, BAD)).line("work") is BAD


def test_an_unknown_key_is_told_with_the_known_ones() -> None:
    with pytest.raises(InputError, match="key = 'foot': no such line; choose one of feet, work"):
        AuditReport((GOOD, BAD)).line("foot")


def test_the_table_has_a_row_per_line_and_a_verdict() -> None:
    rows = AuditReport((GOOD, BAD)).table().splitlines()
    assert " ".join(rows[1].split()) == "ok feet at rest 1e-06 0.0001 m t = 0.1000 s, leg 1"
    assert rows[2].startswith("FAIL  work against energy  -")
    assert rows[2].endswith("not a number")
    assert rows[3] == "1 of 2 lines fail"
    assert AuditReport((GOOD,)).table().endswith("all lines pass")


def test_plain_values_survive_json(marionette: Gait) -> None:
    report = marionette.audited()
    plain = report.as_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["accepted"] is True
    assert [line["key"] for line in plain["lines"]] == [line.key for line in report.lines]


@pytest.mark.parametrize(
    ("keys", "tolerance", "unit"),
    [
        ("equations_of_motion swing_unloaded", 1e-6, "1"),
        ("velocities accelerations no_impact", 1e-5, "1"),
        ("feet_fixed feet_above_ground toes", 1e-4, "m"),
        ("reaction_upward vertical_reaction_cap friction", 1e-3, "body weight"),
        ("moment_limits moment_rate_limits", 1e-3, "body weight x 1 m"),
        ("center_of_pressure", 2e-3, "m"),
        ("corridors corridors_as_asked", 0.1, "deg"),
        ("periodicity leg_symmetry load_symmetry", 1e-6, "1"),
        ("energy work_energy", 1e-3, "1"),
        ("mesh", 1e-2, "1"),
    ],
)
def test_tolerances_are_those_of_the_contract(
    marionette: Gait, keys: str, tolerance: float, unit: str
) -> None:
    report = marionette.audited()
    for key in keys.split():
        assert (report.line(key).tolerance, report.line(key).unit) == (tolerance, unit)


def test_keys_are_unique(marionette: Gait) -> None:
    keys = [line.key for line in marionette.audited().lines]
    assert len(keys) == len(set(keys))


def test_the_worst_place_is_named_by_time_leg_and_joint() -> None:
    residual = np.zeros((3, 2, 2))
    residual[1, 0, 1], residual[2, 1, 0] = -5.0, 2.0
    legs, joints, time = ("leg 1", "leg 2"), ("hip", "knee"), np.array([0.0, 0.25, 0.5])
    found = worst(residual, time, legs, joints)
    assert (found.value, found.where) == (2.0, "t = 0.5000 s, leg 2, hip")
    found = worst(residual, time, legs, joints, one_sided=False)
    assert (found.value, found.where) == (5.0, "t = 0.2500 s, leg 1, knee")


def test_nothing_wrong_is_nowhere() -> None:
    found = worst(-np.ones(3), np.arange(3.0))
    assert (found.value, found.where) == (0.0, "")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_no_number_is_worst_and_fails(value: float) -> None:
    line = Residual("k", "what", 10.0).judged(worst([0.0, value, 3.0], np.arange(3.0)))
    assert not line.accepted
    assert line.value is None
    assert line.where == "t = 1.0000 s"


def test_a_value_at_its_tolerance_is_accepted() -> None:
    residual = Residual("k", "what", 0.5)
    assert residual.judged(worst([0.5], np.zeros(1))).accepted
    assert not residual.judged(worst([0.5000001], np.zeros(1))).accepted
