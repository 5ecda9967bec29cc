"""Whoever is killed, and wherever the disk is full: what was done stays, and a rerun completes."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from ergowalk.errors import OutputError, SweepError
from ergowalk.study import collect
from ergowalk.study.store import Store

from .conftest import SOLVER, begun, index, run, small

pytest.importorskip("distributed", reason="dask is not installed")

ENVIRONMENT = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}

PATIENCE_S = 120.0
"""Longest wait for something that takes a second on an idle machine."""


def until(condition: Callable[[], bool], what: str) -> None:
    """Wait for something to become true."""
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, f"waited in vain: {what}"
        time.sleep(0.02)


def alive(pid: int) -> bool:
    """Whether a process runs; one that only waits to be buried does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def pids(folder: Path) -> set[int]:
    """Processes in which the cases of a sweep ran."""
    lines = folder.with_suffix(".log").read_text().splitlines()
    return {int(line.split()[1]) for line in lines}


@pytest.fixture(scope="module")
def undisturbed(here: str, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The index of a sweep to which nothing happened."""
    folder = tmp_path_factory.mktemp("undisturbed") / "out"
    run(small(), folder, here)
    return index(folder)


def whole(folder: Path) -> None:
    """Every record can be read, and so can its gait."""
    store = Store(folder)
    for path in folder.glob("cases/*/*.json"):
        record = json.loads(path.read_bytes())
        assert record["key"] == path.stem
        with xr.open_dataset(store.gait(path.stem)) as gait:
            assert gait.load().attrs["energy_per_metre"] == record["energy_per_metre"]


# --- a cluster started by hand, in other processes ---------------------------------------------


@dataclass
class ByHand:
    """A scheduler and workers, each a process of its own."""

    address: str
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def hire(self) -> None:
        """One worker more, of one thread."""
        command = ["worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
        self.workers.append(started(*command))


def started(*arguments: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-m", "dask", *arguments],
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


@pytest.fixture(scope="module")
def by_hand(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ByHand]:
    told = tmp_path_factory.mktemp("cluster") / "scheduler.json"
    command = ["--port", "0", "--no-dashboard", "--host", "127.0.0.1"]
    scheduler = started("scheduler", *command, "--scheduler-file", str(told))
    until(told.exists, "the scheduler")
    cluster = ByHand(json.loads(told.read_text())["address"], scheduler)
    for _ in range(2):
        cluster.hire()
    yield cluster
    for process in (*cluster.workers, cluster.scheduler):
        process.kill()
        process.wait()


def test_a_cluster_in_other_processes_gives_the_same_and_survives_a_worker(
    by_hand: ByHand, tmp_path: Path, undisturbed: dict[str, Any]
) -> None:
    """SIGKILL of a worker in the middle of a case: its case is done by another one."""
    folder, gate = tmp_path / "out", tmp_path / "out.gate"
    gate.touch()
    killed: list[str] = []

    def watch(tally: Any) -> None:
        if not killed and begun(folder):
            first = by_hand.workers[0], by_hand.workers[1]
            children = {int(line.split()[1]) for line in gate.with_suffix(".log").open()}
            (child,) = children
            nursery = parent(child)
            (victim,) = [worker for worker in first if parent(nursery) == worker.pid]
            victim.kill()
            killed.append(begun(folder)[0])
            until(lambda: not alive(child), "the child of a worker that was killed")
            until(lambda: not alive(nursery), "the nursery of a worker that was killed")
            gate.unlink()

    run(small(), folder, by_hand.address, progress=watch)
    assert killed
    assert begun(folder).count(killed[0]) == 2
    assert len(begun(folder)) == 7
    assert index(folder) == undisturbed
    whole(folder)


def parent(pid: int) -> int:
    """The parent of a process."""
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def test_a_cluster_that_is_lost_costs_the_cases_under_way(
    by_hand: ByHand, here: str, tmp_path: Path, undisturbed: dict[str, Any]
) -> None:
    folder, gate = tmp_path / "out", tmp_path / "out.gate"

    def watch(tally: Any) -> None:
        if tally.done >= 2 and by_hand.scheduler.poll() is None:
            gate.touch()
            by_hand.scheduler.kill()
            for worker in by_hand.workers:
                worker.kill()

    with pytest.raises(SweepError, match="was lost; what was done is kept: start the same sweep"):
        run(small(), folder, by_hand.address, progress=watch)
    gate.unlink()
    whole(folder)
    done = len(index(folder))
    assert 2 <= done < 6
    count = len(begun(folder))
    run(small(), folder, here)
    assert len(begun(folder)) - count <= 6 - done
    assert index(folder) == undisturbed


# --- the client ---------------------------------------------------------------------------------

CLIENT = """
import functools, sys
import ergowalk.study as study
study.sweep = functools.partial(study.sweep, solver=sys.argv.pop())
if __name__ == "__main__":
    from ergowalk.cli import main
    sys.exit(main(sys.argv[1:]))
"""


@contextlib.contextmanager
def client(tmp_path: Path, *where: str) -> Iterator[subprocess.Popen[str]]:
    """``ergowalk sweep`` in a process of its own, with the stand-in."""
    (tmp_path / "client.py").write_text(CLIENT)
    (tmp_path / "problem.toml").write_text(
        'name = "slow"\nstep_length_m = 0.76\nstride_time_s = 1.14\n'
    )
    (tmp_path / "small.toml").write_text(
        'name = "small"\nproblem = "problem.toml"\n'
        "[grid]\nstep_length_m = {low = 0.6, high = 0.8, count = 3}\nstride_time_s = [1.0, 1.2]\n"
    )
    command = [sys.executable, "client.py", "sweep", "small.toml", "-o", "out"]
    process = subprocess.Popen(
        [*command, *where, SOLVER],
        cwd=tmp_path,
        env=ENVIRONMENT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def test_a_scheduler_that_cannot_be_has_one_line_and_no_wait_at_exit(tmp_path: Path) -> None:
    """A client that was never connected would try to say goodbye for 40 s, and complain."""
    with client(tmp_path, "--scheduler", "nonsense") as process:
        out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (2, "")
    assert "scheduler = 'nonsense': there is no scheduler" in err.splitlines()[-1]
    assert "Traceback" not in err


def test_a_client_that_is_killed_leaves_whole_results_and_nobody_at_work(
    here: str, tmp_path: Path, undisturbed: dict[str, Any]
) -> None:
    folder = tmp_path / "out"
    with client(tmp_path, "--workers", "2") as process:
        until(lambda: len(list(folder.glob("cases/*/*.json"))) >= 2, "two results")
        process.kill()
        process.wait()
    until(lambda: not any(alive(pid) for pid in pids(folder)), "the children of the sweep")
    whole(folder)
    done, count = len(list(folder.glob("cases/*/*.json"))), len(begun(folder))
    assert count - done <= 2  # those under way
    run(small(), folder, here)
    assert len(begun(folder)) == count + 6 - done
    assert index(folder) == undisturbed


def test_an_interrupt_ends_the_sweep_with_its_index_written(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    with client(tmp_path, "--workers", "1") as process:
        until(lambda: len(list(folder.glob("cases/*/*.json"))) >= 1, "a result")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 130
    assert out == ""
    assert err.rstrip().endswith("ergowalk: interrupted")
    assert "Traceback" not in err
    assert "1 workers, dashboard http://127.0.0.1:" in err
    assert len(index(folder)) == len(list(folder.glob("cases/*/*.json"))) >= 1
    assert (collect(folder)["status"] == "missing").any()
    assert not any(alive(pid) for pid in pids(folder))


# --- the disk -----------------------------------------------------------------------------------


@pytest.fixture
def little_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk with room for a few gaits; needs the right to mount one."""
    place = tmp_path / "disk"
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(place)]
    try:
        subprocess.run(command, check=True, capture_output=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        pytest.skip("a file system cannot be mounted here")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True, timeout=10)


def test_a_full_disk_stops_the_sweep_with_whole_results(
    here: str, little_disk: Path, undisturbed: dict[str, Any]
) -> None:
    folder = little_disk / "out"
    with pytest.raises(OutputError, match="cannot be written .*; make room or choose another"):
        run(small(), folder, here)
    whole(folder)
    assert 1 <= len(list(folder.glob("cases/*/*.json"))) < 6
    subprocess.run(["mount", "-o", "remount,size=10m", str(little_disk)], check=True, timeout=10)
    run(small(), folder, here)
    assert index(folder) == undisturbed
