"""What a sweep costs beside its cases: ``python benchmarks/sweeps.py [NAME ...]``.

``throughput``
    Cases of two CPU seconds on one worker and on two: the ratio of cases a minute.
``overhead``
    Cases that only wait on two workers: what the sweep takes beyond that, start-up apart.
``continuation``
    Real gaits beside the default one: CPU seconds begun at a neighbour and begun at the human
    means.

The first two need no solver. COUNT and SECONDS in the environment change their cases, for a quick
look; CASES the number of neighbours.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from typing import Any

import numpy as np

import ergowalk
from ergowalk.study import Sweep, Tally
from ergowalk.study.results import collect

COUNT = int(os.environ.get("COUNT", "200"))
SECONDS = float(os.environ.get("SECONDS", "2.0"))
CASES = int(os.environ.get("CASES", "2"))


def wait(task: dict[str, Any]) -> dict[str, Any]:
    """A case that takes its time and nothing else."""
    time.sleep(SECONDS)
    return {"status": "rejected", "reason": "stands in for a case"}


def spin(task: dict[str, Any]) -> dict[str, Any]:
    """A case that takes its CPU time; a forked child begins at none."""
    while time.process_time() < SECONDS:
        np.linalg.solve(np.eye(50), np.ones(50))
    return {"status": "rejected", "reason": "stands in for a case"}


class Clock:
    """When the first case was under way and when the last had ended."""

    def __init__(self) -> None:
        self.first = self.last = 0.0
        self.before = 0

    def __call__(self, tally: Tally) -> None:
        """Take the state of a sweep."""
        now = time.monotonic()
        if tally.done and not self.first:
            self.first = now
            self.before = tally.done
        self.last = now


def timed(standin: str, count: int, workers: int) -> tuple[float, float]:
    """Seconds of a sweep from the end of its first case on, for each case after; and in all."""
    lengths = np.linspace(0.6, 0.9, count).tolist()
    definition = Sweep(
        base=ergowalk.preset("berbyuk2002"),
        grid={"step_length_m": lengths},
        solve={"continuation": False},
    )
    clock, began = Clock(), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        solver = f"sweeps:{standin}"
        ergowalk.sweep(definition, folder, workers=workers, solver=solver, progress=clock)
    return (clock.last - clock.first) / (count - clock.before), time.monotonic() - began


def throughput() -> None:
    """Cases a minute of one worker and of two."""
    rates = []
    for workers in (1, 2):
        each, whole = timed("spin", max(COUNT // 5, 4), workers)
        rates.append(60 / each)
        print(f"{workers} workers: {60 / each:.1f} cases a minute, {whole:.1f} s with start-up")
    print(f"ratio: {rates[1] / rates[0]:.2f} (cases of {SECONDS:g} CPU s, {os.cpu_count()} CPUs)")


def overhead() -> None:
    """What a case takes beyond its own time."""
    workers = 2
    each, whole = timed("wait", COUNT, workers)
    beyond = workers * each / SECONDS - 1
    print(
        f"{COUNT} cases of {SECONDS:g} s on {workers} workers: {workers * each:.4f} s a case, "
        f"overhead {100 * beyond:.2f} % = {1000 * (workers * each - SECONDS):.1f} ms a case; "
        f"{whole:.1f} s in all, {100 * (whole * workers / COUNT / SECONDS - 1):.2f} % with "
        "start-up and index"
    )


def continuation() -> None:
    """CPU seconds of the same cases, continued and cold."""
    times = {}
    base = ergowalk.preset("berbyuk2002")
    lengths = [round(0.76 * (1 + 0.02 * k), 6) for k in range(CASES + 1)]
    for continued in (True, False):
        definition = Sweep(
            base=base, grid={"step_length_m": lengths}, solve={"continuation": continued}
        )
        with tempfile.TemporaryDirectory() as folder:
            ergowalk.sweep(definition, folder, workers=2)
            found = collect(folder)
        times[continued] = found["cpu_s"].to_numpy()
        for case in range(CASES + 1):
            one = found.isel(step_length_m=case)
            print(
                f"L = {lengths[case]:g} m, {one['way'].item()}: E = "
                f"{one['energy_per_metre'].item():.2f} J/m, {one['cpu_s'].item():.1f} CPU s, "
                f"{one['peak_memory_mb'].item():.0f} MB, {one['status'].item()}"
            )
    ratio = times[False][1:].sum() / times[True][1:].sum()
    print(f"cold / continued, the first case apart: {ratio:.2f}")


def main() -> None:
    """Run what is asked for, all by default."""
    known = {f.__name__: f for f in (throughput, overhead, continuation)}
    for name in sys.argv[1:] or known:
        print(f"-- {name}")
        known[name]()


if __name__ == "__main__":
    main()
