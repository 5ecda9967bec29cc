"""From arguments to an exit status; every failure becomes one line on standard error."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Sequence

from ergowalk.cli.parser import build_parser
from ergowalk.cli.streams import flush, note
from ergowalk.errors import InputError

ACCEPTABLE, NOT_ACCEPTABLE, UNUSABLE_INPUT, INTERRUPTED = 0, 1, 2, 130
"""Exit statuses."""


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
        return COMMANDS[arguments.command](arguments)
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


# Each command is imported when it is asked for: help and presets need neither solver nor xarray.


def _solve(arguments: Namespace) -> int:
    from ergowalk.cli.solve import run_solve

    return ACCEPTABLE if run_solve(arguments) else NOT_ACCEPTABLE


def _audit(arguments: Namespace) -> int:
    from ergowalk.cli.gaits import run_audit

    return ACCEPTABLE if run_audit(arguments) else NOT_ACCEPTABLE


def _compare(arguments: Namespace) -> int:
    from ergowalk.cli.gaits import run_compare

    run_compare(arguments)
    return ACCEPTABLE


def _fit(arguments: Namespace) -> int:
    from ergowalk.cli.fit import run_fit

    return ACCEPTABLE if run_fit(arguments) else NOT_ACCEPTABLE


def _price(arguments: Namespace) -> int:
    from ergowalk.cli.price import run_price

    run_price(arguments)
    return ACCEPTABLE


def _design(arguments: Namespace) -> int:
    from ergowalk.cli.design import run_design

    return ACCEPTABLE if run_design(arguments) else NOT_ACCEPTABLE


def _report(arguments: Namespace) -> int:
    from ergowalk.cli.report_page import run_report

    run_report(arguments)
    return ACCEPTABLE


def _export(arguments: Namespace) -> int:
    from ergowalk.cli.export import run_export

    run_export(arguments)
    return ACCEPTABLE


def _animate(arguments: Namespace) -> int:
    from ergowalk.cli.film import run_animate

    run_animate(arguments)
    return ACCEPTABLE


def _figures(arguments: Namespace) -> int:
    from ergowalk.cli.figures import run_figures

    run_figures(arguments)
    return ACCEPTABLE


def _sweep(arguments: Namespace) -> int:
    from ergowalk.cli.sweep import run_sweep

    return ACCEPTABLE if run_sweep(arguments) else NOT_ACCEPTABLE


def _map(arguments: Namespace) -> int:
    from ergowalk.cli.map import run_map

    run_map(arguments)
    return ACCEPTABLE


def _presets(arguments: Namespace) -> int:
    from ergowalk.cli.problems import run_presets

    run_presets(arguments)
    return ACCEPTABLE


def _init(arguments: Namespace) -> int:
    from ergowalk.cli.problems import run_init

    run_init(arguments)
    return ACCEPTABLE


def _app(arguments: Namespace) -> int:
    from ergowalk.cli.app import run_app

    run_app(arguments)
    return ACCEPTABLE


COMMANDS: dict[str, Callable[[Namespace], int]] = {
    "solve": _solve,
    "audit": _audit,
    "compare": _compare,
    "fit": _fit,
    "price": _price,
    "design": _design,
    "report": _report,
    "export": _export,
    "animate": _animate,
    "figures": _figures,
    "sweep": _sweep,
    "map": _map,
    "presets": _presets,
    "init": _init,
    "app": _app,
}
