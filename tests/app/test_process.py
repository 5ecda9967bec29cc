"""The app as a process: its address on standard output, and a quiet end for all of it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import ergowalk

from .serving import STAND_IN, Browser, gone

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks processes up")

SERVER = f"""
import sys
from ergowalk.app import serving
served = serving.served
serving.served = lambda socket, options, announce, command: served(
    socket, options, announce, {STAND_IN!r}
)
from ergowalk.cli import main
sys.exit(main(["app", "--port", "0"]))
"""
"""The command, with workers that stand in."""


@pytest.fixture
def server(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    process = subprocess.Popen(
        [sys.executable, "-c", SERVER],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={
            **os.environ,
            "PYTHONPATH": str(Path(ergowalk.__file__).parents[1]),
            "TMPDIR": str(tmp_path),
        },
        # a shell without job control lets what it starts in the background ignore Ctrl-C
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    yield process
    if process.poll() is None:
        process.kill()
    process.communicate(timeout=10)


def address(server: subprocess.Popen[str]) -> str:
    assert server.stdout is not None
    return server.stdout.readline().strip()


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 0), (signal.SIGTERM, -15)])
def test_the_server_ends_at_once_and_quietly_with_all_its_workers(
    server: subprocess.Popen[str], tmp_path: Path, number: int, status: int
) -> None:
    browser = Browser(address(server))
    with browser.page() as page:
        for _ in range(2):
            browser.solve("endless")
        pids = [page.pid(1)]
        server.send_signal(number)
        began = time.monotonic()
        out, err = server.communicate(timeout=10)
        assert time.monotonic() - began < 4
    assert (server.returncode, out, err) == (status, "", "")
    assert all(gone(pid, within=1) for pid in pids)
    assert list(tmp_path.glob("ergowalk-app-*")) == []


def test_a_server_that_is_killed_leaves_no_worker_behind(server: subprocess.Popen[str]) -> None:
    browser = Browser(address(server))
    with browser.page() as page:
        browser.solve("endless")
        pid = page.pid()
        server.kill()
        assert gone(pid)
