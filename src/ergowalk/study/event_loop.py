"""The loop in which Dask talks to a cluster, in a thread that may take its time to start."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Any

from ergowalk.errors import SweepError

START_S, STOP_S = 120.0, 10.0
"""How long the thread may take to start, and to end."""


@contextmanager
def event_loop() -> Iterator[Any]:
    """A running loop to give to Dask's cluster and client.

    Without one they start their own, and stop with an AssertionError where its thread has not come
    to run within 10 s: too little on a machine that has far more to do than it can.

    Raises
    ------
    SweepError
        If even :data:`START_S` do not suffice.
    """
    from tornado.ioloop import IOLoop

    running: Future[tuple[Any, asyncio.Event]] = Future()

    async def run() -> None:
        ended = asyncio.Event()
        running.set_result((IOLoop.current(), ended))
        await ended.wait()

    thread = threading.Thread(target=lambda: asyncio.run(run()), name="sweep", daemon=True)
    thread.start()
    try:
        loop, ended = running.result(START_S)
    except TimeoutError:
        raise SweepError(
            f"could not start a thread within {START_S:g} s",
            "give the machine less to do at once, then start the same sweep again",
            field="cluster",
        ) from None
    try:
        yield loop
    finally:
        loop.add_callback(ended.set)
        thread.join(STOP_S)
