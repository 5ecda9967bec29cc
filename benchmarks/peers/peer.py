"""What every peer's program has in common: arguments, clocks, its one line of JSON."""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

import five_link as walker


@dataclass(frozen=True)
class Outcome:
    """Where one solve ended: the effort [N2 m2 s], and what the solver says of it."""

    effort: float
    converged: bool
    iterations: int
    message: str


Solver = Callable[[walker.Start], Outcome]


def main(versions: str, mesh: str, build: Callable[[str, int], Solver], fine: int) -> None:
    """Build the problem once, solve it from every start asked for, print one line of JSON.

    Parameters
    ----------
    versions : str
        What is compared.
    mesh : str
        The transcription in words; ``{n}`` stands for the number of elements.
    build : callable
        (variant, elements) -> solver.
    fine : int
        Number of elements unless the command line says otherwise.
    """
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--variant", choices=walker.VARIANTS, default="impact")
    arguments.add_argument("--elements", type=int, default=fine)
    arguments.add_argument("--seeds", type=int, default=0, help="random starts, after Kelly's")
    arguments.add_argument("--budget", type=float, default=math.inf, help="wall s for all starts")
    chosen = arguments.parse_args()
    answer = _quietly(lambda: _measured(build, chosen))
    answer |= {"versions": versions, "mesh": mesh.format(n=chosen.elements)}
    print(json.dumps(answer))


def _measured(build: Callable[[str, int], Solver], chosen: argparse.Namespace) -> dict[str, object]:
    began, wall = _cpu(), time.monotonic()
    solve = build(chosen.variant, chosen.elements)
    built = _cpu()
    seeds = [None, *range(1, chosen.seeds + 1)]
    outcomes = []
    for seed in seeds:
        if time.monotonic() - wall > chosen.budget:
            break
        outcomes.append(asdict(solve(walker.start(seed))))
    return {
        "build_cpu_s": built - began,
        "solve_cpu_s": _cpu() - built,
        "outcomes": outcomes,
    }


def _cpu() -> float:
    """CPU time [s] of this process and of the children it has waited for: a compiler, say."""
    own = os.times()
    return own.user + own.system + own.children_user + own.children_system


def _quietly(work: Callable[[], dict[str, object]]) -> dict[str, object]:
    """Do the work with standard output led to standard error: solvers print from below Python."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        return work()
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
