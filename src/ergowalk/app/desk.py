"""Who is solved next: one queue, a few workers, and an end to what nobody waits for."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ergowalk.app.options import Options
from ergowalk.app.process import COMMAND, WorkerError, ask_worker
from ergowalk.app.sessions import Job, Session, Sessions, State
from ergowalk.errors import InputError
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml

LEFT = "ended because its page was closed"
CANCELLED = "cancelled"


class Desk:
    """Takes solves from sessions and gives them to workers.

    Parameters
    ----------
    options : Options
    command : sequence of str
        Starts a worker.
    """

    def __init__(self, options: Options, command: Sequence[str] = COMMAND) -> None:
        self.options = options
        self.folder = Path(tempfile.mkdtemp(prefix="ergowalk-app-"))
        self.sessions = Sessions(self.folder)
        self.closing = asyncio.Event()
        self._command = command
        self._waiting: list[Job] = []
        self._running: set[Job] = set()
        self._film = asyncio.Lock()
        self._filming: asyncio.Task[dict[str, Any]] | None = None

    def submit(self, session: Session, problem: GaitProblem) -> Job:
        """A new solve of a session, begun as soon as a worker is free.

        Raises
        ------
        InputError
            If too many wait already, or the session keeps as many solves as it may.
        """
        if self._free() <= 0 and len(self._waiting) >= self.options.queue:
            raise InputError(
                f"the queue is full, as no more than {self.options.queue} solves may wait",
                "try again when one of them has ended",
            )
        job = session.new_job(problem)
        self._waiting.append(job)
        self._start()
        if not session.watched:
            self.left(session)
        return job

    def cancel(self, job: Job, why: str = CANCELLED) -> None:
        """End a solve that waits or runs; one that has ended stays as it is."""
        if job.state is State.WAITING:
            self._waiting.remove(job)
        elif job.state is not State.RUNNING:
            return
        job.state, job.message = State.CANCELLED, why
        if job.task is not None:
            job.task.cancel()
        self._tell_all()

    def ahead(self, job: Job) -> int:
        """How many other solves wait that were asked for before this one."""
        return self._waiting.index(job) if job in self._waiting else 0

    def left(self, session: Session) -> None:
        """No page of a session is open: unless one comes back in time, its solves end."""
        if session.leaving is not None:
            session.leaving.cancel()
        loop = asyncio.get_running_loop()
        session.leaving = loop.call_later(self.options.grace_s, self._end_unwatched, session)

    async def film(self, job: Job) -> Path:
        """The film of a gait, made when it is first asked for.

        Raises
        ------
        WorkerError
            If it cannot be made.
        """
        name = str(job.said["film"])
        path = job.folder / name
        async with self._film:  # one at a time, beside the solves
            if self.closing.is_set():
                raise WorkerError("the server ends")
            if not path.exists():
                order = {"task": "film", "folder": str(job.folder), "name": name}
                asking = ask_worker(self._command, order, self.options.time_limit_s)
                self._filming = asyncio.create_task(asking)
                await self._filming
        return path

    async def close(self) -> None:
        """End every solve at once, and forget all files."""
        self.closing.set()
        self._waiting.clear()
        tasks = [t for t in (self._filming, *(job.task for job in self._running)) if t is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        for session in self.sessions:
            session.progressed()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _end_unwatched(self, session: Session) -> None:
        for job in () if session.watched else session.open_jobs:
            self.cancel(job, LEFT)

    def _free(self) -> int:
        return self.options.workers - len(self._running)

    def _start(self) -> None:
        """Begin what there are workers for: first those whose sessions have the fewest already."""
        while self._waiting and self._free() > 0 and not self.closing.is_set():
            job = min(self._waiting, key=self._running_beside)
            self._waiting.remove(job)
            self._running.add(job)
            job.state, job.began = State.RUNNING, time.monotonic()
            job.task = asyncio.create_task(self._solve(job))
            # not in the task itself, which does not run at all if it is cancelled at once
            job.task.add_done_callback(partial(self._ended, job))
        self._tell_all()

    def _running_beside(self, job: Job) -> int:
        return sum(other.session is job.session for other in self._running)

    def _ended(self, job: Job, task: asyncio.Task[None]) -> None:
        self._running.discard(job)
        self._start()

    async def _solve(self, job: Job) -> None:
        order = {
            "task": "solve",
            "problem": problem_to_toml(job.problem),
            "folder": str(job.folder),
            "number": job.number,
        }

        def tell(progress: dict[str, object]) -> None:
            job.progress = progress
            job.session.progressed()

        try:
            job.said = await ask_worker(self._command, order, self.options.time_limit_s, tell)
            job.state = State.DONE
        except WorkerError as error:
            job.state, job.message = State.FAILED, str(error)

    def _tell_all(self) -> None:
        """What one session does moves the queue of all."""
        for session in self.sessions:
            session.changed()
