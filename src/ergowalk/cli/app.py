"""Command ``app``: a page in the browser instead of arguments."""

from __future__ import annotations

from argparse import Namespace

from ergowalk.app.options import Options
from ergowalk.app.serving import serve
from ergowalk.cli.streams import emit, note


def run_app(arguments: Namespace) -> None:
    """Serve the app until Ctrl-C.

    Raises
    ------
    InputError
        If an option is out of range, the address cannot be had, or packages are missing.
    """
    asked = {
        "host": arguments.host,
        "port": arguments.port,
        "workers": arguments.workers,
        "queue": arguments.queue,
        "time_limit_s": arguments.time_limit,
        "upload_limit_kib": arguments.upload_limit,
        "grace_s": arguments.grace,
    }
    options = Options(**{name: value for name, value in asked.items() if value is not None})
    if (warning := options.warning()) is not None:
        note(f"ergowalk: {warning}")
    serve(options, emit)
