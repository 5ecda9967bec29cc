"""From what a page sends to a gait problem; errors are the library's own sentences."""

from __future__ import annotations

import json
from typing import Any

from ergowalk.body import Body
from ergowalk.corridors import BUILT_IN
from ergowalk.errors import CorridorError, InputError, ProblemError
from ergowalk.problem import DEFAULT_PRESET, PRESETS, GaitProblem
from ergowalk.problem.files import problem_from_bytes, problem_from_values

LONGEST_NAME = 60
"""Characters that are shown of a name."""


def form() -> dict[str, Any]:
    """What a page needs to show its form: presets with their values, and what can be chosen."""
    return {
        "presets": [
            {"name": p.name, "summary": p.summary, "problem": values_of(p.build())}
            for p in PRESETS.values()
        ],
        "preset": DEFAULT_PRESET,
        "sources": list(BUILT_IN),
    }


def values_of(problem: GaitProblem) -> dict[str, Any]:
    """The keys and values that a problem file would hold, as JSON has them."""
    return problem.model_dump(mode="json")


def short(name: str, otherwise: str = "custom") -> str:
    """A name as one line that fits a list."""
    line = " ".join("".join(c if c.isprintable() else " " for c in name).split()) or otherwise
    return line if len(line) <= LONGEST_NAME else f"{line[: LONGEST_NAME - 1]}…"


def title_of(problem: GaitProblem) -> str:
    """One line that tells a problem from others."""
    speed = 2 * problem.step_length_m / problem.stride_time_s
    walk = f"step {problem.step_length_m:g} m, stride {problem.stride_time_s:g} s"
    return f"{short(problem.name)}: {walk}, {speed:.3g} m/s"


def uploaded_problem(content: bytes, file: str) -> GaitProblem:
    """The problem of an uploaded file.

    Raises
    ------
    ProblemError, BodyError, CorridorError
        As :func:`ergowalk.problem.files.read_problem`; also if it names a file of human data, as
        no name from a page is looked up on this machine.
    """
    try:
        return _without_files(problem_from_bytes(content))
    except InputError as error:
        raise error.located(short(file, "problem file")) from None


def asked_problem(content: bytes) -> GaitProblem:
    """The problem that a page asks to be solved: JSON with ``problem`` and perhaps ``size``.

    ``problem`` has the keys and values of a problem file; ``size`` has ``height_m``, ``mass_kg``
    and perhaps ``sex`` of a person whom the body is scaled to.

    Raises
    ------
    ProblemError, BodyError, CorridorError
        As :func:`uploaded_problem`.
    """
    asked = _object(content)
    values = asked.get("problem")
    if not isinstance(values, dict):
        raise ProblemError("should be a table of keys and values", "send one", field="problem")
    problem = _without_files(problem_from_values(values))
    size = asked.get("size")
    return problem if size is None else problem.replace(body=_scaled(size))


def _object(content: bytes) -> dict[str, Any]:
    try:
        found = json.loads(content)
        json.dumps(found, ensure_ascii=False).encode()  # half a letter is no text
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise ProblemError("not a JSON object of UTF-8 text", "send the form of the page")
    return found


def _without_files(problem: GaitProblem) -> GaitProblem:
    source = problem.corridors.source
    if source not in BUILT_IN:
        raise CorridorError(
            "names a file, and the app opens none on this machine",
            f"choose one of {', '.join(BUILT_IN)}, or use 'ergowalk solve' at the command line",
            field="corridors.source",
            value=source,
        )
    return problem


def _scaled(size: Any) -> Body:
    """The body of a person of a height and a mass."""
    if not isinstance(size, dict):
        raise ProblemError("cannot be used", "leave it out", field="size")
    numbers: dict[str, Any] = {name: size.get(name) for name in ("height_m", "mass_kg")}
    for name, value in numbers.items():
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise ProblemError("should be a valid number", "give one", field=name, value=value)
    return Body.from_height_mass(**numbers, sex=size.get("sex"))
