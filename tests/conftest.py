"""Fixtures shared by all tests: one solved gait for the whole session, and a real browser."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from hypothesis import settings

settings.register_profile("fixed", derandomize=True, deadline=None)
settings.load_profile("fixed")


@pytest.fixture(scope="session")
def paper_gait_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Gait file of preset berbyuk2002-rhythm, solved once even when tests run in parallel."""
    import ergowalk

    base = tmp_path_factory.getbasetemp()
    shared = base.parent if os.environ.get("PYTEST_XDIST_WORKER") else base
    target, lock = shared / "berbyuk2002-rhythm.nc", shared / "berbyuk2002-rhythm.lock"
    try:
        os.close(os.open(lock, os.O_CREAT | os.O_EXCL))
    except FileExistsError:
        deadline = time.monotonic() + 600
        while not target.exists():
            assert time.monotonic() < deadline, "the worker that solves the gait gave up"
            time.sleep(0.5)
        return target
    return ergowalk.solve(ergowalk.preset("berbyuk2002-rhythm")).save(target)


@pytest.fixture(scope="session")
def paper_gait(paper_gait_file: Path) -> xr.Dataset:
    """The dataset of :func:`paper_gait_file`, loaded."""
    with xr.open_dataset(paper_gait_file) as stored:
        return stored.load()


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """Chromium of the system; the test is skipped where there is none."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("chromium is not installed")
    with sync_api.sync_playwright() as playwright:
        # the sandbox of Chromium does not start for root, as in most containers
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield browser
        browser.close()
