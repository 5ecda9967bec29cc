"""The arguments of every command."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, NoReturn

from ergowalk import __version__
from ergowalk.errors import InputError

METHODS = ("collocation", "spline")
SOLVERS = ("ipopt", "rosenbrock")
ASKED = ("paper", "everything")

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
    _add_price(commands)
    _add_report(commands)
    _add_sweep(commands)
    _add_map(commands)
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
        help="what solves the finite problem; rosenbrock, which needs no derivatives, is for "
        "the spline method alone (default: %(default)s)",
    )
    _add_spline(parser)
    parser.add_argument(
        "--start",
        type=_path,
        metavar="GAIT.nc",
        help="a stored gait, by whatever method, from which a collocation begins",
    )
    parser.add_argument(
        "--starts",
        type=int,
        metavar="N",
        help="search N times by collocation, from the human means and from seeded disturbances "
        "of them, and keep the best",
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="S", help="of the disturbances (default: 0)"
    )
    parser.add_argument(
        "--workers",
        type=int,
        metavar="W",
        help="processes that share the starts; the answer does not depend on it (default: one "
        "for each processor)",
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


def _add_spline(parser: Parser) -> None:
    group = parser.add_argument_group("choices of the spline method, which E depends on")
    group.add_argument(
        "--knots",
        type=int,
        metavar="N",
        help="knot intervals of half a stride (default: 12 with rosenbrock, 30 with ipopt)",
    )
    group.add_argument(
        "--rho",
        type=float,
        metavar="R",
        help="freedom of the knots in (13) in s^3, 0 to interpolate (default: 1e-6)",
    )
    group.add_argument(
        "--asked",
        choices=ASKED,
        help="the measures of (19) alone, or all that the problem asks for (default: paper "
        "with rosenbrock, everything with ipopt)",
    )


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


def _add_price(commands: Any) -> None:
    parser = _command(
        commands,
        "price",
        "say what every bound and every given number of a stored gait costs",
        "From the multipliers that a collocation leaves in its file: J/m per unit of step length, "
        "stride time, limits, corridor width and body, and the price of the corridors over the "
        "stride, drawn beside the gait.",
    )
    parser.add_argument("gait", type=_path, metavar="GAIT.nc", help="a gait found by collocation")
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="DIR",
        help="folder for prices.png and prices.svg (default: that of the gait)",
    )
    _add_json(parser)


def _add_report(commands: Any) -> None:
    parser = _command(
        commands,
        "report",
        "write a page with stored gaits in motion and their figures",
        "One HTML file that needs no other and no network: the walkers laid over each other in "
        "motion, curves against human walking, energy, audit, problem file.",
    )
    parser.add_argument("gaits", nargs="+", type=_path, metavar="GAIT.nc", help="stored gaits")
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="FILE",
        help="the page; a file there is replaced (default: report.html beside the first gait)",
    )
    _add_json(parser)


def _add_sweep(commands: Any) -> None:
    parser = _command(
        commands,
        "sweep",
        "solve many problems on a cluster",
        "A grid, a list or random values of any fields of a problem. Each case begins at the gait "
        "of its neighbour; every result stays on disk as it comes, and the same command again "
        "solves what is missing. The answer is acceptable if a gait is.",
    )
    parser.add_argument("sweep", type=_path, metavar="SWEEP.toml", help="a sweep file")
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="DIR",
        help="folder of the results, of this sweep and of others (default: ergowalk-NAME)",
    )
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=int,
        metavar="N",
        help="processes on this machine; the results do not depend on it (default: one for each "
        "processor)",
    )
    where.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="Dask scheduler of a cluster that exists, as tcp://host:8786; its workers must see "
        "DIR under the same name",
    )
    parser.add_argument(
        "--retry",
        action="store_true",
        help="solve those again that failed, ran out of time or memory, or crashed",
    )
    _add_json(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")


def _add_map(commands: Any) -> None:
    parser = _command(
        commands,
        "map",
        "draw the map of a sweep",
        "E over step length and stride time with lines of constant speed, and over speed and "
        "cadence with its valley beside the steps of people; of other fields a curve or a map. "
        "Writes map.png, map.svg and map.html, in which a click shows a gait in motion.",
    )
    parser.add_argument("folder", type=_path, metavar="DIR", help="the folder of a sweep")
    parser.add_argument(
        "--sweep", metavar="NAME", help="which sweep, if DIR has several (default: the latest)"
    )
    parser.add_argument(
        "--at",
        action="append",
        default=[],
        metavar="FIELD=VALUE",
        help="show the part of the sweep with this value; may be repeated",
    )
    parser.add_argument(
        "-o", "--output", type=_path, metavar="OUT", help="folder of the map (default: DIR)"
    )
    parser.add_argument("--no-page", action="store_true", help="write no map.html")
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
