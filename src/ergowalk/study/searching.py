"""What is done for one case: find its gait, measure it, store it. Runs in a child process."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Protocol

from ergowalk.errors import GaitFileError
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_from_toml
from ergowalk.solution import Solution
from ergowalk.study.measures import measured

COLD = "began from the human means"
"""What the status of a gait says whose start could not be used."""


class Solver(Protocol):
    """What solves one problem: :func:`ergowalk.solve`, or a stand-in for it."""

    def __call__(
        self,
        problem: GaitProblem,
        *,
        start: Solution | None = None,
        starts: int | None = None,
        seed: int = 0,
        workers: int | None = None,
    ) -> Solution:
        """The cheapest gait of a problem."""


def searched(task: dict[str, Any], solver: Solver) -> dict[str, Any]:
    """Find, measure and store the gait of a case; its part of the record.

    ``task`` has ``problem`` (TOML), ``gait`` (where the answer goes), ``start`` (a gait file or
    None), ``starts`` (0: one search, whatever comes of it) and ``seed``.

    Raises
    ------
    InputError
        If the problem cannot be used or the gait cannot be written.
    """
    target = Path(task["gait"])
    problem = problem_from_toml(task["problem"], folder=target.parent)
    start = _start(task["start"])
    best: tuple[str, Solution] | None = None
    for way, gait in _tried(problem, start, task, solver):
        if best is None or _rank(gait) < _rank(best[1]):
            best = way, gait
    assert best is not None
    way, gait = best
    numbers = measured(Solution(gait.dataset, target.parent))
    gait.save(target)
    return {"status": "accepted" if gait.acceptable else "rejected", "reason": "", "way": way} | (
        numbers | {"solver_status": gait.status}
    )


def _start(path: str | None) -> Solution | None:
    """The gait to begin with; without one that can be read the case begins cold."""
    if path is None:
        return None
    try:
        return Solution.load(path)
    except GaitFileError:
        return None


def _tried(
    problem: GaitProblem, start: Solution | None, task: dict[str, Any], solver: Solver
) -> Iterator[tuple[str, Solution]]:
    """Gaits and the ways in which they were found, until enough has been tried."""
    starts, seed, cold = task["starts"], task["seed"], False
    content = False
    if start is not None:
        begun = solver(problem, start=start)
        cold = COLD in begun.status
        content = begun.acceptable
        yield ("human means" if cold else "neighbour"), begun
        starts -= 1
    if starts > 1:
        # in one process more: it is the cases that share the processors
        yield f"{starts} starts", solver(problem, starts=starts, seed=seed, workers=1)
    elif not cold and starts >= 0 and (starts == 1 or not content):
        yield "human means", solver(problem)


def _rank(gait: Solution) -> tuple[bool, float]:
    return not gait.acceptable, gait.energy_per_metre
