"""A page's form becomes a problem, or one of the library's sentences."""

from __future__ import annotations

import json
from typing import Any

import pytest

from ergowalk.app.problems import (
    asked_problem,
    form,
    short,
    title_of,
    uploaded_problem,
    values_of,
)
from ergowalk.body import Body
from ergowalk.errors import BodyError, CorridorError, InputError, ProblemError
from ergowalk.problem import PRESETS, preset
from ergowalk.problem.files import problem_to_toml


def asked(**changes: Any) -> bytes:
    values = values_of(preset("berbyuk2002")) | changes
    return json.dumps({"problem": values}).encode()


@pytest.mark.parametrize("name", PRESETS)
def test_a_form_that_nobody_touched_is_its_preset(name: str) -> None:
    (shown,) = [p["problem"] for p in form()["presets"] if p["name"] == name]
    sent = json.dumps({"problem": json.loads(json.dumps(shown))}).encode()
    assert asked_problem(sent) == preset(name)


@pytest.mark.parametrize("name", PRESETS)
def test_a_problem_file_comes_back_as_its_values(name: str) -> None:
    content = problem_to_toml(preset(name), commented=True).encode()
    assert uploaded_problem(content, "mine.toml") == preset(name)


def test_values_of_the_form_are_those_of_the_problem() -> None:
    limits = values_of(preset("berbyuk2002"))["limits"] | {"friction_coefficient": "off"}
    problem = asked_problem(asked(step_length_m=0.7, stride_time_s=1, limits=limits))
    assert (problem.step_length_m, problem.stride_time_s) == (0.7, 1.0)
    assert problem.limits.friction_coefficient == "off"


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"step_length_m": -1}, r"^step_length_m = -1: should be greater than 0; give step length"),
        ({"step_length_m": "1,2,3"}, r"^step_length_m = '1,2,3': should be a valid number; give"),
        ({"stride_time_s": None}, r"^stride_time_s: should be a valid number; give stride time"),
        ({"step_length_m": 9}, r"^step_length_m = 9\.0: out of reach: .*; shorten the step"),
        ({"limits": {"friction_coefficient": 0}}, r"^limits\.friction_coefficient = 0: should be"),
        ({"speed": 1}, r"^speed: unknown key; known keys: name"),
        ({"folder": "/etc"}, r"^folder: unknown key; remove it"),
        ({"body": {"thigh_length_m": float("nan")}}, r"^body\.thigh_length_m = nan: should be"),
    ],
)
def test_what_cannot_be_is_told_in_the_sentence_of_the_library(
    changes: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        asked_problem(asked(**changes))


@pytest.mark.parametrize(
    "content",
    [
        *(b"", b"[]", b"null", b"\xff", b"{", b'{"problem": 1}', b"[" * 100_000, b"1" * 5000),
        asked(name="\ud800"),
    ],
    ids=["nothing", "list", "null", "bytes", "half", "number", "deep", "digits", "half a letter"],
)
def test_what_is_no_form_is_one_sentence(content: bytes) -> None:
    with pytest.raises(ProblemError, match="; send "):
        asked_problem(content)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"step_length_m = ", r"^mine\.toml: not valid TOML: .*; see 'ergowalk init'"),
        (b"\xff\xfe", r"^mine\.toml: not UTF-8 text \(byte 0\); save the problem file as UTF-8"),
        (b"stride_time_s = 1.14", r"^mine\.toml: step_length_m: required but missing; add it"),
        (b"\x00", r"^mine\.toml: not valid TOML"),
    ],
)
def test_a_bad_file_is_named_in_the_sentence_of_the_library(content: bytes, sentence: str) -> None:
    with pytest.raises(ProblemError, match=sentence):
        uploaded_problem(content, "mine.toml")


@pytest.mark.parametrize("source", ["/etc/passwd", "human.csv", "../x.csv", ""])
def test_no_file_on_the_machine_of_the_server_is_opened(source: str) -> None:
    sentence = r"names a file, and the app opens none on this machine; choose one of winter-slow"
    content = problem_to_toml(preset("berbyuk2002")).replace("winter-natural", source).encode()
    with pytest.raises(CorridorError, match=rf"^mine\.toml: corridors\.source = .*: {sentence}"):
        uploaded_problem(content, "mine.toml")
    with pytest.raises(CorridorError, match=sentence):
        asked_problem(asked(corridors={"source": source}))


def test_names_are_shown_on_one_line_of_bounded_length() -> None:
    assert short("a\nb\x00\u202ec") == "a b c"
    assert short("\n") == "custom"
    assert len(short("n" * 1000)) == 60
    title = title_of(preset("berbyuk2002").replace(name="walk\nfast"))
    assert title == "walk fast: step 0.76 m, stride 1.14 s, 1.33 m/s"


def sized(**size: Any) -> bytes:
    return json.dumps(json.loads(asked()) | {"size": size}).encode()


def test_the_body_is_scaled_to_height_and_mass() -> None:
    problem = asked_problem(sized(height_m=1.8, mass_kg=80, sex="female"))
    assert problem.body == Body.from_height_mass(1.8, 80, sex="female")
    assert asked_problem(sized(height_m=1.8, mass_kg=80)).body == Body.from_height_mass(1.8, 80)
    with pytest.raises(BodyError, match=r"^sex = 'x': "):
        asked_problem(sized(height_m=1.8, mass_kg=80, sex="x"))


@pytest.mark.parametrize("mass", ["80 kg", None, True, []])
def test_a_mass_that_is_no_number_is_refused(mass: Any) -> None:
    with pytest.raises(ProblemError, match=r"^mass_kg.*: should be a valid number; give one"):
        asked_problem(sized(height_m=1.8, mass_kg=mass))


def test_a_size_that_is_no_table_is_refused() -> None:
    content = json.dumps(json.loads(asked()) | {"size": 1.8}).encode()
    with pytest.raises(ProblemError, match="^size: cannot be used; leave it out"):
        asked_problem(content)
