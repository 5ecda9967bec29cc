"""The arguments of ``presets`` and ``init``."""

from __future__ import annotations

from typing import Any

from ergowalk.cli.arguments.common import (
    SEXES,
    Parser,
    add_command,
    add_json,
    add_output,
    add_preset,
)

PERSON_LENGTHS = (
    "thigh-length",
    "shank-length",
    "ankle-height",
    "foot-length",
    "hip-to-shoulder",
    "heel-to-ball",
    "ankle-ahead-of-heel",
)
"""Lengths that may be measured: the fields of :class:`ergowalk.anthropometry.Person` in m."""


def add_presets(commands: Any) -> None:
    """Add ``ergowalk presets``."""
    add_json(add_command(commands, "presets", "list the named problems"))


def add_init(commands: Any) -> None:
    """Add ``ergowalk init``."""
    parser = add_command(
        commands,
        "init",
        "print a commented problem file to start from",
        "With --height and --mass the body is that of a person, after published tables; step "
        "length and stride time are scaled to the same Froude number.",
    )
    add_preset(parser, "start from this problem")
    add_output(parser, "FILE", "write a new file instead of printing")
    parser.add_argument(
        "--schema",
        action="store_true",
        help="print the JSON schema of problem files instead, for editors",
    )
    _add_person(parser)


def _add_person(parser: Parser) -> None:
    group = parser.add_argument_group("a person instead of the walker of the preset")
    group.add_argument("--height", type=float, metavar="M", help="body height in m")
    group.add_argument("--mass", type=float, metavar="KG", help="body mass in kg")
    group.add_argument("--sex", choices=SEXES, help="which of de Leva's tables")
    group.add_argument(
        "--table",
        choices=("dempster", "deleva"),
        help="fractions of mass and inertia (default: deleva with --sex, dempster without)",
    )
    for name in PERSON_LENGTHS:
        group.add_argument(
            f"--{name}", type=float, metavar="M", help=f"measured {name.replace('-', ' ')} in m"
        )
