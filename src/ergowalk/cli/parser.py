"""The arguments of every command."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, NoReturn

from ergowalk import __version__
from ergowalk.errors import InputError

METHODS = ("collocation",)
SOLVERS = ("ipopt",)

_STATUS = (
    "Exit status: 0 an acceptable answer; 1 it ran but there is no acceptable answer; "
    "2 unusable input; 130 interrupted."
)


class UsageError(InputError):
    """Arguments that make no command."""


class Parser(argparse.ArgumentParser):
    """A parser that raises :class:`UsageError` instead of printing its usage and leaving."""

    def error(self, message: str) -> NoReturn:
        """Raise the one line that the user will see."""
        raise UsageError(message, f"see '{self.prog} --help'")


def build_parser() -> Parser:
    """The parser of the command line; ``command`` names the command that was chosen."""
    parser = Parser(
        prog="ergowalk",
        description="Energy-optimal walking of a nine-link biped.",
        epilog=_STATUS,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"ergowalk {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_solve(commands)
    _add_audit(commands)
    _add_compare(commands)
    _add_presets(commands)
    _add_init(commands)
    return parser


def _command(commands: Any, name: str, summary: str, description: str = "") -> Parser:
    parser: Parser = commands.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}. {description}".strip(),
        epilog=_STATUS,
        allow_abbrev=False,
    )
    return parser


def _add_solve(commands: Any) -> None:
    parser = _command(
        commands,
        "solve",
        "solve a gait problem",
        "Writes gait.nc, problem.toml with all defaults filled in, figures and report.md, and "
        "prints a short table. Without a problem, the paper's case is solved.",
    )
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "problem", nargs="?", type=_path, metavar="PROBLEM.toml", help="a problem file"
    )
    _add_preset(which, "solve a named problem instead")
    parser.add_argument(
        "--method",
        choices=METHODS,
        default=METHODS[0],
        help="how the problem becomes finite (default: %(default)s)",
    )
    parser.add_argument(
        "--solver",
        choices=SOLVERS,
        default=SOLVERS[0],
        help="what solves the finite problem (default: %(default)s)",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="DIR",
        help="folder for the result; files there are replaced (default: ergowalk-NAME)",
    )
    _add_json(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")
    parser.add_argument("--no-figures", action="store_true", help="write no figures")


def _add_audit(commands: Any) -> None:
    parser = _command(
        commands,
        "audit",
        "check a stored gait from its curves alone",
        "Recomputes every residual, with nothing taken from the solver, and exits with 1 if one "
        "is above its tolerance.",
    )
    parser.add_argument("gait", type=_path, metavar="GAIT.nc", help="a stored gait")
    _add_json(parser)


def _add_compare(commands: Any) -> None:
    parser = _command(
        commands,
        "compare",
        "compare stored gaits with human walking",
        "Each curve against the human mean and standard deviation that its problem names.",
    )
    parser.add_argument("gaits", nargs="+", type=_path, metavar="GAIT.nc", help="stored gaits")
    _add_json(parser)


def _add_presets(commands: Any) -> None:
    _add_json(_command(commands, "presets", "list the named problems"))


def _add_init(commands: Any) -> None:
    parser = _command(commands, "init", "print a commented problem file to start from")
    _add_preset(parser, "start from this problem")
    parser.add_argument(
        "-o", "--output", type=_path, metavar="FILE", help="write a new file instead of printing"
    )


def _add_preset(parser: Any, what: str) -> None:
    parser.add_argument("--preset", metavar="NAME", help=f"{what} ('ergowalk presets' lists them)")


def _add_json(parser: Parser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object instead")


def _path(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)
