"""What other choices of the solver cost: ``python benchmarks/solver_choices.py``.

One programme, the default problem with the rhythm held on the coarse mesh, is solved with each
choice in turn, ``RUNS`` times interleaved. Printed are iterations and CPU seconds, as ratios to the
choice that ergowalk makes. Dead ends stay in the list, so that nobody walks into them twice.
"""

from __future__ import annotations

import os
import statistics
from dataclasses import replace
from typing import Any

# SPRAL refuses to start without; libraries read them when they are loaded
os.environ.update(OMP_CANCELLATION="TRUE", OMP_PROC_BIND="TRUE", OMP_NUM_THREADS="1")

import ergowalk
from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving.stages import COARSE, SEARCH_BARRIER, Effort, OrderSearch, Start, with_times
from ergowalk.transcription.guess import loaded_guess
from ergowalk.transcription.walker import Smoothing

RUNS = 3

OURS = Ipopt(tolerance=1e-3, barrier_end=SEARCH_BARRIER)
CHOICES: dict[str, Ipopt] = {
    "ours: MUMPS, adaptive barrier down to 1e-4": OURS,
    "barrier down to nothing": replace(OURS, tolerance=1e-4, barrier_end=0.0),
    "monotone barrier": replace(OURS, strategy="monotone", barrier_start=0.1),
    "adaptive barrier by the KKT error": replace(
        OURS, extra={"adaptive_mu_globalization": "kkt-error"}
    ),
    "MUMPS with METIS": replace(OURS, extra={"mumps_pivot_order": 5}),
    "MUMPS with AMD": replace(OURS, extra={"mumps_pivot_order": 0}),
    "SPRAL": replace(OURS, extra={"linear_solver": "spral", "spral_use_gpu": "no"}),
}


def main() -> None:
    """Solve with every choice, print the table."""
    problem, order = ergowalk.preset("berbyuk2002"), PhaseOrder.FLAT_FIRST
    search = OrderSearch(problem, (order,), Smoothing(), Effort(), None)
    fit = search.fit()
    start = Start(loaded_guess(search.walker, order, fit), fit.times)
    phased, mesh = with_times(search.phased, fit.times), search._mesh(fit.times, COARSE)
    found: dict[str, list[Any]] = {name: [] for name in CHOICES}
    for _ in range(RUNS):
        for name, solver in CHOICES.items():
            found[name].append(search._run(name, phased, mesh, start, solver).minimum)
    own = found[next(iter(CHOICES))]
    seconds = statistics.median(m.solve_time for m in own)
    print(f"{'choice':45s} iterations  time: total  per iteration  converged")
    for name, minima in found.items():
        taken = statistics.median(m.solve_time for m in minima)
        count, ours = minima[0].iterations, own[0].iterations
        each = (taken / count) / (seconds / ours)
        print(
            f"{name:45s} {count:10d} {taken / seconds:12.2f} {each:14.2f}  "
            f"{'yes' if minima[0].converged else minima[0].message}"
        )


if __name__ == "__main__":
    main()
