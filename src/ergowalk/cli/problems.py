"""Commands about problems: ``presets`` and ``init``."""

from __future__ import annotations

import json
import os
import re
from argparse import Namespace
from typing import Any

from ergowalk.anthropometry import Person
from ergowalk.cli.arguments.common import UsageError
from ergowalk.cli.output import write_text
from ergowalk.cli.streams import emit, emit_json
from ergowalk.errors import InputError, OutputError
from ergowalk.problem import DEFAULT_PRESET, PRESETS, preset
from ergowalk.problem.files import json_schema, problem_to_toml
from ergowalk.problem.scaling import REFERENCE_HEIGHT_M, for_person


def run_presets(arguments: Namespace) -> None:
    """List names and summaries."""
    if arguments.json:
        entries = [{"name": p.name, "summary": p.summary} for p in PRESETS.values()]
        emit_json({"default": DEFAULT_PRESET, "presets": entries})
        return
    width = max(map(len, PRESETS))
    emit("\n".join(f"{p.name:<{width}}  {p.summary}" for p in PRESETS.values()))


def run_init(arguments: Namespace) -> None:
    """Print a commented problem file or the schema of such files, or write it to a new file.

    Raises
    ------
    OutputError
        If the file exists or cannot be written.
    ProblemError, BodyError
        If there is no such preset or no such person.
    """
    text = _schema(arguments) if arguments.schema else _problem(arguments)
    if arguments.output is None:
        emit(text.rstrip("\n"))
        return
    if os.path.lexists(arguments.output):
        raise OutputError("exists already", "choose another name", file=str(arguments.output))
    write_text(arguments.output, text)


def _problem(arguments: Namespace) -> str:
    problem = preset(arguments.preset or DEFAULT_PRESET)
    given = _person(arguments)
    if not given:
        return problem_to_toml(problem, commented=True)
    for field in ("height_m", "mass_kg"):
        if field not in given:
            asked = _option(next(iter(given)))
            raise UsageError("required but missing", f"{asked} needs it", field=_option(field))
    try:
        person = Person(**given)
    except InputError as error:
        error.field = _option(error.field or "")
        raise
    remark = (
        f"The body is that of a person: {person.words}. Step length and stride time are those of "
        f"{problem.name} at the same Froude number, taken to be of a person of "
        f"{REFERENCE_HEIGHT_M:g} m."
    )
    return problem_to_toml(for_person(problem, person), commented=True, remark=remark)


def _schema(arguments: Namespace) -> str:
    for field in ("preset", *_person(arguments)):
        if getattr(arguments, field, True) is not None:
            raise UsageError("means nothing to --schema", "leave it out", field=_option(field))
    return json.dumps(json_schema(), indent=2) + "\n"


def _person(arguments: Namespace) -> dict[str, Any]:
    """What was given of a person, by the fields of :class:`Person`."""
    found = {field: getattr(arguments, _argument(field)) for field in Person.model_fields}
    return {field: value for field, value in found.items() if value is not None}


def _argument(field: str) -> str:
    return re.sub("_(m|kg)$", "", field)


def _option(field: str) -> str:
    return "--" + _argument(field).replace("_", "-")
