"""The arguments of ``report``, ``animate``, ``figures`` and ``export``: gaits for others to see."""

from __future__ import annotations

import argparse
import re
from typing import Any

from ergowalk.cli.arguments.common import (
    add_command,
    add_gait,
    add_gaits,
    add_human,
    add_json,
    add_output,
)

FORMATS = ("csv", "mot", "grf", "sto", "trc", "mjcf", "loads")
COLUMNS = ("single", "double")


def add_report(commands: Any) -> None:
    """Add ``ergowalk report``."""
    parser = add_command(
        commands,
        "report",
        "write a page with stored gaits in motion and their figures",
        "One HTML file that needs no other and no network: the walkers laid over each other in "
        "motion, curves against human walking, energy, audit, problem file.",
    )
    add_gaits(parser)
    add_output(
        parser,
        "FILE",
        "the page; a file there is replaced (default: report.html beside the first gait)",
    )
    add_human(parser)
    add_json(parser)


def add_animate(commands: Any) -> None:
    """Add ``ergowalk animate``."""
    parser = add_command(
        commands,
        "animate",
        "write a film of stored gaits",
        "The walkers laid over each other in motion, with reactions, joint powers and contact "
        "phases. The strides close, so that the film may begin anew.",
    )
    add_gaits(parser)
    add_output(
        parser, "FILE", "the film, .mp4, .gif or .webp; a file there is replaced", required=True
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
    add_human(parser)
    add_json(parser)


def add_figures(commands: Any) -> None:
    """Add ``ergowalk figures``."""
    parser = add_command(
        commands,
        "figures",
        "write the paper's Figures 2-10 of a stored gait for a journal",
        "Drawings in pdf and svg, as wide as a column, with fonts embedded and text that can be "
        "edited.",
    )
    add_gait(parser)
    add_output(parser, "DIR", "folder for the figures (default: figures beside the gait)")
    parser.add_argument(
        "--column",
        choices=COLUMNS,
        default=COLUMNS[0],
        help="88 mm or 180 mm wide (default: %(default)s)",
    )
    add_json(parser)


def add_export(commands: Any) -> None:
    """Add ``ergowalk export``."""
    parser = add_command(
        commands,
        "export",
        "write a stored gait for other software",
        "CSV of every curve; for OpenSim coordinates and ground reactions (.mot) and joint moments "
        "(.sto) as its model gait10dof18musc has them; joint centres (.trc); the body for MuJoCo "
        "(.xml).",
    )
    add_gait(parser)
    add_output(
        parser,
        "PATH",
        "a file, whose suffix names its format, or a folder for all of them; files there "
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
    add_json(parser)


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,6})x(\d{1,6})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 960x540")
    return int(match[1]), int(match[2])
