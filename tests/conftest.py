"""Fixtures shared by all tests: one solved gait for the whole session."""

from __future__ import annotations

import os
import time
from pathlib import Path

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
