"""The server of the app, which ends its solves before its connections."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Callable

import uvicorn

from ergowalk.app.desk import Desk
from ergowalk.app.routes import application

ENDING = 2
"""Seconds that answers have to end in when the server ends."""


class Server(uvicorn.Server):
    """Serves the solves of a desk.

    Parameters
    ----------
    desk : Desk
    ready : callable
        Called when the server answers.
    stop : asyncio.Event
        Ends it when set, as Ctrl-C does.
    """

    def __init__(self, desk: Desk, ready: Callable[[], None], stop: asyncio.Event) -> None:
        super().__init__(
            uvicorn.Config(
                application(desk),
                http="h11",
                loop="asyncio",
                ws="none",
                lifespan="off",
                log_config=None,
                log_level="critical",  # what goes wrong is told to the page
                access_log=False,
                server_header=False,
                proxy_headers=False,
                timeout_graceful_shutdown=ENDING,
            )
        )
        self._desk, self._ready, self._stop = desk, ready, stop

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin to answer, and say so."""
        await super().startup(sockets)
        self._ready()

    async def on_tick(self, counter: int) -> bool:
        """Whether to end, asked ten times a second."""
        return await super().on_tick(counter) or self._stop.is_set()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End solves and streams first: an open page would hold the server up."""
        await self._desk.close()
        await super().shutdown(sockets)
