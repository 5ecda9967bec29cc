"""What is said of a search: how far two meshes differ, which constraints are in conflict."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from ergowalk.solving.stages import StageResult

CONFLICT, MOST_NAMED = 1e-4, 5
"""Violation (scaled) from which there is a conflict, and how many constraints are named."""

UNFINISHED = "ran out of iterations"
"""How a solver ends of which nothing more can be said."""

OF_THE_METHOD = ("continuity", "power slacks", "equations of motion (1)")
"""Rows that no problem can leave out: they carry a conflict, but none is about them."""


def conflict(result: StageResult) -> str:
    """Which constraints no motion near the last one could satisfy together, strongest first.

    Where the violation is least it sits in whatever rows it is cheapest in; which constraints press
    against each other is what their multipliers say.
    """
    minimum = result.minimum
    if minimum.violation <= CONFLICT or minimum.message == UNFINISHED:
        return ""
    pressing: dict[str, float] = {}
    labels = result.collocation.programme.labels
    for label, multiplier in zip(labels, np.abs(minimum.row_multipliers), strict=True):
        if label not in OF_THE_METHOD and np.isfinite(multiplier):
            name = re.sub(r" [12] \(6\)$", " (6)", label)  # both legs are one constraint
            pressing[name] = pressing.get(name, 0.0) + float(multiplier)
    named = sorted((p for p in pressing if pressing[p] > 0), key=lambda p: -pressing[p])
    if not named:
        return ""
    others = " and others" if len(named) > MOST_NAMED else ""
    return f"; in conflict: {', '.join(named[:MOST_NAMED])}{others}"


def moved(reported: dict[str, Any], check: dict[str, Any]) -> float:
    """By how much E, and the objective where it is another, differ on two meshes."""
    names = ("energy_per_metre", "objective_per_metre")
    pairs = [(float(check[n]), float(reported[n])) for n in names if n in reported]
    return max(abs(new / old - 1) for new, old in pairs)
