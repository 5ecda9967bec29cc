"""The solver of a sweep; a module of its own, because a nursery loads it before the first case."""

from __future__ import annotations

from typing import Any

from ergowalk.solving import solve
from ergowalk.study.searching import searched


def search(task: dict[str, Any]) -> dict[str, Any]:
    """Find, measure and store the gait of a case; see :func:`~ergowalk.study.searching.searched`.

    Raises
    ------
    InputError
        If the problem cannot be used or the gait cannot be written.
    """
    return searched(task, solve)
