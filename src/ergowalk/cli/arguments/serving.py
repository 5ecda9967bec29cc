"""The arguments of ``app``."""

from __future__ import annotations

from typing import Any

from ergowalk.cli.arguments.common import add_command


def add_app(commands: Any) -> None:
    """Add ``ergowalk app``."""
    parser = add_command(
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
