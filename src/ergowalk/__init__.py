"""Energy-optimal walking of a nine-link biped.

>>> import ergowalk
>>> problem = ergowalk.preset("berbyuk2002")
>>> problem.step_length_m, problem.stride_time_s
(0.76, 1.14)

``ergowalk.solve(problem)`` finds the cheapest gait; ``Solution.audit()`` checks it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from ergowalk.body import Body
    from ergowalk.corridors import Corridor, human_gait
    from ergowalk.problem import GaitProblem, preset
    from ergowalk.problem.files import read_problem
    from ergowalk.solution import Solution
    from ergowalk.solving import design, follow, solve
    from ergowalk.study import preferred, read_sweep, sweep

_HOMES = {
    "Body": "ergowalk.body",
    "Corridor": "ergowalk.corridors",
    "GaitProblem": "ergowalk.problem",
    "Solution": "ergowalk.solution",
    "design": "ergowalk.solving",
    "follow": "ergowalk.solving",
    "human_gait": "ergowalk.corridors",
    "preferred": "ergowalk.study",
    "preset": "ergowalk.problem",
    "read_problem": "ergowalk.problem.files",
    "read_sweep": "ergowalk.study",
    "solve": "ergowalk.solving",
    "sweep": "ergowalk.study",
}
"""Public names and where they live; loaded on first use, so that importing is quick."""

__all__ = [
    "Body",
    "Corridor",
    "GaitProblem",
    "Solution",
    "design",
    "follow",
    "human_gait",
    "preferred",
    "preset",
    "read_problem",
    "read_sweep",
    "solve",
    "sweep",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(importlib.import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'ergowalk' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
