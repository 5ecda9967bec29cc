"""What an open page is told while it is open, as server-sent events."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

from starlette.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from ergowalk.app.desk import Desk
from ergowalk.app.problems import title_of
from ergowalk.app.sessions import Job, Session, State

PAUSE = 0.1
"""Shortest time between two events [s]: changes in between are told together."""

BEAT = 10.0
"""Longest time without a word [s]; a page that is gone without a sign is noticed by it."""


class EventStream(StreamingResponse):
    """Tells a page of its session until it leaves or the server ends; meanwhile it counts as open.

    ``state`` has every solve and comes first and whenever one comes, goes or ends; ``progress``
    has the solves that run.
    """

    def __init__(self, desk: Desk, session: Session) -> None:
        self._desk, self._session = desk, session
        self._changed = asyncio.Event()
        super().__init__(self._events(), media_type="text/event-stream")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer; the page counts as open as long as this takes."""
        with self._session.watching(self._desk.left) as self._changed:
            await super().__call__(scope, receive, send)

    async def _events(self) -> AsyncIterator[str]:
        told = -1
        yield "retry: 1000\n\n"
        while not self._desk.closing.is_set():
            try:
                async with asyncio.timeout(BEAT):
                    await self._changed.wait()
            except TimeoutError:
                yield ": still here\n\n"
                continue
            self._changed.clear()
            if self._desk.closing.is_set():
                return
            if self._session.version != told:
                told = self._session.version
                yield _event("state", [self._job(j) for j in self._session.jobs.values()])
            else:
                running = [j for j in self._session.jobs.values() if j.state is State.RUNNING]
                yield _event("progress", [_progress(job) for job in running])
            await asyncio.sleep(PAUSE)

    def _job(self, job: Job) -> dict[str, Any]:
        return {
            **_progress(job),
            "number": job.number,
            "title": title_of(job.problem),
            "state": str(job.state),
            "ahead": self._desk.ahead(job),
            "message": job.message,
            "said": job.said,
        }


def _progress(job: Job) -> dict[str, Any]:
    return {"id": job.id, "progress": job.progress, "seconds": round(job.running_for(), 1)}


def _event(name: str, value: Any) -> str:
    return f"event: {name}\ndata: {json.dumps(value, allow_nan=False)}\n\n"
