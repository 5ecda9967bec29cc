"""The process of one solve: ``python -m ergowalk.app.worker``, which its parent talks to.

The parent writes an order as one line of JSON to standard input and leaves it open; the worker
writes lines of JSON to standard output: ``{"progress": ...}``, and last ``{"done": ...}`` or
``{"error": "a sentence"}``. When standard input closes, the parent is gone, and so is the worker.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TextIO

from ergowalk.errors import InputError
from ergowalk.values import as_json

if TYPE_CHECKING:
    from ergowalk.solution import Progress

Tell = Callable[[dict[str, Any]], None]
"""Sends one message to the parent."""

Task = Callable[[dict[str, Any], Tell], dict[str, Any]]
"""Carries an order out and returns what is said of the result."""

EVERY = 0.1
"""Shortest time between two iterations that are told of [s]."""

NICE = 5
"""How far the solver gives way to the server and to whoever uses the machine."""

OUT_OF_MEMORY = "the memory ran out; end other programs, or solve fewer gaits at once (--workers)"


def solve_task(order: dict[str, Any], tell: Tell) -> dict[str, Any]:
    """Solve the problem of an order and leave everything that the page shows in its folder.

    Beside what is said of the result: ``film``, the name of a film that can be asked for, or "".
    """
    from ergowalk.app.film import film_name
    from ergowalk.app.results import store
    from ergowalk.problem.files import problem_from_toml

    problem = problem_from_toml(order["problem"])
    tell({"progress": {"stage": "starting the solver"}})
    from ergowalk.solving import solve  # takes longest to import

    solution = solve(problem, progress=_teller(tell))
    tell({"progress": {"stage": "auditing and drawing"}})
    said = store(solution, order["folder"], order["number"])
    return {**said, "film": film_name() if said["viewable"] else ""}


def film_task(order: dict[str, Any], tell: Tell) -> dict[str, Any]:
    """Make the film of the gait in the folder of an order."""
    from ergowalk.app.film import make_film

    make_film(order["folder"], order["name"])
    return {}


TASKS: dict[str, Task] = {"solve": solve_task, "film": film_task}
"""What a worker can be asked."""


def work(tasks: Mapping[str, Task]) -> None:
    """Take one order from the parent, carry it out, and tell how it ended."""
    with _own_output() as output:

        def tell(message: dict[str, Any]) -> None:
            output.write(json.dumps(as_json(message), allow_nan=False) + "\n")
            output.flush()

        order = json.loads(sys.stdin.buffer.readline())
        threading.Thread(target=_end_with_parent, daemon=True).start()
        if hasattr(os, "nice"):
            os.nice(NICE)
        with contextlib.suppress(BrokenPipeError):  # the parent has gone: nobody to tell
            tell(_outcome(tasks[order["task"]], order, tell))


def _outcome(task: Task, order: dict[str, Any], tell: Tell) -> dict[str, Any]:
    try:
        return {"done": task(order, tell)}
    except InputError as error:
        return {"error": str(error)}
    except MemoryError:
        return {"error": OUT_OF_MEMORY}
    except BrokenPipeError:
        raise
    except Exception as error:
        what = " ".join(f"{type(error).__name__}: {error}".split())
        return {
            "error": f"the solver stopped where it should not ({what}); please report it, with "
            "the problem file"
        }


def _teller(tell: Tell) -> Callable[[Progress], None]:
    """Passes the progress of a solve on, but not more often than anybody can read."""
    last = ("", -math.inf)

    def report(progress: Progress) -> None:
        nonlocal last
        now = time.monotonic()
        if progress.stage != last[0] or now - last[1] >= EVERY:
            last = (progress.stage, now)
            told = {k: getattr(progress, k) for k in ("stage", "iteration", "violation")}
            tell({"progress": {**told, "energy": progress.energy_per_metre}})

    return report


@contextlib.contextmanager
def _own_output() -> Iterator[TextIO]:
    """Standard output for messages alone: what a library prints there goes nowhere."""
    with os.fdopen(os.dup(1), "w", encoding="utf-8") as output:
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 1)
        yield output


def _end_with_parent() -> None:
    """Wait until the parent closes standard input or dies; then end, with every child."""
    while os.read(0, 4096):
        pass
    if hasattr(os, "killpg") and os.getpgid(0) == os.getpid():
        os.killpg(0, signal.SIGKILL)
    os._exit(1)


if __name__ == "__main__":
    work(TASKS)
