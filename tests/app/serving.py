"""A server of the app in this process, and clients that talk to it as browsers do."""

from __future__ import annotations

import asyncio
import http.client
import json
import math
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from ergowalk.app.options import Options
from ergowalk.app.problems import values_of
from ergowalk.app.serving import bound_socket, served
from ergowalk.problem import preset

pytest.importorskip("starlette", reason="the extra 'app' is not installed")
pytest.importorskip("uvicorn", reason="the extra 'app' is not installed")

STAND_IN = (sys.executable, str(Path(__file__).with_name("stand_in.py")))


@contextmanager
def app(command: Sequence[str] | None = STAND_IN, **options: Any) -> Iterator[str]:
    """The address of a running app."""
    chosen = Options(port=0, **options)
    ready, said = threading.Event(), []
    ending: list[Callable[[], None]] = []

    async def run() -> None:
        stop, loop = asyncio.Event(), asyncio.get_running_loop()
        ending.append(lambda: loop.call_soon_threadsafe(stop.set))

        def announce(url: str) -> None:
            said.append(url)
            ready.set()

        with bound_socket(chosen) as listening:
            await served(listening, chosen, announce, command, stop)

    thread = threading.Thread(target=lambda: asyncio.run(run()), daemon=True)
    thread.start()
    assert ready.wait(20)
    try:
        yield said[0]
    finally:
        ending[0]()
        thread.join(20)
        assert not thread.is_alive()


@contextmanager
def visit(
    command: Sequence[str] | None = STAND_IN, **options: Any
) -> Iterator[tuple[Browser, Page]]:
    """The browser and the open page of somebody at a running app."""
    with app(command, **options) as url:
        browser = Browser(url)
        with browser.page() as page:
            yield browser, page


class Answer:
    """Status, headers and body of a response."""

    def __init__(self, response: http.client.HTTPResponse) -> None:
        self.status, self.headers = response.status, response.headers
        self.body = response.read()

    @property
    def json(self) -> Any:
        return json.loads(self.body)


class Browser:
    """Keeps the cookie of its session, and sends what a page of the server would send."""

    def __init__(self, url: str, session: bool = True) -> None:
        self.host = urlsplit(url).netloc
        self.cookie = ""
        if session:
            answer = self.ask("POST", "/session")
            assert answer.status == 200, answer.body
            self.set_cookie = answer.headers["set-cookie"]
            self.cookie = self.set_cookie.split(";")[0]

    def connect(self) -> http.client.HTTPConnection:
        return http.client.HTTPConnection(self.host, timeout=20)

    def headers(self) -> dict[str, str]:
        own = {"Origin": f"http://{self.host}", "Sec-Fetch-Site": "same-origin"}
        return own | ({"Cookie": self.cookie} if self.cookie else {})

    def ask(
        self, method: str, path: str, body: bytes | str | None = None, **headers: str | None
    ) -> Answer:
        """An answer; a header given as None is left out."""
        given = self.headers() | {k.replace("_", "-"): v for k, v in headers.items()}
        connection = self.connect()
        connection.request(method, path, body, {k: v for k, v in given.items() if v is not None})
        answer = Answer(connection.getresponse())
        connection.close()
        return answer

    def solve(self, name: str, **changes: Any) -> Answer:
        problem = values_of(preset("berbyuk2002").replace(name=name)) | changes
        return self.ask("POST", "/solves", json.dumps({"problem": problem}))

    @contextmanager
    def page(self) -> Iterator[Page]:
        """An open page."""
        connection = self.connect()
        connection.request("GET", "/events", headers=self.headers())
        response = connection.getresponse()
        assert response.status == 200, response.read()
        try:
            yield Page(response)
        finally:
            response.close()
            connection.close()


class Page:
    """Listens to the events of its session."""

    def __init__(self, response: http.client.HTTPResponse) -> None:
        self._response = response
        self.jobs: list[dict[str, Any]] = []

    def next(self, deadline: float = math.inf) -> None:
        """Wait for an event; a server that has nothing to tell says so now and then."""
        name = ""
        while line := self._response.readline().decode():
            assert time.monotonic() < deadline, self.jobs
            if line.startswith("event: "):
                name = line[7:].strip()
            elif line.startswith("data: "):
                told = json.loads(line[6:])
                if name == "state":
                    self.jobs = told
                for job in told:
                    next(j for j in self.jobs if j["id"] == job["id"]).update(job)
                return
        raise EOFError

    def until(self, condition: Callable[[list[dict[str, Any]]], Any]) -> list[dict[str, Any]]:
        """The solves, as soon as a condition on them holds."""
        deadline = time.monotonic() + 20
        while not condition(self.jobs):
            assert time.monotonic() < deadline, self.jobs
            self.next(deadline)
        return self.jobs

    def pid(self, number: int = 1) -> int:
        """The process of a solve that runs."""
        jobs = self.until(lambda jobs: any(_pid(j) for j in jobs if j["number"] == number))
        return next(_pid(j) for j in jobs if j["number"] == number)

    def ended(self, number: int = 1) -> dict[str, Any]:
        """A solve that has ended."""
        over = ("done", "failed", "cancelled")
        jobs = self.until(
            lambda jobs: any(j["number"] == number and j["state"] in over for j in jobs)
        )
        return next(j for j in jobs if j["number"] == number)


def _pid(job: dict[str, Any]) -> int:
    return int(job["progress"].get("pid", 0)) if job["state"] == "running" else 0


def gone(pid: int, within: float = 10.0) -> bool:
    """Whether a process ends within some seconds."""
    deadline = time.monotonic() + within
    while time.monotonic() < deadline:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False
