"""The arguments of ``audit``, ``compare`` and ``price``, which say how good stored gaits are."""

from __future__ import annotations

from typing import Any

from ergowalk.cli.arguments.common import add_command, add_gait, add_gaits, add_json, add_output


def add_audit(commands: Any) -> None:
    """Add ``ergowalk audit``."""
    parser = add_command(
        commands,
        "audit",
        "check a stored gait from its curves alone",
        "Recomputes every residual, with nothing taken from the solver, and exits with 1 if one "
        "is above its tolerance.",
    )
    add_gait(parser)
    add_json(parser)


def add_compare(commands: Any) -> None:
    """Add ``ergowalk compare``."""
    parser = add_command(
        commands,
        "compare",
        "compare stored gaits with human walking",
        "Each curve against the human mean and standard deviation that its problem names.",
    )
    add_gaits(parser)
    add_json(parser)


def add_price(commands: Any) -> None:
    """Add ``ergowalk price``."""
    parser = add_command(
        commands,
        "price",
        "say what every bound and every given number of a stored gait costs",
        "From the multipliers that a collocation leaves in its file: J/m per unit of step length, "
        "stride time, limits, corridor width and body, and the price of the corridors over the "
        "stride, drawn beside the gait.",
    )
    add_gait(parser, "a gait found by collocation")
    add_output(parser, "DIR", "folder for prices.png and prices.svg (default: that of the gait)")
    add_json(parser)
