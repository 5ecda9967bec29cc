"""Stand-ins for a solver, as a sweep takes them: ``standins:NAME``.

Each makes up a gait in milliseconds whose E is a known function of L and T. What goes wrong is
decided by the problem alone, or by a file whose path is in the environment.
"""

from __future__ import annotations

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

LOG = "ERGOWALK_TEST_LOG"
"""Environment variable: a file that gets a line for each case that is begun."""


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


def _walk(problem: GaitProblem, **choices: Any) -> Solution:
    return gait(problem)


def walk(task: dict[str, Any]) -> dict[str, Any]:
    """Every case has its gait at once."""
    _log(task)
    return searched(task, _walk)


def slow(task: dict[str, Any]) -> dict[str, Any]:
    """As walk, after half a second."""
    _log(task)
    time.sleep(0.5)
    return searched(task, _walk)


def troubled(task: dict[str, Any]) -> dict[str, Any]:
    """Short steps hang, and so on: a case for every way to fail."""
    _log(task)
    return searched(task, _troubled)


def _troubled(problem: GaitProblem, **choices: Any) -> Solution:
    what = TROUBLES.get(round(problem.step_length_m, 3))
    if what == "hang":
        hang()
    if what == "memory":
        return gait(problem, bool(np.ones((1 << 31,), dtype=np.uint8).all()))
    if what == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if what == "error":
        raise ZeroDivisionError("division by\nzero")
    return gait(problem, acceptable=what != "rejected")


TROUBLES = {0.51: "hang", 0.52: "memory", 0.53: "crash", 0.54: "error", 0.55: "rejected"}


def hang() -> None:
    """Never return, deaf to everything but SIGKILL."""
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)
    while True:
        sum(range(10**7))  # one call of C code after the other


def gated(task: dict[str, Any]) -> dict[str, Any]:
    """As walk, but a case waits as long as the file of the gate is there."""
    _log(task)
    gate = Path(task["gait"]).parents[2].with_suffix(".gate")
    while gate.exists():
        time.sleep(0.02)
    return searched(task, _walk)


def _log(task: dict[str, Any]) -> None:
    """Note that a case has begun, and in which process."""
    if LOG in os.environ:
        with open(os.environ[LOG], "a") as file:
            file.write(f"{Path(task['gait']).stem} {os.getpid()}\n")
