"""Writes the reference pages from the code: ``python scripts/write_reference.py``.

Everything between ``<!-- generated: NAME -->`` and ``<!-- end -->`` comes from here, and the JSON
schema of problem files too; a test compares them with what the code says now.
"""

from __future__ import annotations

import argparse
import importlib
import inspect
import json
import os
import re
from collections.abc import Callable
from functools import cached_property

import ergowalk
from blocks import ROOT, fenced, publish, table
from ergowalk.audit import residuals
from ergowalk.audit.report import Residual
from ergowalk.cli.parser import build_parser
from ergowalk.problem import DEFAULT_PRESET, PRESETS, preset
from ergowalk.problem.files import json_schema, problem_to_toml
from ergowalk.quantities import ALL_QUANTITIES

API = {
    **{name: f"ergowalk.{name}" for name in ergowalk.__all__},
    "SplineOptions": "ergowalk.solving.SplineOptions",
    "CommonDesign": "ergowalk.solving.CommonDesign",
    "Design": "ergowalk.problem.Design",
    "audit": "ergowalk.audit.audit",
    "AuditReport": "ergowalk.audit.AuditReport",
    "compare": "ergowalk.comparison.compare",
    "Person": "ergowalk.anthropometry.Person",
    "for_person": "ergowalk.problem.scaling.for_person",
    "Format": "ergowalk.io.Format",
    "body_mjcf": "ergowalk.io.body_mjcf",
    "write_figures": "ergowalk.plots.write_figures",
    "film": "ergowalk.film.film",
    "FilmOptions": "ergowalk.film.FilmOptions",
    "Sweep": "ergowalk.study.Sweep",
    "Tally": "ergowalk.study.Tally",
    "collect": "ergowalk.study.collect",
    "Preferred": "ergowalk.study.Preferred",
    "Criterion": "ergowalk.study.Criterion",
    "steps_of_people": "ergowalk.study.steps_of_people",
    "problem_to_toml": "ergowalk.problem.files.problem_to_toml",
    "json_schema": "ergowalk.problem.files.json_schema",
    "casadi_functions": "ergowalk.mechanics.symbolic.casadi_functions",
}
"""What the page on the Python API shows, and where users import it from."""


SCHEMA = ROOT / "docs" / "reference" / "problem.schema.json"
"""The JSON schema of problem files, for editors."""


def schema() -> str:
    """Text of :data:`SCHEMA`."""
    return json.dumps(json_schema(), indent=2) + "\n"


def generated() -> dict[str, str]:
    """Text of every generated block by name."""
    return {
        **{f"help {name or 'ergowalk'}": fenced(text) for name, text in helps().items()},
        "presets": table(("preset", "problem"), [_preset(p.name) for p in PRESETS.values()]),
        "problem file": fenced(problem_to_toml(preset(DEFAULT_PRESET), commented=True), "toml"),
        "variables": variables(),
        "audit lines": audit_lines(),
        "python api": "\n\n".join(_entry(*item) for item in API.items()),
    }


def helps() -> dict[str, str]:
    """What each command prints for ``--help`` on a terminal of 80 columns; "" is the program."""
    os.environ["COLUMNS"] = "80"
    parser = build_parser()
    commands: dict[str, argparse.ArgumentParser] = {"": parser}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            commands |= action.choices
    return {name: command.format_help() for name, command in commands.items()}


def variables() -> str:
    """The variables of a gait file."""
    rows = [
        (f"`{q.name}`", ", ".join(q.dims), q.units, q.symbol, q.long_name)
        for q in ALL_QUANTITIES.values()
    ]
    return table(("variable", "dimensions", "unit", "symbol", "meaning"), rows)


def audit_lines() -> str:
    """Every line of an audit in its order, with tolerance and unit."""
    lines = [value for value in vars(residuals).values() if isinstance(value, Residual)]
    rows = [(f"`{r.key}`", r.what, f"{r.tolerance:.6g}", r.unit) for r in lines]
    return table(("key", "residual", "tolerance", "unit"), rows)


def _preset(name: str) -> tuple[str, str]:
    return f"`{name}`", PRESETS[name].summary


def _entry(name: str, path: str) -> str:
    """Heading, signature and docstring of a public name."""
    place, attribute = path.rsplit(".", 1)
    module = importlib.import_module(place)
    thing = getattr(module, attribute)
    parts = [f"## {name}", f"`from {place} import {attribute}`"]
    if inspect.isfunction(thing):
        parts.append(fenced(f"{name}{_signature(thing)}"))
    parts.append(fenced(_plain(inspect.getdoc(thing))))
    if inspect.isclass(thing):
        members = {k: v for k, v in vars(thing).items() if k[0] != "_" and _documented(v)}
        parts.append("\n".join(f"- `{k}`: {_summary(v)}" for k, v in members.items()))
    return "\n\n".join(part for part in parts if part)


def _summary(member: object) -> str:
    return _plain(inspect.getdoc(member)).split("\n\n")[0].replace("\n", " ")


def _documented(member: object) -> bool:
    """Whether a class attribute is a method or a property."""
    kinds = (property, cached_property, classmethod, staticmethod)
    return isinstance(member, kinds) or inspect.isfunction(member)


def _signature(function: Callable[..., object]) -> str:
    """Arguments as they are declared."""
    signature = inspect.signature(function)
    parts, star = [], False
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not star:
            parts.append("*")
            star = True
        default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        parts.append(f"{parameter.name}: {parameter.annotation}{default}")
    return f"({', '.join(parts)}) -> {signature.return_annotation}"


def _plain(docstring: str | None) -> str:
    """A docstring without the roles that only Sphinx understands."""
    return re.sub(r":[a-z]+:`~?([^`]+)`", r"``\1``", docstring or "")


def main() -> None:
    texts = generated()
    publish("generated", texts)
    SCHEMA.write_text(schema(), "utf-8")


if __name__ == "__main__":
    main()
