"""How lies about a gait are told and kept: a change, and the line of the audit to name it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

SWING, HEEL, FLAT, FOREFOOT, TOE = range(5)
HIP, KNEE, ANKLE, METATARSAL = range(4)
THIGH, SHANK, FOOT, TOES = range(4)

LIMITS = frozenset(
    {"vertical_reaction_cap", "friction", "moment_limits", "moment_rate_limits", "reaction_upward"}
)
MOTION = frozenset(
    {"velocities", "accelerations", "no_impact", "periodicity", "leg_symmetry", "load_symmetry",
     "equations_of_motion", "work_energy", "joint_power", "joint_angles", "center_of_pressure"}
)  # fmt: skip


@dataclass(frozen=True)
class Lie:
    """A change to a dataset, the line that must fail, and others that may fail with it."""

    name: str
    tell: Callable[[xr.Dataset], xr.Dataset | None]
    line: str
    others: frozenset[str] = frozenset()


LIES: list[Lie] = []


def lie(line: str, *others: str, also: frozenset[str] = frozenset()) -> Any:
    """Register a lie under the name of its function; it may change in place or return a copy."""

    def register(tell: Callable[[xr.Dataset], xr.Dataset | None]) -> Any:
        name = tell.__name__.replace("_", " ")
        LIES.append(Lie(name, tell, line, frozenset(others) | also))
        return tell

    return register


def phase_of(gait: xr.Dataset, leg: int) -> np.ndarray:
    return gait["contact_phase"].values[:, leg]


def doubles(gait: xr.Dataset) -> np.ndarray:
    """Right-hand samples of the instants that stand twice."""
    return np.flatnonzero(np.diff(gait["time"].values) <= 0) + 1


def edit_json(gait: xr.Dataset, name: str, **changes: Any) -> None:
    gait.attrs[name] = json.dumps({**json.loads(gait.attrs[name]), **changes})


def set_problem(gait: xr.Dataset, table: str, key: str, value: str) -> None:
    """Write ``key = value`` into a table ("" is the top level) of the stored problem."""
    lines, here, done = [], "", False
    for line in gait.attrs["problem"].splitlines():
        if line.startswith("["):
            here = line.strip("[] ")
        if here == table and line.split("=")[0].strip() == key:
            lines.append(f"{key} = {value}")
            done = True
        else:
            lines.append(line)
    assert done, f"{table}.{key} is not in the stored problem"
    gait.attrs["problem"] = "\n".join(lines)
