"""``ergowalk presets`` and ``ergowalk init``."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from ergowalk.problem import DEFAULT_PRESET, PRESETS, preset
from ergowalk.problem.files import problem_from_toml


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
