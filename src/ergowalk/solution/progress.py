"""What a long computation says of itself while it runs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """One iteration: stage in words, iteration number, E [J/m] at the nodes of the mesh, largest
    violation (scaled), elapsed time [s]."""

    stage: str
    iteration: int
    energy_per_metre: float
    violation: float
    elapsed: float


Report = Callable[[Progress], None]
"""Called once an iteration; raising KeyboardInterrupt in it stops the computation."""
