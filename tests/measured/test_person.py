"""The body of a measured person."""

from __future__ import annotations

from typing import Any

import pytest

from ergowalk.body import Body
from ergowalk.measured.choices import Choices
from ergowalk.measured.kinematics import FootShape
from ergowalk.measured.person import DEMPSTER, Lengths, person_body

LENGTHS = Lengths(0.42, 0.41, FootShape(0.08, 0.05, 0.18, 0.25), 0.5)


def test_dempsters_masses_are_one_person() -> None:
    legs = sum(DEMPSTER[part].mass for part in ("thigh", "shank", "foot"))
    assert DEMPSTER["trunk"].mass + 2 * legs == pytest.approx(1.0)
    assert person_body(70.0, LENGTHS, Choices()).total_mass == pytest.approx(70.0)


def test_inertias_are_about_the_proximal_joints() -> None:
    leg = person_body(70.0, LENGTHS, Choices()).leg(0)
    assert leg.thigh_inertia == pytest.approx(7.0 * (0.540 * 0.42) ** 2)
    assert leg.shank_inertia == pytest.approx(70 * 0.0465 * (0.528 * 0.41) ** 2)


def test_a_flat_foot_stands_as_it_was_measured() -> None:
    leg = person_body(70.0, LENGTHS, Choices()).leg(0)
    assert leg.ankle_height == pytest.approx(0.08, abs=2e-4)  # lengths have four decimals
    assert leg.heel_to_metatarsal == 0.18
    assert leg.toe_length == pytest.approx(0.07)


def test_toes_without_marker_have_the_usual_share() -> None:
    bare = Lengths(0.42, 0.41, FootShape(0.08, 0.05, 0.18, float("nan")), None)
    assert person_body(70.0, bare, Choices()).leg(0).toe_length == pytest.approx(
        0.44 * 0.18, abs=1e-4
    )


def test_a_body_that_knows_anthropometry_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: dict[str, Any] = {}

    def known(cls: type[Body], height_m: float, mass_kg: float, **rest: Any) -> Body:
        asked.update(height=height_m, mass=mass_kg, **rest)
        return Body(
            trunk_mass_kg=55.0, trunk_inertia_kgm2=9.0, thigh_length_m=rest["thigh_length_m"]
        )

    monkeypatch.setattr(Body, "from_height_mass", classmethod(known), raising=False)
    body = person_body(80.0, LENGTHS, Choices(height_m=1.8, sex="female"))
    assert asked["height"] == 1.8
    assert asked["mass"] == 80.0
    assert asked["sex"] == "female"
    assert body.trunk_mass_kg == 55.0
    assert body.leg(0).thigh_length == 0.42
    assert body.leg(0).heel_to_metatarsal == 0.18
