"""Another person's problem: the same gait in proportion."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ergowalk.anthropometry import Person
from ergowalk.body import Body
from ergowalk.errors import BodyError
from ergowalk.problem import PRESETS, GaitProblem, preset
from ergowalk.problem.files import problem_from_toml, problem_to_toml
from ergowalk.problem.scaling import REFERENCE_HEIGHT_M, for_person


def froude(problem: GaitProblem, leg_length: float) -> float:
    """v^2 / (g l)."""
    speed = 2 * problem.step_length_m / problem.stride_time_s
    return speed**2 / (problem.body.gravity_m_s2 * leg_length)


@given(height=st.floats(1.2, 2.2), mass=st.floats(30, 150), name=st.sampled_from(list(PRESETS)))
def test_people_of_every_size_walk_at_the_same_froude_number(height, mass, name):
    person, original = Person(height_m=height, mass_kg=mass), preset(name)
    scaled = for_person(original, person)
    number = froude(original, 0.53 * REFERENCE_HEIGHT_M)  # step and time have four decimals
    assert froude(scaled, person.leg_length_m) == pytest.approx(number, rel=1e-3)
    per_leg = original.step_length_m / (0.53 * REFERENCE_HEIGHT_M)
    assert scaled.step_length_m / person.leg_length_m == pytest.approx(per_leg, rel=1e-3)
    assert scaled.body == Body.from_height_mass(height, mass)
    assert (scaled.corridors, scaled.rhythm) == (original.corridors, original.rhythm)
    assert scaled.limits == original.limits


def test_a_person_of_the_reference_height_keeps_step_and_time():
    scaled = for_person(preset("berbyuk2002"), Person(height_m=1.75, mass_kg=60))
    assert (scaled.step_length_m, scaled.stride_time_s) == (0.76, 1.14)


def test_longer_measured_legs_take_longer_steps():
    person = Person(height_m=1.75, mass_kg=60, thigh_length_m=0.46, shank_length_m=0.46)
    scaled = for_person(preset("berbyuk2002"), person)
    assert scaled.step_length_m == pytest.approx(0.76 * person.leg_length_m / 0.9275, abs=1e-4)


def test_gravity_is_that_of_the_problem():
    """On the Moon the stride time of the problem is the Moon's already."""
    problem = preset("berbyuk2002")
    moon = problem.replace(body=problem.body.replace(gravity_m_s2=1.62), stride_time_s=2.8)
    scaled = for_person(moon, Person(height_m=1.6, mass_kg=60))
    assert scaled.body.gravity_m_s2 == 1.62
    assert froude(scaled, 0.53 * 1.6) == pytest.approx(froude(moon, 0.53 * 1.75), rel=1e-3)


MINIMAL = "step_length_m = 0.7\nstride_time_s = 1.1\n"
PERSON = '[person]\nheight_m = 1.6\nmass_kg = 55\nsex = "female"\n'


def test_a_person_in_a_file_is_the_body_and_is_written_as_the_body():
    problem = problem_from_toml(MINIMAL + PERSON)
    assert problem.body == Body.from_height_mass(1.6, 55, "female")
    assert problem.person is None
    text = problem_to_toml(problem)
    assert "[person]" not in text
    assert problem_from_toml(text) == problem


@given(height=st.floats(1.2, 2.2), mass=st.floats(30, 150), sex=st.sampled_from([None, "female"]))
def test_a_scaled_problem_survives_a_file(height, mass, sex):
    problem = for_person(preset("winter-fast"), Person(height_m=height, mass_kg=mass, sex=sex))
    text = problem_to_toml(problem, commented=True, remark="some words " * 30)
    assert problem_from_toml(text) == problem
    assert problem_to_toml(problem_from_toml(text)) == problem_to_toml(problem)


def test_keys_of_the_body_go_before_the_person():
    text = MINIMAL + PERSON + "[body]\nthigh_mass_kg = 7.0\ngravity_m_s2 = 3.7\n"
    expected = Body.from_height_mass(1.6, 55, "female")
    assert problem_from_toml(text).body == expected.replace(thigh_mass_kg=7.0, gravity_m_s2=3.7)


def test_in_python_a_person_is_the_body_too():
    person = Person(height_m=1.6, mass_kg=55)
    problem = GaitProblem(step_length_m=0.7, stride_time_s=1.1, person=person)
    assert problem.body == Body.from_height_mass(1.6, 55)
    assert problem.replace(step_length_m=0.6).body == problem.body
    with pytest.raises(BodyError, match="person: is given twice; give either person or body"):
        GaitProblem(step_length_m=0.7, stride_time_s=1.1, person=person, body=Body())
