"""What the arguments of several commands share."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, NoReturn

from ergowalk.errors import InputError

STATUS = (
    "Exit status: 0 an acceptable answer; 1 it ran but there is no acceptable answer; "
    "2 unusable input; 130 interrupted."
)
"""The end of every help."""

SEXES = ("male", "female")


class UsageError(InputError):
    """Arguments that make no command."""


class Parser(argparse.ArgumentParser):
    """A parser that raises :class:`UsageError` instead of printing its usage and leaving."""

    def error(self, message: str) -> NoReturn:
        """Raise the one line that the user will see."""
        raise UsageError(message, f"see '{self.prog} --help'")


def add_command(commands: Any, name: str, summary: str, description: str = "") -> Parser:
    """Add a command without arguments."""
    parser: Parser = commands.add_parser(
        name,
        help=summary,
        description=f"{summary[0].upper()}{summary[1:]}. {description}".strip(),
        epilog=STATUS,
        allow_abbrev=False,
    )
    return parser


def add_gait(parser: Parser, what: str = "a stored gait") -> None:
    """Add the one gait that a command takes."""
    parser.add_argument("gait", type=path, metavar="GAIT.nc", help=what)


def add_gaits(parser: Parser) -> None:
    """Add the gaits that a command takes, one at least."""
    parser.add_argument("gaits", nargs="+", type=path, metavar="GAIT.nc", help="stored gaits")


def add_output(parser: Parser, name: str, what: str, required: bool = False) -> None:
    """Add where results go."""
    parser.add_argument("-o", "--output", type=path, required=required, metavar=name, help=what)


def add_result_folder(parser: Parser) -> None:
    """Add the folder of a solved or measured walk."""
    add_output(
        parser, "DIR", "folder for the result; files there are replaced (default: ergowalk-NAME)"
    )


def add_preset(parser: Any, what: str) -> None:
    """Add the choice of a named problem."""
    parser.add_argument("--preset", metavar="NAME", help=f"{what} ('ergowalk presets' lists them)")


def add_human(parser: Parser) -> None:
    """Add the walker of the human means."""
    parser.add_argument(
        "--human",
        action="store_true",
        help="lay the walker of the human mean angles, on the body of the first gait, over it",
    )


def add_json(parser: Parser) -> None:
    """Add the choice of JSON instead of a table."""
    parser.add_argument("--json", action="store_true", help="print one JSON object instead")


def add_quiet(parser: Parser) -> None:
    """Add the choice of no progress."""
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")


def path(text: str) -> Path:
    """The file or folder of an argument."""
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)
