"""The body of a measured person."""

from __future__ import annotations

import pytest

from ergowalk.body import Body
from ergowalk.errors import RecordingError
from ergowalk.measured.choices import Choices
from ergowalk.measured.kinematics import FootShape
from ergowalk.measured.person import Lengths, person_body

LENGTHS = Lengths(0.42, 0.41, FootShape(0.08, 0.05, 0.18, 0.25), 0.5)


def test_the_parts_are_one_person() -> None:
    assert person_body(70.0, LENGTHS, Choices()).total_mass == pytest.approx(70.0, rel=1e-9)


def test_inertias_are_about_the_proximal_joints() -> None:
    """Dempster's radii of gyration about the hip and the knee (Winter 2009, table 4.1)."""
    leg = person_body(70.0, LENGTHS, Choices()).leg(0)
    assert leg.thigh_inertia == pytest.approx(7.0 * (0.540 * 0.42) ** 2, rel=3e-3)
    assert leg.shank_inertia == pytest.approx(70 * 0.0465 * (0.528 * 0.41) ** 2, rel=3e-3)


def test_height_and_sex_choose_the_table_and_measured_lengths_stay() -> None:
    body = person_body(80.0, LENGTHS, Choices(height_m=1.8, sex="female"))
    table = Body.from_height_mass(
        1.8, 80.0, "female", thigh_length_m=0.42, shank_length_m=0.41, hip_to_shoulder_m=0.5
    )
    assert body.trunk_com_m == table.trunk_com_m
    assert body.leg(0).thigh_mass == table.leg(0).thigh_mass
    assert body.leg(0).heel_to_metatarsal == 0.18


def test_a_mass_that_nobody_has_is_refused() -> None:
    with pytest.raises(RecordingError, match=r"mass = 7000\.0: must lie between .* give --mass"):
        person_body(7000.0, LENGTHS, Choices())


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
