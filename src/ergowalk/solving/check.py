"""The check of a mesh on a finer one, and when a neighbour's gait may take it over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ergowalk.solution import Solution

NEIGHBOUR = 0.15
"""A check holds for gaits on the same mesh whose E differs by no more than this share from that of
the gait that was checked.

Of fifty gaits of one map, each with a check of its own (0.03 to 0.39 % of E), two whose E differs
by less than 5 % have checks 0.07 % of E apart in the median and at most 0.25 %; by less than 15 %,
0.08 and at most 0.27 %."""


@dataclass(frozen=True)
class MeshCheck:
    """What a finer mesh changed in a gait.

    Attributes
    ----------
    energy : float
        E [J/m] of the gait that was checked.
    finer : int
        Elements of the mesh of the check.
    change : float
        E on the finer mesh over E on the other, less 1.
    """

    energy: float
    finer: int
    change: float

    @classmethod
    def of(cls, gait: Solution) -> MeshCheck | None:
        """The check of an acceptable gait, or the one that it took over itself."""
        found = {k: e for e in gait.mesh_history for k in ("final", "finer") if e.get(k)}
        if not gait.acceptable or len(found) < 2:
            return None
        final, finer = found["final"], found["finer"]
        return cls(
            energy=finer.get("carried_from", final["energy_per_metre"]),
            finer=finer["elements"],
            change=finer["energy_per_metre"] / final["energy_per_metre"] - 1,
        )

    def holds_for(self, energy: float, elements: int) -> bool:
        """Whether a gait of that E [J/m] is near enough, on that mesh or with elements cut."""
        return abs(energy / self.energy - 1) <= NEIGHBOUR and elements < self.finer

    def record(self, energy: float) -> dict[str, Any]:
        """The line of a mesh history for a gait of that E [J/m] that takes the check over."""
        return {
            "elements": self.finer,
            "energy_per_metre": energy * (1 + self.change),
            "converged": True,
            "finer": True,
            "carried_from": self.energy,
        }

    def words(self, energy: float, elements: int) -> str:
        """How a status says it."""
        return (
            f"converged: E = {energy:.2f} J/m on {elements} elements; the check, "
            f"{100 * self.change:+.2f} % on {self.finer}, is that of the gait with "
            f"{self.energy:.2f} J/m that it continues"
        )
