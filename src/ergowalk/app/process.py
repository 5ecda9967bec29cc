"""A worker process seen from the server: started, listened to, and never left behind."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import sys
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import Callable, Sequence
from typing import Any

COMMAND = (sys.executable, "-m", "ergowalk.app.worker")
"""Starts a worker."""

LONGEST_LINE = 1 << 22
"""Longest message of a worker in bytes."""

KILLED = (
    "the system ended the solver, most likely because the memory ran out; end other programs, or "
    "solve fewer gaits at once (--workers)"
)


class WorkerError(Exception):
    """A worker ended without an answer; the message is a sentence for the page."""


async def ask_worker(
    command: Sequence[str],
    order: dict[str, Any],
    time_limit: float,
    tell: Callable[[dict[str, Any]], None] | None = None,
) -> dict[str, Any]:
    """What a worker says of the order that it has carried out.

    However this ends, by an answer, an error, the time limit or cancellation, the process and
    its children have ended with it.

    Parameters
    ----------
    command : sequence of str
        Starts the worker.
    order : dict
        ``task`` and what it needs.
    time_limit : float
        Seconds.
    tell : callable, optional
        Takes each ``progress``.

    Raises
    ------
    WorkerError
        If there is no answer.
    """
    process = await _started(command)
    try:
        async with asyncio.timeout(time_limit):
            return await _conversation(process, order, tell)
    except TimeoutError:
        raise WorkerError(
            f"took longer than {time_limit:g} s and was ended; make the problem easier, or "
            "start the app with a larger --time-limit"
        ) from None
    finally:
        await _end(process)


async def _started(command: Sequence[str]) -> Process:
    try:
        return await asyncio.create_subprocess_exec(
            *command,
            stdin=PIPE,
            stdout=PIPE,
            stderr=DEVNULL,
            limit=LONGEST_LINE,
            env=_environment(),
            start_new_session=True,  # Ctrl-C is for the server, which then ends the workers
        )
    except OSError as error:
        raise WorkerError(
            f"the solver cannot be started ({error.strerror}); end other programs"
        ) from None


async def _conversation(
    process: Process, order: dict[str, Any], tell: Callable[[dict[str, Any]], None] | None
) -> dict[str, Any]:
    assert process.stdin is not None
    assert process.stdout is not None
    with contextlib.suppress(ConnectionError):  # it ended at once; its status says how
        process.stdin.write(json.dumps(order).encode() + b"\n")
        await process.stdin.drain()
    async for line in process.stdout:
        message = _message(line)
        if "error" in message:
            raise WorkerError(message["error"])
        if "done" in message:
            done: dict[str, Any] = message["done"]
            return done
        if tell is not None:
            tell(message["progress"])
    status = await process.wait()
    if status == -getattr(signal, "SIGKILL", 9):
        raise WorkerError(KILLED)
    raise WorkerError(f"the solver ended without an answer (status {status}); try again")


def _message(line: bytes) -> dict[str, Any]:
    try:
        message: dict[str, Any] = json.loads(line)
    except ValueError:
        raise WorkerError("the solver cannot be understood; please report it") from None
    return message


async def _end(process: Process) -> None:
    """Kill a worker with its children, and wait until it is gone."""
    if process.stdin is not None:
        process.stdin.close()
    with contextlib.suppress(ProcessLookupError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    await asyncio.shield(process.wait())


def _environment() -> dict[str, str]:
    """That of the server, with one thread for each worker: they share the processors."""
    single = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
    return {**os.environ, **single}
