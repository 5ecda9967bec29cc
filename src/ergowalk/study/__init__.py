"""Studies of many gaits: sweeps over a problem, their maps, and the walk a person would choose."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ergowalk.study.definition import Sweep, read_sweep
    from ergowalk.study.people import StepsOfPeople, steps_of_people
    from ergowalk.study.preference import ENERGY, Criterion, Preferred, preferred
    from ergowalk.study.results import collect
    from ergowalk.study.running import sweep
    from ergowalk.study.tally import Tally

_HOMES = {
    "ENERGY": "preference",
    "Criterion": "preference",
    "Preferred": "preference",
    "StepsOfPeople": "people",
    "Sweep": "definition",
    "Tally": "tally",
    "collect": "results",
    "preferred": "preference",
    "read_sweep": "definition",
    "steps_of_people": "people",
    "sweep": "running",
}
"""Names and their modules, loaded on first use: a worker of a cluster needs few of them."""

__all__ = [
    "ENERGY",
    "Criterion",
    "Preferred",
    "StepsOfPeople",
    "Sweep",
    "Tally",
    "collect",
    "preferred",
    "read_sweep",
    "steps_of_people",
    "sweep",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(importlib.import_module(f"ergowalk.study.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'ergowalk.study' has no attribute '{name}'")
