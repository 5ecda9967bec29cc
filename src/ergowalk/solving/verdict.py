"""What is said of a search: how far two meshes differ, which constraints are in conflict."""

from __future__ import annotations

from typing import Any

from ergowalk.solving.stages import StageResult

CONFLICT, MOST_NAMED = 1e-4, 4
"""Violation (scaled) from which a constraint is in conflict, and how many of them are named."""


def conflict(result: StageResult) -> str:
    """Which constraints no motion near the last one could satisfy together, worst first."""
    violations = result.collocation.programme.violations(result.minimum.x)
    worst = sorted((v, name) for name, v in violations.items() if v > CONFLICT)[::-1]
    if not worst or result.minimum.violation <= CONFLICT:
        return ""
    named = ", ".join(name for _, name in worst[:MOST_NAMED])
    return f"; in conflict: {named}" + (" and others" if len(worst) > MOST_NAMED else "")


def moved(reported: dict[str, Any], check: dict[str, Any]) -> float:
    """By how much E, and the objective where it is another, differ on two meshes."""
    names = ("energy_per_metre", "objective_per_metre")
    pairs = [(float(check[n]), float(reported[n])) for n in names if n in reported]
    return max(abs(new / old - 1) for new, old in pairs)
