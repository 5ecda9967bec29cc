"""The command ``export``: a stored gait for other software."""

from __future__ import annotations

from argparse import Namespace
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from ergowalk.cli.arguments.common import UsageError
from ergowalk.cli.output import result_folder, write_text
from ergowalk.cli.streams import emit, emit_json
from ergowalk.errors import InputError, OutputError
from ergowalk.solution import Solution

if TYPE_CHECKING:
    from ergowalk.io import Format

FOLDER = "export"
"""Folder beside the gait, where no other is named."""


def run_export(arguments: Namespace) -> None:
    """Write a gait in the formats asked for, and say what was written.

    Raises
    ------
    GaitFileError, BodyError
        If the file is no gait that can be read, or its body has no rigid bodies. Nothing is
        written then.
    UsageError
        If no format is asked for, or several in one file.
    OutputError
        If a file cannot be written, or would replace the gait.
    """
    path: Path = arguments.gait
    solution = Solution.load(path)
    folder, targets = _targets(arguments)
    texts: dict[str, str] = {}
    for name, format_ in targets.items():
        if (folder / name).exists() and (folder / name).samefile(path):
            raise OutputError("is the gait", "choose another file with -o", file=str(folder / name))
        try:
            texts[name] = format_.text(solution.dataset, arguments.rate, arguments.strides)
        except InputError as error:
            raise _told(error, path) from None
    with result_folder(folder, texts) if _is_folder(arguments.output) else nullcontext():
        for name, text in texts.items():
            write_text(folder / name, text)
    _tell(arguments, solution, folder, targets)


def _targets(arguments: Namespace) -> tuple[Path, dict[str, Format]]:
    """The folder, and the format of each file in it."""
    from ergowalk.io import FORMATS, format_of

    output: Path | None = arguments.output
    asked = [FORMATS[name] for name in dict.fromkeys(arguments.format or ())]
    if output is None:
        output = arguments.gait.parent / FOLDER
    elif not _is_folder(output):
        if len(asked) > 1:
            raise UsageError(
                "several formats for one file", "give one, or a folder with -o", field="--format"
            )
        format_ = asked[0] if asked else format_of(output.name)
        if format_ is None:
            known = ", ".join(dict.fromkeys(f.suffix for f in FORMATS.values()))
            raise UsageError(
                "has a suffix of no known format",
                f"end it on {known}, say which with --format, or give a folder",
                field="--output",
                value=str(output),
            )
        return output.parent, {output.name: format_}
    return output, {f.file: f for f in asked or FORMATS.values()}


def _is_folder(output: Path | None) -> bool:
    """Whether files go into the place: a folder that is there, or a name without a suffix."""
    return output is None or output.is_dir() or not output.suffix


def _tell(
    arguments: Namespace, solution: Solution, folder: Path, targets: dict[str, Format]
) -> None:
    if arguments.json:
        emit_json(
            {
                "file": str(arguments.gait),
                "acceptable": solution.acceptable,
                "energy_per_metre": solution.energy_per_metre,
                "written": [
                    {"file": str(folder / name), "format": f.name, "what": f.summary}
                    for name, f in targets.items()
                ],
            }
        )
        return
    mark = "" if solution.acceptable else " (NOT ACCEPTABLE)"
    limits = solution.problem.limits.sentence()
    width = max(len(str(folder / name)) for name in targets)
    lines = [f"{folder / name!s:<{width}}  {f.summary}" for name, f in targets.items()]
    head = f"{arguments.gait}{mark}: E = {solution.energy_per_metre:.2f} J/m with {limits}"
    emit("\n".join([head, *lines]))


def _told(error: InputError, path: Path) -> InputError:
    """The error with what it is about: an option, or the file."""
    if error.field in ("rate", "strides"):
        error.field = f"--{error.field}"
        return error
    return error.located(str(path))
