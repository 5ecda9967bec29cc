"""A process that has everything loaded and makes a fresh child for every case.

A solve may hang inside compiled code, take all memory or die; no thread can stop it. So each case
runs in a child of its own that is killed at its time limit and may not take more than its memory
limit. Loading solver and libraries takes seconds; a child that is forked has them at once, and
leaves nothing behind that could change the next case.

``python -m ergowalk.study.nursery MODULE:FUNCTION`` reads a JSON object a line from standard input
and answers with one. When its input ends, because whoever started it is gone, so are its child and
itself.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import json
import os
import resource
import select
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from typing import IO, Any

Work = Callable[[dict[str, Any]], dict[str, Any]]

MEGABYTE = 2**20
NOT_NEEDED = ("dask", "distributed")
"""What xarray would load to write a file, with threads that a fork does not bear."""

DIE_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux


def main(argv: list[str]) -> None:
    """Serve until standard input ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever compiled code prints is no answer
    for name in NOT_NEEDED:
        sys.modules[name] = None  # type: ignore[assignment]
    work = named(argv[1])
    _warm_up()
    wake, poke = os.pipe()
    os.set_blocking(poke, False)
    os.set_blocking(wake, False)
    signal.set_wakeup_fd(poke)
    signal.signal(signal.SIGCHLD, lambda number, frame: None)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started it decides
    print(json.dumps({"ready": os.getpid()}), file=answers, flush=True)
    while line := _line():
        outcome = _raised(work, json.loads(line), wake)
        print(json.dumps(outcome), file=answers, flush=True)


def named(name: str) -> Work:
    """The function called ``module:function``."""
    module, _, function = name.partition(":")
    work: Work = getattr(importlib.import_module(module), function)
    return work


def _warm_up() -> None:
    """Load what is loaded at its first use, here and not in every child."""
    import xarray as xr

    importlib.import_module("ergowalk.audit")
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/empty.nc"
        xr.Dataset({"x": ("x", [0.0])}).to_netcdf(path, engine="netcdf4", format="NETCDF4")
        with xr.open_dataset(path, engine="netcdf4") as stored:
            stored.load()


def _line() -> bytes:
    """The next task, a line of standard input; not buffered, so that ``select`` sees all of it.

    There is never more than one on its way.
    """
    found = b""
    while not found.endswith(b"\n"):
        part = os.read(0, 65536)
        if not part:
            return b""
        found += part
    return found


def _raised(work: Work, task: dict[str, Any], wake: int) -> dict[str, Any]:
    """Do a task in a child; what became of it, and what it cost."""
    began = time.monotonic()
    with tempfile.TemporaryFile() as told, tempfile.TemporaryFile() as said:
        child = os.fork()
        if child == 0:
            _be_a_child(work, task, told, said)
        status, usage, late = _watched(child, began + task["time_limit_s"], wake)
        told.seek(0)
        said.seek(0)
        outcome = _outcome(task, status, late, told.read(), said.read())
    peak = usage.ru_maxrss / (MEGABYTE if sys.platform == "darwin" else 1024)
    return outcome | {
        "cpu_s": usage.ru_utime + usage.ru_stime,
        "wall_s": time.monotonic() - began,
        "peak_memory_mb": peak,
    }


def _watched(child: int, deadline: float, wake: int) -> tuple[int, resource.struct_rusage, bool]:
    """Exit status and usage of a child, and whether it had to be killed for its time."""
    late = False
    while True:
        pid, status, usage = os.wait4(child, os.WNOHANG)
        if pid:
            _kill(child)  # what it may have started itself
            return status, usage, late
        left = deadline - time.monotonic()
        if left <= 0 and not late:
            late = True
            _kill(child)
        # standard input says nothing while a task is being done, unless it ends
        ready, _, _ = select.select([0, wake], [], [], max(left, 0.05))
        if wake in ready:
            with contextlib.suppress(BlockingIOError):
                os.read(wake, 4096)
        if 0 in ready:
            _kill(child)
            os._exit(0)


def _kill(child: int) -> None:
    for kill in (os.killpg, os.kill):  # the group may not be there yet
        with contextlib.suppress(OSError):
            kill(child, signal.SIGKILL)


def _be_a_child(work: Work, task: dict[str, Any], told: IO[bytes], said: IO[bytes]) -> None:
    """Do the task in this process, tell the outcome, and be gone."""
    code = 1
    try:
        os.setsid()
        _die_with_parent()
        os.dup2(said.fileno(), 1)
        os.dup2(said.fileno(), 2)
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        _limit(resource.RLIMIT_CORE, 0)
        _limit(resource.RLIMIT_DATA, int(task["memory_limit_mb"] * MEGABYTE))
        told.write(json.dumps(_done(work, task)).encode())
        told.flush()
        code = 0
    except BaseException as error:
        os.write(2, f"\n{type(error).__name__}: {error}".encode())
    finally:
        os._exit(code)


def _done(work: Work, task: dict[str, Any]) -> dict[str, Any]:
    from ergowalk.errors import InputError, OutputError

    try:
        return work(task)
    except MemoryError:
        return {"status": "out of memory", "reason": _memory_sentence(task)}
    except OutputError as error:
        return {"status": "not written", "reason": str(error)}
    except InputError as error:
        return {"status": "error", "reason": str(error)}
    except Exception as error:
        if "bad_alloc" in str(error):
            return {"status": "out of memory", "reason": _memory_sentence(task)}
        words = " ".join(str(error).split())[:300]
        return {"status": "error", "reason": f"{type(error).__name__}: {words}"}


def _outcome(
    task: dict[str, Any], status: int, late: bool, told: bytes, said: bytes
) -> dict[str, Any]:
    if late:
        limit = task["time_limit_s"]
        return {"status": "out of time", "reason": f"killed after its limit of {limit:g} s"}
    if status == 0:
        outcome: dict[str, Any] = json.loads(told)
        return outcome
    last = " ".join(said.decode("utf-8", "replace").split()[-40:])
    if "bad_alloc" in last or "MemoryError" in last:
        return {"status": "out of memory", "reason": _memory_sentence(task)}
    code = os.waitstatus_to_exitcode(status)
    name = signal.Signals(-code).name if code < 0 else f"status {code}"
    return {"status": "crashed", "reason": f"ended with {name}" + (f": {last}" if last else "")}


def _memory_sentence(task: dict[str, Any]) -> str:
    return f"needed more than its limit of {task['memory_limit_mb']:g} MB"


def _limit(what: int, value: int) -> None:
    with contextlib.suppress(OSError, ValueError):  # not every system knows every limit
        resource.setrlimit(what, (value, value))


def _die_with_parent() -> None:
    """On Linux the child of a nursery that is killed is killed too."""
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(DIE_WITH_PARENT, signal.SIGKILL)


if __name__ == "__main__":
    main(sys.argv)
