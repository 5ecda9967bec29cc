"""The same problem from many starts, in worker processes, and the optima they end in."""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import ProblemError
from ergowalk.problem import GaitProblem
from ergowalk.solution import Progress, Solution
from ergowalk.solution.progress import Report
from ergowalk.solving.collocation import solve_collocation
from ergowalk.transcription.perturbation import Perturbation
from ergowalk.transcription.walker import Smoothing

Array = NDArray[np.float64]

SAME_OPTIMUM_DEG = 1.0
"""Two gaits whose hip, knee and ankle angles differ by less, r.m.s., are one optimum."""

MOST_STARTS = 10_000
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""What tells the libraries of a worker to keep to one thread."""


@dataclass(frozen=True)
class Optimum:
    """A distinct optimum: its E [J/m], how many starts ended there, and which was the best."""

    energy_per_metre: float
    hits: int
    best_start: int
    phase_order: str
    rhythm: dict[str, float]
    distance_deg: float


@dataclass(frozen=True)
class Catalogue:
    """What became of all starts.

    ``optima`` are those of the accepted gaits, cheapest first; ``distance_deg`` of each is the
    r.m.s. distance of its joint angles from those of the first.
    """

    starts: int
    seed: int
    accepted: int
    converged: int
    optima: tuple[Optimum, ...]

    def as_json(self) -> str:
        """As text for the attribute ``starts`` of a gait file."""
        return json.dumps(asdict(self))


def solve_from_starts(
    problem: GaitProblem,
    starts: int,
    seed: int = 0,
    *,
    workers: int | None = None,
    progress: Report | None = None,
    smoothing: Smoothing | None = None,
) -> Solution:
    """The best of ``starts`` searches by collocation; the first begins from the human means.

    The others begin from seeded disturbances of them. Each runs in a process of its own with one
    thread, so the answer depends on ``starts`` and ``seed`` alone, not on how many ``workers``
    share the work (default: one for each processor).

    Returns
    -------
    Solution
        The cheapest accepted gait, else the cheapest, with the :class:`Catalogue` in its
        attribute ``starts``.

    Raises
    ------
    ProblemError
        For a number of starts or workers below 1, or a negative seed.
    """
    for name, value, least in (("starts", starts, 1), ("seed", seed, 0), ("workers", workers, 1)):
        if value is not None and not least <= value <= MOST_STARTS:
            raise ProblemError(
                f"must lie between {least} and {MOST_STARTS}",
                "give a whole number",
                field=name,
                value=value,
            )
    found: dict[int, Solution] = {}
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="ergowalk-") as folder, _one_thread():
        context = multiprocessing.get_context("spawn")
        count = min(starts, workers or os.cpu_count() or 1)
        with ProcessPoolExecutor(count, context, _leave_interrupts_to_the_parent) as pool:
            jobs: dict[Future[str], int] = {
                pool.submit(solve_start, problem, seed, i, smoothing, folder): i
                for i in range(starts)
            }
            try:
                for job in as_completed(jobs):
                    gait = Solution.load(job.result())
                    found[jobs[job]] = Solution(gait.dataset, problem.folder)
                    if progress is not None:
                        words, elapsed = f"{starts} starts, ended", time.monotonic() - began
                        energy = gait.energy_per_metre
                        progress(Progress(words, len(found), energy, 0.0, elapsed))
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                for worker in multiprocessing.active_children():
                    worker.terminate()
                raise
    gaits = [found[i] for i in range(starts)]
    catalogue = catalogued(gaits, seed)
    best = min(gaits, key=lambda g: (not g.acceptable, g.energy_per_metre))
    dataset = best.dataset.assign_attrs(starts=catalogue.as_json())
    return Solution(dataset, problem.folder)


def _leave_interrupts_to_the_parent() -> None:
    """An interrupt from the keyboard reaches the workers too; the parent ends them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def solve_start(
    problem: GaitProblem, seed: int, index: int, smoothing: Smoothing | None, folder: str
) -> str:
    """The gait of start ``index`` in ``folder``, as INDEX.nc; its path. Work of one process."""
    perturbation = Perturbation(seed, index) if index else None
    gait = solve_collocation(problem, smoothing, None, None, perturbation)
    return str(gait.save(Path(folder) / f"{index}.nc"))


def catalogued(gaits: Sequence[Solution], seed: int = 0) -> Catalogue:
    """The distinct optima among accepted gaits, by the distance of their joint angles."""
    order = sorted(range(len(gaits)), key=lambda i: gaits[i].energy_per_metre)
    groups: list[list[int]] = []
    angles = {i: _angles(gaits[i]) for i in order if gaits[i].acceptable}
    for i in angles:
        for group in groups:
            if _distance(angles[i], angles[group[0]]) < SAME_OPTIMUM_DEG:
                group.append(i)
                break
        else:
            groups.append([i])
    optima = tuple(
        Optimum(
            energy_per_metre=gaits[first].energy_per_metre,
            hits=1 + len(rest),
            best_start=first,
            phase_order=str(gaits[first].dataset.attrs["phase_order"]),
            rhythm=gaits[first].rhythm.as_dict(),
            distance_deg=_distance(angles[first], angles[groups[0][0]]),
        )
        for first, *rest in groups
    )
    converged = sum(gait.status.startswith(("converged: ", "converged on")) for gait in gaits)
    return Catalogue(len(gaits), seed, len(angles), converged, optima)


def _angles(gait: Solution) -> Array:
    """Hip, knee and ankle angle of leg 1 at 201 equal steps of the stride [deg]."""
    time = gait.dataset["time"].to_numpy()
    angles = gait.dataset["joint_angle"].transpose("time", "leg", "joint").to_numpy()[:, 0, :3]
    steps = np.linspace(0.0, time[-1], 201)
    curves: Array = np.stack([np.interp(steps, time, angle) for angle in angles.T])
    return np.degrees(curves)


def _distance(one: Array, other: Array) -> float:
    return float(np.sqrt(np.mean((one - other) ** 2)))


@contextmanager
def _one_thread() -> Iterator[None]:
    """Processes started meanwhile keep to one thread each."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
