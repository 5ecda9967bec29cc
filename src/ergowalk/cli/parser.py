"""The parser of the command line, put together from the arguments of every command."""

from __future__ import annotations

from ergowalk import __version__
from ergowalk.cli.arguments.checking import add_audit, add_compare, add_price
from ergowalk.cli.arguments.common import STATUS, Parser
from ergowalk.cli.arguments.measuring import add_fit
from ergowalk.cli.arguments.problems import add_init, add_presets
from ergowalk.cli.arguments.serving import add_app
from ergowalk.cli.arguments.showing import add_animate, add_export, add_figures, add_report
from ergowalk.cli.arguments.solving import add_design, add_solve
from ergowalk.cli.arguments.sweeping import add_map, add_sweep

IN_ORDER = (
    add_solve,
    add_audit,
    add_compare,
    add_fit,
    add_price,
    add_design,
    add_report,
    add_export,
    add_animate,
    add_figures,
    add_sweep,
    add_map,
    add_presets,
    add_init,
    add_app,
)
"""Every command, as the help lists them."""


def build_parser() -> Parser:
    """The parser of the command line; ``command`` names the command that was chosen."""
    parser = Parser(
        prog="ergowalk",
        description="Energy-optimal walking of a nine-link biped.",
        epilog=STATUS,
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"ergowalk {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add in IN_ORDER:
        add(commands)
    return parser
