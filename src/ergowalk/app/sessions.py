"""Who is there: one session for each browser, with its solves and the pages that watch them."""

from __future__ import annotations

import asyncio
import secrets
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from ergowalk.errors import InputError
from ergowalk.problem import GaitProblem

SESSIONS = 64
"""Most sessions that are kept; the one that was not seen for longest makes room."""

SOLVES = 24
"""Most solves that a session keeps."""


class State(StrEnum):
    """Where a solve stands."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


OPEN = (State.WAITING, State.RUNNING)


@dataclass(eq=False)
class Job:
    """One solve of a session.

    Attributes
    ----------
    id : str
        Unguessable name in addresses.
    number : int
        Counts the solves of the session.
    problem : GaitProblem
    folder : Path
        Where its files go.
    message : str
        Why there is no gait, as a sentence.
    said : dict
        What its worker says of the result, see :func:`ergowalk.app.results.store`.
    """

    session: Session
    number: int
    problem: GaitProblem
    folder: Path
    id: str = field(default_factory=lambda: secrets.token_urlsafe(12))
    state: State = State.WAITING
    progress: dict[str, Any] = field(default_factory=dict)
    message: str = ""
    said: dict[str, Any] = field(default_factory=dict)
    began: float = 0.0
    task: asyncio.Task[None] | None = None

    def running_for(self) -> float:
        """Seconds since the solve began."""
        return time.monotonic() - self.began if self.state is State.RUNNING else 0.0


class Session:
    """The solves of one browser, in the order in which they were asked for."""

    def __init__(self, folder: Path) -> None:
        self.token = secrets.token_urlsafe(24)
        self.jobs: dict[str, Job] = {}
        self.seen = time.monotonic()
        self.version = 0
        self.leaving: asyncio.TimerHandle | None = None
        self._folder = folder
        self._count = 0
        self._watchers: set[asyncio.Event] = set()

    @property
    def watched(self) -> bool:
        """Whether a page is open."""
        return bool(self._watchers)

    @property
    def open_jobs(self) -> list[Job]:
        """Solves that wait or run."""
        return [job for job in self.jobs.values() if job.state in OPEN]

    def new_job(self, problem: GaitProblem) -> Job:
        """A solve that waits.

        Raises
        ------
        InputError
            If the session keeps as many as it may.
        """
        if len(self.jobs) >= SOLVES:
            raise InputError(
                f"{SOLVES} solves are kept, and that is all that there is room for",
                "remove one from the list",
            )
        self._count += 1
        folder = self._folder / f"{self._count}"
        job = Job(self, self._count, problem, folder)
        folder.mkdir(parents=True)
        self.jobs[job.id] = job
        self.changed()
        return job

    def remove(self, job: Job) -> None:
        """Forget a solve that has ended, and its files."""
        del self.jobs[job.id]
        shutil.rmtree(job.folder, ignore_errors=True)
        self.changed()

    def changed(self) -> None:
        """Let every open page know: solves came, went, or ended."""
        self.version += 1
        self.progressed()

    def progressed(self) -> None:
        """Let every open page know: a solve went on."""
        for event in self._watchers:
            event.set()

    @contextmanager
    def watching(self, left: Callable[[Session], None]) -> Iterator[asyncio.Event]:
        """While a page watches: what is set at each change. ``left`` is called after the last."""
        event = asyncio.Event()
        event.set()
        self._watchers.add(event)
        try:
            yield event
        finally:
            self._watchers.discard(event)
            self.seen = time.monotonic()
            if not self._watchers:
                left(self)


class Sessions:
    """All sessions by their token; their files are below ``folder``."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._known: dict[str, Session] = {}

    def find(self, token: str | None) -> Session | None:
        """The session of a token that was given out here."""
        session = self._known.get(token or "")
        if session is not None:
            session.seen = time.monotonic()
        return session

    def create(self) -> Session:
        """A new session.

        Raises
        ------
        InputError
            If there are too many, and all of them are in use.
        """
        if len(self._known) >= SESSIONS:
            idle = [s for s in self._known.values() if not s.watched and not s.open_jobs]
            if not idle:
                raise InputError(
                    f"{SESSIONS} pages are open, and that is all that there is room for",
                    "close one",
                )
            self._forget(min(idle, key=lambda s: s.seen))
        session = Session(self._folder / secrets.token_hex(8))
        self._known[session.token] = session
        return session

    def __iter__(self) -> Iterator[Session]:
        return iter(self._known.values())

    def _forget(self, session: Session) -> None:
        del self._known[session.token]
        for job in list(session.jobs.values()):
            session.remove(job)
