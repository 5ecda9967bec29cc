"""Commands about problems: ``presets`` and ``init``."""

from __future__ import annotations

import os
from argparse import Namespace

from ergowalk.cli.output import write_text
from ergowalk.cli.streams import emit, emit_json
from ergowalk.errors import OutputError
from ergowalk.problem import DEFAULT_PRESET, PRESETS, preset
from ergowalk.problem.files import problem_to_toml


def run_presets(arguments: Namespace) -> None:
    """List names and summaries."""
    if arguments.json:
        entries = [{"name": p.name, "summary": p.summary} for p in PRESETS.values()]
        emit_json({"default": DEFAULT_PRESET, "presets": entries})
        return
    width = max(map(len, PRESETS))
    emit("\n".join(f"{p.name:<{width}}  {p.summary}" for p in PRESETS.values()))


def run_init(arguments: Namespace) -> None:
    """Print a commented problem file, or write a new one.

    Raises
    ------
    OutputError
        If the file exists or cannot be written.
    ProblemError
        If there is no such preset.
    """
    text = problem_to_toml(preset(arguments.preset or DEFAULT_PRESET), commented=True)
    if arguments.output is None:
        emit(text.rstrip("\n"))
        return
    if os.path.lexists(arguments.output):
        raise OutputError("exists already", "choose another name", file=str(arguments.output))
    write_text(arguments.output, text)
