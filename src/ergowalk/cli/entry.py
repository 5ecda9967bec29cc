"""From arguments to an exit status; every failure becomes one line on standard error."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Sequence
from importlib import import_module

from ergowalk.cli.parser import build_parser
from ergowalk.cli.streams import flush, note
from ergowalk.errors import InputError

ACCEPTABLE, NOT_ACCEPTABLE, UNUSABLE_INPUT, INTERRUPTED = 0, 1, 2, 130
"""Exit statuses."""

Runner = Callable[[Namespace], bool | None]

COMMANDS = {
    "solve": ("solve", "run_solve"),
    "audit": ("gaits", "run_audit"),
    "compare": ("gaits", "run_compare"),
    "fit": ("fit", "run_fit"),
    "price": ("price", "run_price"),
    "design": ("design", "run_design"),
    "report": ("report_page", "run_report"),
    "export": ("export", "run_export"),
    "animate": ("film", "run_animate"),
    "figures": ("figures", "run_figures"),
    "sweep": ("sweep", "run_sweep"),
    "map": ("map", "run_map"),
    "presets": ("problems", "run_presets"),
    "init": ("problems", "run_init"),
    "app": ("app", "run_app"),
}
"""Module of ``ergowalk.cli`` and function of each command."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit status.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments after the program's name; those of the process by default.

    Returns
    -------
    int
        0 an acceptable answer, 1 none, 2 unusable input, 130 interrupted.
    """
    try:
        arguments = build_parser().parse_args(argv)
        accepted = runner(arguments.command)(arguments)
        return ACCEPTABLE if accepted is None or accepted else NOT_ACCEPTABLE
    except SystemExit as stop:  # argparse after --help and --version
        return int(stop.code or 0)
    except InputError as error:
        note(f"ergowalk: {error}")
        return UNUSABLE_INPUT
    except KeyboardInterrupt:
        note("ergowalk: interrupted")
        return INTERRUPTED
    finally:
        flush()


def runner(command: str) -> Runner:
    """What runs a command: it tells whether there is an acceptable answer, or None of no question.

    It is imported when it is asked for: help and presets need neither solver nor xarray.
    """
    module, function = COMMANDS[command]
    run: Runner = getattr(import_module(f"ergowalk.cli.{module}"), function)
    return run
