"""Problem files: a :class:`GaitProblem` as TOML, and back.

The writer follows the declared fields: keys, order, comments and schema all come from them.
Reading what was written gives an equal problem, and writing that gives the same text.
"""

from __future__ import annotations

import json
import textwrap
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic.fields import FieldInfo

from ergowalk.errors import InputError, ProblemError
from ergowalk.problem.design import Design
from ergowalk.problem.gait_problem import GaitProblem
from ergowalk.values import Value, is_key

WIDTH = 96
"""Longest line of a commented file."""

_EXAMPLE = "see 'ergowalk init' for a commented example"


def read_problem(path: str | Path) -> GaitProblem:
    """The problem of a TOML file; a relative corridor table is looked for beside that file.

    Parameters
    ----------
    path : str or Path
        A UTF-8 text file with the fields of :class:`GaitProblem` (units in their names).

    Raises
    ------
    ProblemError, BodyError, CorridorError
        If the file cannot be read or is not TOML, a key is unknown, a value has the wrong type
        or breaks a rule, or the table of human data that it names cannot be used. The message
        names the file.
    """
    path = Path(path)
    try:
        content = path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise ProblemError(
            f"cannot be read ({reason})",
            "give a problem file; 'ergowalk init -o FILE' writes one",
            file=str(path),
        ) from None
    problem = problem_from_bytes(content, file=str(path), folder=path.absolute().parent)
    try:
        problem.human()
    except InputError as error:
        raise error.located(str(path)) from None
    return problem


def problem_from_bytes(
    content: bytes, file: str | None = None, folder: Path | None = None
) -> GaitProblem:
    """As :func:`problem_from_toml`, for the bytes of a file, which must be UTF-8 text."""
    try:
        text = content.decode("utf-8-sig")  # some editors put a byte order mark
    except UnicodeDecodeError as error:
        raise ProblemError(
            f"not UTF-8 text (byte {error.start})", "save the problem file as UTF-8", file=file
        ) from None
    return problem_from_toml(text, file=file, folder=folder)


def problem_from_toml(
    text: str, file: str | None = None, folder: Path | None = None
) -> GaitProblem:
    """The problem that a TOML text describes; the table of human data is not opened.

    Parameters
    ----------
    text : str
        TOML with the fields of :class:`GaitProblem`.
    file : str, optional
        Where the text came from, for messages.
    folder : Path, optional
        Where relative names in it start.

    Raises
    ------
    ProblemError, BodyError, CorridorError
        As :func:`read_problem`, except for the table of human data.
    """
    try:
        return problem_from_values(_parsed(text), folder)
    except InputError as error:
        raise (error.located(file) if file is not None else error) from None


def problem_from_values(values: dict[str, Any], folder: Path | None = None) -> GaitProblem:
    """The problem of the keys and values that a problem file may hold; errors as in one."""
    for name, field in GaitProblem.model_fields.items():
        if name in values and not is_key(field):
            raise ProblemError("unknown key", "remove it", field=name)
    return GaitProblem(**values, folder=folder)


def problem_to_toml(problem: GaitProblem, commented: bool = False, remark: str = "") -> str:
    """The problem as TOML with every default filled in.

    Parameters
    ----------
    problem : GaitProblem
    commented : bool
        Whether each key and table is explained by the description of its field.
    remark : str
        What else the head of a commented file says.
    """
    lines = [*(_header(remark) if commented else ()), *_table(problem, "", commented)]
    return "\n".join(lines) + "\n"


def json_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a problem file, for editors that check TOML against one."""
    schema = GaitProblem.model_json_schema()
    for name, field in GaitProblem.model_fields.items():
        if not is_key(field):
            del schema["properties"][name]
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return {**head, **_for_toml(schema)}


def _for_toml(schema: dict[str, Any]) -> dict[str, Any]:
    """A schema without what TOML cannot say (null), and with the first lines of docstrings."""
    parts = [schema, *schema["$defs"].values()]
    for part in parts:
        if "description" in part:
            part["description"] = " ".join(part["description"].split("\n\n")[0].split())
        for field in part.get("properties", {}).values():
            if {"type": "null"} in field.get("anyOf", ()):
                field["anyOf"].remove({"type": "null"})
                del field["default"]
                if len(field["anyOf"]) == 1:
                    field |= field.pop("anyOf")[0]
            if isinstance(default := field.get("default"), dict):
                field["default"] = {k: v for k, v in default.items() if v is not None}
            for choice in field.get("anyOf", ()):
                if "const" in choice:
                    choice.pop("enum", None)  # said twice by older pydantic
    return schema


def _parsed(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError:
        reason = "nested too deeply"
    except ValueError as error:  # syntax, and integers of thousands of digits
        reason = str(error)
    raise ProblemError(f"not valid TOML: {reason}", _EXAMPLE) from None


def _header(remark: str) -> list[str]:
    required = [name for name, f in GaitProblem.model_fields.items() if f.is_required()]
    sentence = (
        "A gait problem for 'ergowalk solve FILE'. SI units; the rhythm as fractions of T. "
        f"{' and '.join(required)} are required; any other key left out takes its default."
    )
    return [*_comment(sentence), *_comment(remark), ""]


def _table(value: Value, place: str, commented: bool) -> Iterator[str]:
    """The lines of one table: its own keys, then the tables below it."""
    if isinstance(value, Design):
        yield from (f"{_literal(f.path)} = {_literal((f.lowest, f.highest))}" for f in value.free)
        return
    fields = {name: f for name, f in type(value).model_fields.items() if not f.exclude}
    inner = {name: v for name in fields if isinstance(v := getattr(value, name), Value)}
    keys = {
        name: v for name in fields if name not in inner and (v := getattr(value, name)) is not None
    }
    yield from _keys(keys, fields, commented)
    for name, table in inner.items():
        given = any(_table(table, "", False))
        path = f"{place}.{name}" if place else name
        if given or commented:
            yield ""
        if commented:
            yield from _comment(fields[name].description)
        if not given:
            continue  # such a table has no defaults to show
        yield f"[{path}]"
        yield from _table(table, path, commented)


def _keys(keys: dict[str, Any], fields: dict[str, FieldInfo], commented: bool) -> Iterator[str]:
    """``key = value`` lines; comments stand behind the values where all of them fit there."""
    lines = {name: f"{name} = {_literal(value)}" for name, value in keys.items()}
    if not commented:
        yield from lines.values()
        return
    column = max(map(len, lines.values()), default=0)
    beside = {
        name: f"{line:<{column}}  # {fields[name].description}" for name, line in lines.items()
    }
    if all(len(line) <= WIDTH for line in beside.values()):
        yield from beside.values()
        return
    for name, line in lines.items():
        yield from _comment(fields[name].description)
        yield line


def _comment(text: str | None) -> list[str]:
    return textwrap.wrap(text or "", WIDTH, initial_indent="# ", subsequent_indent="# ")


def _literal(value: Any) -> str:
    if isinstance(value, str):
        # JSON's escapes are TOML's, except that TOML wants DEL escaped too.
        return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, tuple):
        return f"[{', '.join(map(_literal, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value)  # the shortest digits that read back as the same float
