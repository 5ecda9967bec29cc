"""What a worker of the cluster does: hand a case to its nursery, and put the record on disk.

Kept small: a worker loads neither solver nor plots.
"""

from __future__ import annotations

import contextlib
import datetime
import json
import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

from ergowalk import __version__
from ergowalk.errors import OutputError, SweepError
from ergowalk.study.cases import Record
from ergowalk.study.store import Store

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS")
"""What tells numerical libraries to keep to one thread."""

ATTEMPTS = 2
"""How often a case is begun whose nursery dies, which no case can do to it."""

PATIENCE_S = 5.0
"""How long a nursery may take to end."""

_nurseries = threading.local()


def greet(folder: str, mark: str) -> dict[str, Any]:
    """Version of this worker's ergowalk, and whether it sees the folder of the sweep."""
    return {"version": __version__, "sees": (Path(folder) / mark).exists()}


def run_case(ticket: dict[str, Any]) -> Record:
    """Solve a case that is not done yet, and write its record.

    ``ticket`` has plain values only: ``folder``, ``key``, ``case``, ``values``, ``begun_at``,
    ``solver``, ``retry``, and the ``task`` of :func:`ergowalk.study.searching.searched` with its
    limits.

    Raises
    ------
    OutputError
        If the result cannot be written; then there is no record.
    SweepError
        If this worker does not see the folder, or cannot load the solver.
    """
    folder, key = Path(ticket["folder"]), ticket["key"]
    if not (folder / "cases" / key[:2]).is_dir():
        raise SweepError(
            f"is not seen by worker {_name()}",
            "give a folder that all workers of the cluster share",
            file=str(folder),
        )
    store = Store(folder)
    known = store.record(key)
    if known is not None and known["status"] not in ticket["retry"]:
        return known  # by another sweep, or by a worker that was lost after it had finished
    outcome = _raised(ticket["solver"], ticket["task"])
    if outcome["status"] == "not written":
        raise OutputError(
            outcome["reason"].partition(";")[0],
            "make room or choose another folder with -o, then start the same sweep again",
        )
    gait = outcome["status"] in ("accepted", "rejected")
    record = {
        "key": key,
        "status": outcome.pop("status"),
        "case": ticket["case"],
        "values": ticket["values"],
        "begun_at": ticket["begun_at"],
        "gait": f"cases/{key[:2]}/{key}.nc" if gait else "",
        **outcome,
        "worker": _name(),
        "finished": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
    }
    if not gait:  # that of an earlier attempt
        with contextlib.suppress(OSError):
            store.gait(key).unlink()
    store.write_record(record)
    return record


def _raised(solver: str, task: dict[str, Any]) -> dict[str, Any]:
    for _ in range(ATTEMPTS):
        try:
            return _nursery(solver).raise_child(task)
        except EOFError:
            _close()
    return {"status": "crashed", "reason": "the process that runs the cases was killed"}


class Nursery:
    """The process of :mod:`ergowalk.study.nursery` that belongs to this thread.

    Raises
    ------
    SweepError
        If it does not start.
    """

    def __init__(self, solver: str) -> None:
        self.solver = solver
        path = os.pathsep.join(filter(None, sys.path))
        environment = os.environ | dict.fromkeys(THREADS, "1") | {"PYTHONPATH": path}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "ergowalk.study.nursery", solver],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
        )
        try:
            self._answer()
        except EOFError:
            assert self._process.stderr is not None
            said = self._process.stderr.read().decode("utf-8", "replace").split("\n")
            last = next((line for line in reversed(said) if line.strip()), "no reason given")
            raise SweepError(
                f"cannot be loaded by worker {_name()}: {last}",
                "install the same ergowalk on all workers",
                field="solver",
                value=solver,
            ) from None
        threading.Thread(target=self._drain, daemon=True).start()

    def raise_child(self, task: dict[str, Any]) -> dict[str, Any]:
        """Do a task in a fresh child; EOFError if the nursery itself is gone."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(task).encode() + b"\n")
            self._process.stdin.flush()
        except OSError:
            raise EOFError from None
        return self._answer()

    def close(self) -> None:
        """End it, and its child with it."""
        assert self._process.stdin is not None
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        try:
            self._process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line.endswith(b"\n"):
            raise EOFError
        answer: dict[str, Any] = json.loads(line)
        return answer

    def _drain(self) -> None:
        """Keep the pipe of standard error from filling."""
        assert self._process.stderr is not None
        for _ in self._process.stderr:
            pass


def _nursery(solver: str) -> Nursery:
    """The nursery of this thread for a solver; it stays from case to case."""
    known: Nursery | None = getattr(_nurseries, "known", None)
    if known is not None and known.solver != solver:
        _close()
        known = None
    if known is None:
        known = _nurseries.known = Nursery(solver)
    return known


def _close() -> None:
    known = getattr(_nurseries, "known", None)
    if known is not None:
        known.close()
        _nurseries.known = None


def _name() -> str:
    """Address of the Dask worker that this runs on."""
    with contextlib.suppress(ImportError, ValueError):
        from distributed import get_worker

        return str(get_worker().address)
    return f"process {os.getpid()}"
