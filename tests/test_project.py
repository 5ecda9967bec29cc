"""What is written down twice in the project's own files agrees."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

import ergowalk

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))


def pins(name: str) -> dict[str, str]:
    """Versions of a requirements file; every line must be a plain pin."""
    lines = (ROOT / name).read_text("utf-8").splitlines()
    plain = [line for line in lines if line and not line.startswith("#")]
    found = [re.fullmatch(r"([\w.-]+)==([\w.]+)", line) for line in plain]
    assert all(found), f"{name}: {plain[found.index(None)]}"
    return {match[1].lower().replace("_", "-"): match[2] for match in found if match}


def test_readme_has_two_commands_that_set_everything_up() -> None:
    readme = (ROOT / "README.md").read_text("utf-8")
    commands = re.findall(r"^python3 -m venv .*$", readme, re.M)
    assert len(commands) == 2
    assert commands[0].endswith("ergowalk solve -o gait")
    assert "pip install -r requirements-test.txt" in commands[1]
    assert "pytest" in commands[1]


def test_lowest_versions_are_the_lower_bounds() -> None:
    extras = PROJECT["project"]["optional-dependencies"].values()
    known = [*PROJECT["project"]["dependencies"], *(bound for extra in extras for bound in extra)]
    bounds = dict(bound.split(">=") for bound in known if ">=" in bound)
    lowest = pins("requirements-lowest.txt")
    assert {name.lower(): version for name, version in bounds.items()}.items() <= lowest.items()


def test_the_test_environment_pins_what_the_tests_need() -> None:
    needed = [bound.split(">=")[0].lower() for bound in PROJECT["project"]["dependencies"]]
    extras = PROJECT["project"]["optional-dependencies"]
    needed += [*extras["test"], *(bound.split(">=")[0] for bound in extras["sweep"])]
    assert set(needed) <= set(pins("requirements-test.txt"))


@pytest.mark.parametrize("name", ["pyproject.toml", ".ci/run", ".ci/oldest", "README.md"])
def test_no_package_index_is_named(name: str) -> None:
    text = (ROOT / name).read_text("utf-8")
    assert re.findall(r"(?i)index[-_]url|find[-_]links|trusted[-_]host", text) == []


def test_rooms_in_the_guide_are_the_layers_that_the_linter_holds() -> None:
    guide = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    picture = guide[guide.index("```text\n") + 8 :].split("```")[0]
    rooms = [re.split(r"\s{2,}", line)[0] for line in picture.splitlines()]
    assert rooms == PROJECT["tool"]["importlinter"]["contracts"][0]["layers"]


def test_version_is_the_same_everywhere() -> None:
    changelog = (ROOT / "CHANGELOG.md").read_text("utf-8")
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    assert re.findall(r"^## (\S+)", changelog, re.M)[0] == ergowalk.__version__
    assert re.findall(r"^version: (\S+)", citation, re.M) == [ergowalk.__version__]
