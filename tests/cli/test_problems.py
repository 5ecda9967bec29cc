"""``ergowalk presets`` and ``ergowalk init``."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from ergowalk.anthropometry import MEASURED, Person
from ergowalk.body import Body
from ergowalk.cli.arguments.problems import PERSON_LENGTHS
from ergowalk.problem import DEFAULT_PRESET, PRESETS, preset
from ergowalk.problem.files import json_schema, problem_from_toml
from ergowalk.problem.scaling import for_person


def test_presets_are_listed_with_their_summaries(run):
    answer = run("presets")
    assert (answer.status, answer.err) == (0, "")
    listed = [line.split(maxsplit=1) for line in answer.out.splitlines()]
    assert listed == [[p.name, p.summary] for p in PRESETS.values()]


def test_presets_as_json_name_the_default(run):
    found = json.loads(run("presets", "--json").out)
    assert found["default"] == DEFAULT_PRESET
    assert [entry["name"] for entry in found["presets"]] == list(PRESETS)


@pytest.mark.parametrize("name", PRESETS)
def test_init_prints_a_file_that_is_the_preset(run, name):
    answer = run("init", "--preset", name)
    assert (answer.status, answer.err) == (0, "")
    assert problem_from_toml(answer.out) == preset(name)


def test_init_starts_from_the_case_of_the_paper(run):
    answer = run("init")
    assert problem_from_toml(answer.out) == preset(DEFAULT_PRESET)
    assert re.search(r"^step_length_m = 0\.76 +# step length L", answer.out, re.M)
    assert re.search(r"^stride_time_s = 1\.14 +# stride time T", answer.out, re.M)


def test_init_writes_a_new_file_and_never_replaces_one(run):
    assert run("init", "-o", "p.toml").status == 0
    text = Path("p.toml").read_text("utf-8")
    assert text == run("init").out
    answer = run("init", "--preset", "winter-slow", "-o", "p.toml")
    assert answer.status == 2
    assert answer.err == "ergowalk: p.toml: exists already; choose another name\n"
    assert Path("p.toml").read_text("utf-8") == text


def test_init_with_a_person_prints_a_problem_of_that_body(run):
    answer = run("init", "--height", 1.80, "--mass", 75, "--sex", "female")
    assert (answer.status, answer.err) == (0, "")
    problem = problem_from_toml(answer.out)
    assert problem.body == Body.from_height_mass(1.80, 75, "female")
    person = Person(height_m=1.80, mass_kg=75, sex="female")
    assert problem == for_person(preset(DEFAULT_PRESET), person)
    told = " ".join(line[2:] for line in answer.out.split("\n\n")[0].splitlines())
    assert "1.8 m, 75 kg, de Leva's female table" in told
    assert "same Froude number" in told


def test_init_with_a_person_starts_from_any_preset_with_measured_lengths(run):
    arguments = ("--preset", "winter-slow", "--table", "dempster", "--foot-length", 0.28)
    problem = problem_from_toml(run("init", "--height", 1.9, "--mass", 90, *arguments).out)
    assert problem.corridors == preset("winter-slow").corridors
    foot = problem.body.leg(0)
    assert foot.heel_to_metatarsal + foot.toe_length == pytest.approx(0.28, abs=1e-6)


def test_lengths_of_the_command_are_those_of_a_person():
    assert sorted(f"{name.replace('-', '_')}_m" for name in PERSON_LENGTHS) == sorted(
        MEASURED.values()
    )


def test_init_prints_the_schema_of_problem_files(run):
    answer = run("init", "--schema")
    assert (answer.status, answer.err) == (0, "")
    assert json.loads(answer.out) == json_schema()
    assert run("init", "--schema", "-o", "problem.schema.json").status == 0
    assert Path("problem.schema.json").read_text("utf-8") == answer.out
