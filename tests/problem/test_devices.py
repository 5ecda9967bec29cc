"""Devices as they are written down: what goes together, and what a file keeps."""

from __future__ import annotations

from typing import Any

import pytest

from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import Contact
from ergowalk.problem import Device, Devices, GaitProblem, preset
from ergowalk.problem.files import json_schema, problem_from_toml, problem_to_toml

GIVENS = "step_length_m = 0.76\nstride_time_s = 1.14\n"


def test_there_are_none_by_default() -> None:
    problem = preset("berbyuk2002")
    assert list(problem.devices.items()) == []
    assert "devices" not in problem_to_toml(problem)
    assert problem.conditions() == problem.limits.sentence()


def test_a_file_keeps_devices() -> None:
    devices = Devices(
        hip=Device(kind="spring", stiffness_nm_per_rad=50.0, rest_angle_deg=10.0),
        knee=Device(kind="locked", rest_angle_deg="latched", active=("heel", "flat")),
        ankle=Device(
            kind="parallel",
            own_moment=False,
            stiffness_nm_per_rad=300.0,
            stiffness_below_nm_per_rad=500.0,
            damping_nms_per_rad=2.0,
        ),
    )
    problem: GaitProblem = preset("berbyuk2002").replace(devices=devices)
    for commented in (False, True):
        assert problem_from_toml(problem_to_toml(problem, commented)) == problem
    assert "devices: hip spring 50 N m/rad at 10 deg beside the own moment; knee locked" in (
        problem.conditions()
    )


def test_the_schema_knows_them() -> None:
    assert "Device" in str(json_schema()["properties"]["devices"])


@pytest.mark.parametrize(
    ("given", "match"),
    [
        ({"kind": "spring", "damping_nms_per_rad": 1.0}, "damping_nms_per_rad = 1.0: a device of "),
        ({"kind": "damper", "stiffness_nm_per_rad": 1.0}, "kind 'damper' has no stiffness; leave"),
        ({"kind": "locked", "stiffness_nm_per_rad": 1.0}, "kind 'locked' has no stiffness"),
        ({"kind": "free", "damping_nms_per_rad": 1.0}, "kind 'free' has no damping"),
        ({"kind": "series", "damping_nms_per_rad": 1.0}, "in series both need a value above zero"),
        ({"kind": "spring", "stiffness_nm_per_rad": -1.0}, "should be greater than or equal to 0"),
        ({"kind": "spring", "rest_angle_deg": "latched"}, "only a lock with a latch holds"),
        ({"kind": "locked", "rest_angle_deg": "latched"}, "only a lock with a latch holds"),
        ({"kind": "spring", "active": ()}, "must name one phase or more"),
        ({"kind": "spring", "active": ("heel", "heel")}, "must name one phase or more, each once"),
        ({"kind": "string"}, "kind = 'string': should be 'locked', 'free'"),
        (
            {
                "kind": "series",
                "stiffness_nm_per_rad": 1.0,
                "damping_nms_per_rad": 1.0,
                "active": ("heel",),
            },
            "in series the spring has one slope and no latch; leave out",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(given: dict[str, Any], match: str) -> None:
    with pytest.raises(ProblemError, match=match):
        Device(**given)


def test_a_file_with_a_wrong_device_is_told_where() -> None:
    with pytest.raises(ProblemError, match=r"devices\.ankle\.damping_nms_per_rad = 2"):
        problem_from_toml(GIVENS + "[devices.ankle]\nkind = 'spring'\ndamping_nms_per_rad = 2\n")
    with pytest.raises(ProblemError, match=r"devices\.elbow: unknown key; .*knee"):
        problem_from_toml(GIVENS + "[devices.elbow]\nkind = 'free'\n")


def test_toes_rest_in_line_with_the_sole() -> None:
    with pytest.raises(ProblemError, match=r"metatarsal\.rest_angle_deg = 5\.0: must be 0"):
        Devices(metatarsal=Device(kind="spring", stiffness_nm_per_rad=9.0, rest_angle_deg=5.0))


def test_a_latch_acts_in_its_phases() -> None:
    always = Device(kind="free")
    assert not always.latch
    assert all(always.acts(contact) for contact in Contact)
    stance = Device(kind="locked", active=("heel", "flat"))
    assert stance.latch
    assert [c.name for c in Contact if stance.acts(c)] == ["HEEL", "FLAT"]
