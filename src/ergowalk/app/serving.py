"""The server as a whole: a socket, the app behind it, and a quiet end."""

from __future__ import annotations

import asyncio
import socket
import sys
from collections.abc import Callable, Sequence
from functools import partial
from importlib.util import find_spec

from ergowalk.app.options import Options
from ergowalk.errors import InputError

NEEDED = ("starlette", "uvicorn")
"""Packages of the extra ``app``."""


def serve(
    options: Options,
    announce: Callable[[str], None] = print,
    command: Sequence[str] | None = None,
) -> None:
    """Serve the app until Ctrl-C, which ends every solve.

    Parameters
    ----------
    options : Options
    announce : callable
        Takes the address, when the server answers there.
    command : sequence of str, optional
        Starts a worker; :mod:`ergowalk.app.worker` by default.

    Raises
    ------
    InputError
        If the packages of the extra ``app`` are missing, or the address cannot be had.
    """
    _check_packages()
    with bound_socket(options) as listening:
        try:
            asyncio.run(served(listening, options, announce, command))
        except KeyboardInterrupt:  # how a server is ended
            return


async def served(
    listening: socket.socket,
    options: Options,
    announce: Callable[[str], None] = print,
    command: Sequence[str] | None = None,
    stop: asyncio.Event | None = None,
) -> None:
    """Serve on a socket until a signal, or until ``stop`` is set."""
    from ergowalk.app.desk import Desk
    from ergowalk.app.process import COMMAND
    from ergowalk.app.server import Server

    port = int(listening.getsockname()[1])
    desk = Desk(options.replace(port=port), command or COMMAND)
    try:
        ready = partial(announce, address(options, port))
        await Server(desk, ready, stop or asyncio.Event()).serve([listening])
    finally:
        await desk.close()


def address(options: Options, port: int) -> str:
    """Where a browser finds the server."""
    everywhere = {"0.0.0.0": "127.0.0.1", "::": "::1"}
    host = everywhere.get(options.host, options.host)
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/"


def bound_socket(options: Options) -> socket.socket:
    """A socket that listens where the options say.

    Raises
    ------
    InputError
        If that cannot be had.
    """
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(
            options.host, options.port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listening = socket.socket(family, kind, protocol)
    except OSError as error:
        raise _unusable(options, "host", options.host, error) from None
    try:
        if sys.platform != "win32":  # there it would share the port with another server
            listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(place)
        listening.listen(128)
    except OSError as error:
        listening.close()
        raise _unusable(options, "port", options.port, error) from None
    return listening


def _unusable(options: Options, field: str, value: object, error: OSError) -> InputError:
    remedy = {
        "host": "give a name or an address of this machine",
        "port": "choose another one with --port, 0 for any free one",
    }
    return InputError(
        f"cannot be used ({error.strerror or error})", remedy[field], field=field, value=value
    )


def _check_packages() -> None:
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise InputError(
            f"the app needs {' and '.join(missing)}, which {'are' if missing[1:] else 'is'} not "
            "installed",
            "run pip install 'ergowalk[app]'",
        )
