"""The arguments of ``sweep`` and ``map``."""

from __future__ import annotations

from typing import Any

from ergowalk.cli.arguments.common import add_command, add_json, add_output, add_quiet, path


def add_sweep(commands: Any) -> None:
    """Add ``ergowalk sweep``."""
    parser = add_command(
        commands,
        "sweep",
        "solve many problems on a cluster",
        "A grid, a list or random values of any fields of a problem. Each case begins at the gait "
        "of its neighbour; every result stays on disk as it comes, and the same command again "
        "solves what is missing. The answer is acceptable if a gait is.",
    )
    parser.add_argument("sweep", type=path, metavar="SWEEP.toml", help="a sweep file")
    add_output(
        parser,
        "DIR",
        "folder of the results, of this sweep and of others (default: ergowalk-NAME)",
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
    add_json(parser)
    add_quiet(parser)


def add_map(commands: Any) -> None:
    """Add ``ergowalk map``."""
    parser = add_command(
        commands,
        "map",
        "draw the map of a sweep",
        "E over step length and stride time with lines of constant speed, and over speed and "
        "cadence with its valley beside the steps of people; of other fields a curve or a map. "
        "Writes map.png, map.svg and map.html, in which a click shows a gait in motion.",
    )
    parser.add_argument("folder", type=path, metavar="DIR", help="the folder of a sweep")
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
    add_output(parser, "OUT", "folder of the map (default: DIR)")
    parser.add_argument("--no-page", action="store_true", help="write no map.html")
    add_json(parser)
