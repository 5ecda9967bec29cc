"""What ``import ergowalk`` gives, and what it does not cost."""

from __future__ import annotations

import importlib
import inspect
import json
import re
import subprocess
import sys
from importlib import metadata

import pytest

import ergowalk

HEAVY = ("casadi", "xarray", "matplotlib", "scipy", "netCDF4", "pandas")


def modules_after(statement: str) -> set[str]:
    """Top-level modules that a fresh interpreter has loaded after a statement."""
    program = f"import json, sys\n{statement}\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=60
    )
    return {name.partition(".")[0] for name in json.loads(done.stdout)}


def test_importing_the_package_loads_nothing_heavy() -> None:
    assert modules_after("import ergowalk").isdisjoint((*HEAVY, "numpy", "pydantic"))


def test_stating_a_problem_needs_no_solver() -> None:
    loaded = modules_after("import ergowalk; ergowalk.preset('berbyuk2002').angle_corridors()")
    assert loaded.isdisjoint(HEAVY)
    assert "numpy" in loaded


@pytest.mark.parametrize("name", ergowalk.__all__)
def test_every_public_name_is_there_and_explained(name: str) -> None:
    value = getattr(ergowalk, name)
    assert callable(value)
    assert value.__name__ == name
    assert inspect.getdoc(value)
    assert name in dir(ergowalk)


@pytest.mark.parametrize("name", ergowalk.__all__)
def test_a_public_name_stays_the_same_whatever_is_imported(name: str) -> None:
    """A subpackage of the same name must not take its place."""
    first = getattr(ergowalk, name)
    importlib.import_module(first.__module__)
    assert getattr(ergowalk, name) is first


def test_all_is_sorted_and_has_no_name_twice() -> None:
    assert ergowalk.__all__ == sorted(set(ergowalk.__all__))


def test_from_import_finds_what_is_loaded_later() -> None:
    from ergowalk import GaitProblem, Solution

    assert GaitProblem is type(ergowalk.preset("berbyuk2002"))
    assert Solution.__module__ == "ergowalk.solution.solution"


def test_a_name_that_does_not_exist_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="module 'ergowalk' has no attribute 'walk'"):
        ergowalk.walk  # noqa: B018


def test_the_version_is_a_version() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+([a-z0-9.+]*)", ergowalk.__version__)
    try:
        installed = metadata.version("ergowalk")
    except metadata.PackageNotFoundError:
        pytest.skip("run from the sources, not installed")
    assert installed == ergowalk.__version__


def test_the_package_says_in_its_docstring_how_to_begin() -> None:
    assert "ergowalk.preset" in str(ergowalk.__doc__)
    assert "ergowalk.solve" in str(ergowalk.__doc__)
