"""The arguments of ``solve`` and ``design``, which look for gaits."""

from __future__ import annotations

from typing import Any

from ergowalk.cli.arguments.common import (
    Parser,
    add_command,
    add_json,
    add_preset,
    add_quiet,
    add_result_folder,
    path,
)

METHODS = ("collocation", "spline")
SOLVERS = ("ipopt", "rosenbrock")
ASKED = ("paper", "everything")


def add_solve(commands: Any) -> None:
    """Add ``ergowalk solve``."""
    parser = add_command(
        commands,
        "solve",
        "solve a gait problem",
        "Writes gait.nc, problem.toml with all defaults filled in, figures and report.md, and "
        "prints a short table. Without a problem, the paper's case is solved.",
    )
    which = parser.add_mutually_exclusive_group()
    which.add_argument(
        "problem", nargs="?", type=path, metavar="PROBLEM.toml", help="a problem file"
    )
    add_preset(which, "solve a named problem instead")
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
    _add_starts(parser)
    add_result_folder(parser)
    add_json(parser)
    add_quiet(parser)
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


def _add_starts(parser: Parser) -> None:
    parser.add_argument(
        "--start",
        type=path,
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


def add_design(commands: Any) -> None:
    """Add ``ergowalk design``."""
    parser = add_command(
        commands,
        "design",
        "find one design of body or devices for several operating points",
        "The numbers of the table [design] make the weighted mean of what the gaits of all points "
        "cost least. Writes point-1.nc, point-2.nc, ... and prints a short table.",
    )
    parser.add_argument(
        "design",
        type=path,
        metavar="DESIGN.toml",
        help="a design file: a problem or a preset, a table [design], a table [[point]] for each "
        "operating point",
    )
    add_result_folder(parser)
    add_json(parser)
    add_quiet(parser)
