"""The command ``report``: stored gaits as one page to look at."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from ergowalk.cli.output import write_text
from ergowalk.cli.streams import emit, emit_json
from ergowalk.errors import OutputError
from ergowalk.solution import Solution

PAGE = "report.html"


def run_report(arguments: Namespace) -> None:
    """Write the report of some gaits beside the first of them, or to the file asked for.

    Raises
    ------
    GaitFileError, CorridorError
        If a file is no gait that can be read, or its table of human data is lost. Nothing is
        written then.
    OutputError
        If the page cannot be written, or would replace one of the gaits.
    """
    from ergowalk.viewer import report_html

    paths: list[Path] = arguments.gaits
    target: Path = arguments.output or paths[0].parent / PAGE
    solutions = [Solution.load(path) for path in paths]
    if any(target.exists() and target.samefile(path) for path in paths):
        raise OutputError("is one of the gaits", "choose another file with -o", file=str(target))
    write_text(target, report_html(solutions, [str(path) for path in paths], arguments.human))
    if arguments.json:
        gaits = [_as_dict(path, s) for path, s in zip(paths, solutions, strict=True)]
        emit_json({"report": str(target), "bytes": target.stat().st_size, "gaits": gaits})
    else:
        lines = [_line(path, s) for path, s in zip(paths, solutions, strict=True)]
        emit("\n".join([*lines, f"report: {target}"]))


def _as_dict(path: Path, solution: Solution) -> dict[str, object]:
    return {
        "file": str(path),
        "acceptable": solution.acceptable,
        "energy_per_metre": solution.energy_per_metre,
        "energy_error": solution.energy_error,
        "limits": solution.problem.conditions(),
    }


def _line(path: Path, solution: Solution) -> str:
    found = _as_dict(path, solution)
    if solution.measured:
        return f"{path}: E = {found['energy_per_metre']:.2f} J/m, measured"
    mark = "" if found["acceptable"] else " (NOT ACCEPTABLE)"
    return f"{path}{mark}: E = {found['energy_per_metre']:.2f} J/m with {found['limits']}"
