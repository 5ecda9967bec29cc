"""Clusters without processes of their own, sweeps of stand-ins, and what an index must show."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ergowalk.problem import preset
from ergowalk.study import Sweep, sweep
from ergowalk.study.event_loop import event_loop
from ergowalk.study.store import EFFORT, INDEX

STANDINS = f"{__name__.rpartition('.')[0]}.standins"


@pytest.fixture(scope="session")
def here() -> Iterator[str]:
    """Address of a cluster of two threads in this process; its nurseries are processes."""
    distributed = pytest.importorskip("distributed", reason="dask is not installed")
    pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    with (
        event_loop() as loop,
        distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=False,
            dashboard_address="127.0.0.1:0",
            loop=loop,
        ) as cluster,
    ):
        yield cluster.scheduler_address


def small(name: str = "small", problem: str = "quick", **changes: Any) -> Sweep:
    """Six walks around the paper's case; the name of the problem tells the stand-in what to do."""
    grid = {"step_length_m": [0.6, 0.7, 0.8], "stride_time_s": [1.0, 1.2]}
    base = preset("berbyuk2002").replace(name=problem)
    return Sweep(**{"name": name, "base": base, "grid": grid, **changes})


def index(folder: Path) -> dict[str, dict[str, Any]]:
    """The rows of an index by key, without what the same sweep run again may change."""
    from pyarrow import parquet

    rows = parquet.read_table(folder / INDEX).to_pylist()
    return {row["key"]: {k: v for k, v in row.items() if k not in EFFORT} for row in rows}


SOLVER = f"{STANDINS}:walk"


def run(definition: Sweep, folder: Path, address: str, **more: Any) -> Any:
    """A sweep with the stand-in on a cluster that is there."""
    return sweep(definition, folder, scheduler=address, solver=SOLVER, **more)


def begun(folder: Path) -> list[str]:
    """Keys of the cases that the stand-in has begun, in order."""
    log = folder.with_suffix(".log")
    return [line.split()[0] for line in log.read_text().splitlines()] if log.exists() else []
