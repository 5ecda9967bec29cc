"""A stand-in for a solver, as a sweep takes it: ``standins:walk``.

It makes up gaits in milliseconds whose E is a known function of L and T. The name of the problem,
which is not part of a key, says what else happens. Beside the folder of the sweep, FOLDER.log gets
a line for each case that is begun, with its process, and while there is FOLDER.gate cases wait.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.gait.rhythm import PRINTED_RHYTHM
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.study.searching import searched

JOINTS = ("hip", "knee", "ankle", "metatarsal")


def energy(length: float, stride: float) -> float:
    """E(L, T) [J/m] with its valley at L = 0.6 m + 0.1 m * (speed - 1.33 m/s)."""
    speed = 2 * length / stride
    return 40.0 + 10 * (speed - 1.2) ** 2 + 200 * (length - 0.6 - 0.1 * (speed - 1.33)) ** 2


def gait(problem: GaitProblem, acceptable: bool = True) -> Solution:
    """A made-up gait: constant powers that add up to E, nothing moves."""
    length, stride = problem.step_length_m, problem.stride_time_s
    time_, n = np.linspace(0.0, stride, 11), 11
    whole = energy(length, stride)
    power = np.full((n, 2, 4), whole * 2 * length / stride / 8)
    weight = problem.body.total_mass * problem.body.gravity_m_s2
    dataset = xr.Dataset(
        {
            "joint_power": (("time", "leg", "joint"), power),
            "joint_moment": (("time", "leg", "joint"), 0 * power + 40.0),
            "ground_reaction_force": (("time", "leg", "axis"), np.full((n, 2, 2), 1.1 * weight)),
        },
        coords={"time": time_, "leg": [1, 2], "axis": ["x", "y"], "joint": list(JOINTS)},
        attrs={
            "energy_per_metre": whole,
            "step_length": length,
            "stride_time": stride,
            "acceptable": int(acceptable),
            "solver_status": "made up",
            "rhythm": json.dumps(PRINTED_RHYTHM.as_dict()),
            "body_parameters": json.dumps(problem.body.by_symbol()),
            "problem": problem_to_toml(problem),
        },
    )
    return Solution(dataset)


def walk(task: dict[str, Any]) -> dict[str, Any]:
    """The gait of a case at once, or what the name of its problem says instead."""
    folder = Path(task["gait"]).parents[2]
    with contextlib.suppress(OSError), open(folder.with_suffix(".log"), "a") as file:
        file.write(f"{Path(task['gait']).stem} {os.getpid()}\n")
    gate = folder.with_suffix(".gate")
    while gate.exists():
        time.sleep(0.02)
    return searched(task, _walk if task["starts"] else _looked)


def _looked(problem: GaitProblem, **choices: Any) -> Solution:
    """A second look, which finds what the first has missed."""
    return gait(problem)


def _walk(problem: GaitProblem, **choices: Any) -> Solution:
    if problem.name == "rough" and round(problem.step_length_m, 3) in MISSED:
        dataset = gait(problem).dataset
        dear = MISSED[round(problem.step_length_m, 3)] * dataset.attrs["energy_per_metre"]
        return Solution(dataset.assign_attrs(energy_per_metre=dear))
    if problem.name == "slow":
        time.sleep(SLOW_S)
    what = TROUBLES.get(round(problem.step_length_m, 3)) if problem.name == "troubled" else ""
    if what == "hang":
        hang()
    if what == "memory":
        return gait(problem, bool(np.ones((1 << 31,), dtype=np.uint8).all()))
    if what == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if what == "error":
        raise ZeroDivisionError("division by\nzero")
    return gait(problem, acceptable=what != "rejected")


SLOW_S = 0.5

MISSED = {0.64: 1.05, 0.7: 1.02}
"""What E is at first of some step lengths, over the least."""

TROUBLES = {0.51: "hang", 0.52: "memory", 0.53: "crash", 0.54: "error", 0.55: "rejected"}


def hang() -> None:
    """Never return, deaf to everything but SIGKILL."""
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)
    while True:
        time.sleep(60)
