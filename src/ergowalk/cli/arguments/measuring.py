"""The arguments of ``fit``."""

from __future__ import annotations

from typing import Any

from ergowalk.cli.arguments.common import (
    SEXES,
    Parser,
    add_command,
    add_json,
    add_quiet,
    add_result_folder,
    path,
)


def add_fit(commands: Any) -> None:
    """Add ``ergowalk fit``."""
    parser = add_command(
        commands,
        "fit",
        "turn a recorded walk into this person's problem",
        "Measures joint angles, moments, powers and the energy per metre of a recorded walk and "
        "writes problem.toml and corridors.csv, which 'ergowalk solve' takes, and measured.nc, "
        "which 'ergowalk compare' and 'ergowalk report' take.",
    )
    _add_recording(parser)
    _add_person(parser)
    _add_treatment(parser)
    parser.add_argument("--name", help="a name for the walk (default: that of the first file)")
    parser.add_argument(
        "--solve",
        action="store_true",
        help="also find the cheapest walk in the same corridors, into DIR/solved",
    )
    add_result_folder(parser)
    add_json(parser)
    add_quiet(parser)


def _add_recording(parser: Parser) -> None:
    parser.add_argument(
        "files",
        nargs="+",
        type=path,
        metavar="FILE",
        help="the files of one trial: C3D, TRC or a table (CSV, TSV, TXT) with the markers, and "
        "MOT, STO or tables with forces",
    )
    parser.add_argument(
        "--static", type=path, metavar="FILE", help="a trial of the person standing still"
    )
    parser.add_argument(
        "--markers", metavar="SET", help="a marker set by name or a TOML file (default: by names)"
    )
    parser.add_argument("--units", choices=("mm", "cm", "m"), help="unit of the markers' lengths")
    parser.add_argument(
        "--flip-forces", action="store_true", help="the plates give the force on the ground"
    )


def _add_person(parser: Parser) -> None:
    parser.add_argument(
        "--mass", type=float, metavar="KG", help="body mass (default: what the plates carry)"
    )
    parser.add_argument(
        "--height", type=float, metavar="M", help="body height (default: by the legs)"
    )
    parser.add_argument(
        "--sex", choices=SEXES, help="de Leva's table of segments instead of Dempster's"
    )


def _add_treatment(parser: Parser) -> None:
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
