"""The arguments of every command."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any, NoReturn

from ergowalk import __version__
from ergowalk.errors import InputError

FORMATS = ("csv", "mot", "grf", "sto", "trc", "mjcf", "loads")
METHODS = ("collocation", "spline")
SOLVERS = ("ipopt", "rosenbrock")
ASKED = ("paper", "everything")
COLUMNS = ("single", "double")

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
    _add_fit(commands)
    _add_price(commands)
    _add_design(commands)
    _add_report(commands)
    _add_export(commands)
    _add_animate(commands)
    _add_figures(commands)
    _add_sweep(commands)
    _add_map(commands)
    _add_presets(commands)
    _add_init(commands)
    _add_app(commands)
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
        "--recheck",
        action="store_true",
        help="with --start: check the mesh on a finer one even where the check of the start holds",
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


def _add_fit(commands: Any) -> None:
    parser = _command(
        commands,
        "fit",
        "turn a recorded walk into this person's problem",
        "Measures joint angles, moments, powers and the energy per metre of a recorded walk and "
        "writes problem.toml and corridors.csv, which 'ergowalk solve' takes, and measured.nc, "
        "which 'ergowalk compare' and 'ergowalk report' take.",
    )
    parser.add_argument(
        "files",
        nargs="+",
        type=_path,
        metavar="FILE",
        help="the files of one trial: C3D, TRC or a table (CSV, TSV, TXT) with the markers, and "
        "MOT, STO or tables with forces",
    )
    parser.add_argument(
        "--static", type=_path, metavar="FILE", help="a trial of the person standing still"
    )
    parser.add_argument(
        "--markers", metavar="SET", help="a marker set by name or a TOML file (default: by names)"
    )
    parser.add_argument("--units", choices=("mm", "cm", "m"), help="unit of the markers' lengths")
    parser.add_argument(
        "--flip-forces", action="store_true", help="the plates give the force on the ground"
    )
    parser.add_argument(
        "--mass", type=float, metavar="KG", help="body mass (default: what the plates carry)"
    )
    parser.add_argument(
        "--height", type=float, metavar="M", help="body height (default: by the legs)"
    )
    parser.add_argument(
        "--sex",
        choices=("male", "female"),
        help="de Leva's table of segments instead of Dempster's",
    )
    parser.add_argument(
        "--cutoff",
        type=float,
        default=6.0,
        metavar="HZ",
        help="cut-off of the zero-lag filter of markers (default: %(default)s)",
    )
    parser.add_argument(
        "--force-cutoff",
        type=float,
        metavar="HZ",
        help="the same for forces (default: what the rate of the markers cannot hold)",
    )
    parser.add_argument(
        "--sd-floor",
        type=float,
        default=5.0,
        metavar="DEG",
        help="least standard deviation of an angle in the corridors (default: %(default)s)",
    )
    parser.add_argument(
        "--kinematic-events", action="store_true", help="find contacts without the plates"
    )
    parser.add_argument("--name", help="a name for the walk (default: that of the first file)")
    parser.add_argument(
        "--solve",
        action="store_true",
        help="also find the cheapest walk in the same corridors, into DIR/solved",
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


def _add_design(commands: Any) -> None:
    parser = _command(
        commands,
        "design",
        "find one design of body or devices for several operating points",
        "The numbers of the table [design] make the weighted mean of what the gaits of all points "
        "cost least. Writes point-1.nc, point-2.nc, ... and prints a short table.",
    )
    parser.add_argument(
        "design",
        type=_path,
        metavar="DESIGN.toml",
        help="a design file: a problem or a preset, a table [design], a table [[point]] for each "
        "operating point",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="DIR",
        help="folder for the gaits; files there are replaced (default: ergowalk-NAME)",
    )
    _add_json(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")


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
    _add_human(parser)
    _add_json(parser)


def _add_animate(commands: Any) -> None:
    parser = _command(
        commands,
        "animate",
        "write a film of stored gaits",
        "The walkers laid over each other in motion, with reactions, joint powers and contact "
        "phases. The strides close, so that the film may begin anew.",
    )
    parser.add_argument("gaits", nargs="+", type=_path, metavar="GAIT.nc", help="stored gaits")
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        required=True,
        metavar="FILE",
        help="the film, .mp4, .gif or .webp; a file there is replaced",
    )
    parser.add_argument(
        "--size",
        type=_size,
        default=(960, 540),
        metavar="WxH",
        help="width and height in pixels (default: 960x540)",
    )
    parser.add_argument(
        "--fps", type=float, default=50.0, metavar="N", help="frames per second (default: 50)"
    )
    parser.add_argument(
        "--strides",
        type=int,
        metavar="N",
        help="how many (default: 4 in an mp4, 1 in the others, which begin anew by themselves)",
    )
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="X", help="0.25 for slow motion (default: 1)"
    )
    parser.add_argument("--trail", action="store_true", help="draw the cyclogram behind the walker")
    parser.add_argument("--dark", action="store_true", help="light on dark")
    _add_human(parser)
    _add_json(parser)


def _add_figures(commands: Any) -> None:
    parser = _command(
        commands,
        "figures",
        "write the paper's Figures 2-10 of a stored gait for a journal",
        "Drawings in pdf and svg, as wide as a column, with fonts embedded and text that can be "
        "edited.",
    )
    parser.add_argument("gait", type=_path, metavar="GAIT.nc", help="a stored gait")
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="DIR",
        help="folder for the figures (default: figures beside the gait)",
    )
    parser.add_argument(
        "--column",
        choices=COLUMNS,
        default=COLUMNS[0],
        help="88 mm or 180 mm wide (default: %(default)s)",
    )
    _add_json(parser)


def _add_export(commands: Any) -> None:
    parser = _command(
        commands,
        "export",
        "write a stored gait for other software",
        "CSV of every curve; for OpenSim coordinates and ground reactions (.mot) and joint moments "
        "(.sto) as its model gait10dof18musc has them; joint centres (.trc); the body for MuJoCo "
        "(.xml).",
    )
    parser.add_argument("gait", type=_path, metavar="GAIT.nc", help="a stored gait")
    parser.add_argument(
        "-o",
        "--output",
        type=_path,
        metavar="PATH",
        help="a file, whose suffix names its format, or a folder for all of them; files there "
        "are replaced (default: folder export beside the gait)",
    )
    parser.add_argument(
        "--format",
        action="append",
        choices=FORMATS,
        help="this format, whatever the suffix; in a folder, only the formats asked for",
    )
    parser.add_argument(
        "--rate",
        type=float,
        default=200.0,
        metavar="HZ",
        help="samples per second of .mot, .sto and .trc (default: 200)",
    )
    parser.add_argument(
        "--strides",
        type=int,
        default=1,
        metavar="N",
        help="strides in .mot, .sto and .trc, each a stride length further on (default: 1)",
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
    parser = _command(
        commands,
        "init",
        "print a commented problem file to start from",
        "With --height and --mass the body is that of a person, after published tables; step "
        "length and stride time are scaled to the same Froude number.",
    )
    _add_preset(parser, "start from this problem")
    parser.add_argument(
        "-o", "--output", type=_path, metavar="FILE", help="write a new file instead of printing"
    )
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
    group.add_argument("--sex", choices=("male", "female"), help="which of de Leva's tables")
    group.add_argument(
        "--table",
        choices=("dempster", "deleva"),
        help="fractions of mass and inertia (default: deleva with --sex, dempster without)",
    )
    for name in PERSON_LENGTHS:
        group.add_argument(
            f"--{name}", type=float, metavar="M", help=f"measured {name.replace('-', ' ')} in m"
        )


def _add_app(commands: Any) -> None:
    parser = _command(
        commands,
        "app",
        "serve a page to set problems, watch their solves and see the walkers",
        "Prints the address of the page and serves it until Ctrl-C. Needs the packages of "
        "pip install 'ergowalk[app]'.",
    )
    numbers = (
        ("--port", int, "P", 8765, "port, 0 for any free one"),
        ("--workers", int, "W", None, "solves at once (default: one for each processor)"),
        ("--queue", int, "N", 8, "solves that may wait"),
        ("--time-limit", float, "S", 600.0, "seconds after which a solve is ended"),
        ("--upload-limit", int, "KIB", 256, "size of the largest problem file"),
        ("--grace", float, "S", 15.0, "seconds that a solve goes on when its page is closed"),
    )
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="H",
        help="name or address to serve on; others than the default may let other machines in "
        "(default: %(default)s)",
    )
    for option, kind, name, default, words in numbers:
        told = "" if default is None else " (default: %(default)s)"
        parser.add_argument(option, type=kind, default=default, metavar=name, help=words + told)


def _add_preset(parser: Any, what: str) -> None:
    parser.add_argument("--preset", metavar="NAME", help=f"{what} ('ergowalk presets' lists them)")


def _add_human(parser: Parser) -> None:
    parser.add_argument(
        "--human",
        action="store_true",
        help="lay the walker of the human mean angles, on the body of the first gait, over it",
    )


def _add_json(parser: Parser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object instead")


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,6})x(\d{1,6})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 960x540")
    return int(match[1]), int(match[2])


def _path(text: str) -> Path:
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)
