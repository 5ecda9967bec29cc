"""What is known of human walking: its signals and their signs, mean and SD of each."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ergowalk.corridors.periodic import Corridor, PeriodicCurve
from ergowalk.errors import CorridorError

ANGLES = ("hip", "knee", "ankle")
"""Joints with an angle corridor, in the order of (6)."""


@dataclass(frozen=True)
class Signal:
    """A column pair of a table of human gait, and how it maps to the model's signs."""

    name: str
    stem: str
    unit: str
    sign: float
    label: str

    @property
    def columns(self) -> tuple[str, str]:
        """Column names of mean and standard deviation."""
        return f"{self.stem}_mean_{self.unit}", f"{self.stem}_sd_{self.unit}"


SIGNALS = {
    s.name: s
    for s in (
        Signal("hip_angle", "hip_flexion_angle", "deg", 1.0, "hip angle"),
        Signal("knee_angle", "knee_flexion_angle", "deg", 1.0, "knee angle"),
        Signal("ankle_angle", "ankle_dorsiflexion_angle", "deg", 1.0, "ankle angle"),
        Signal("reaction_x", "forward_reaction", "n_per_kg", 1.0, "horizontal reaction"),
        Signal("reaction_y", "vertical_reaction", "n_per_kg", 1.0, "vertical reaction"),
        # q and p are counter-clockwise on the distal segment: extension and plantarflexion are
        # clockwise there, knee extension is counter-clockwise on the shank.
        Signal("hip_moment", "hip_extension_moment", "nm_per_kg", -1.0, "hip moment"),
        Signal("knee_moment", "knee_extension_moment", "nm_per_kg", 1.0, "knee moment"),
        Signal("ankle_moment", "ankle_plantarflexion_moment", "nm_per_kg", -1.0, "ankle moment"),
        Signal("hip_power", "hip_power", "w_per_kg", 1.0, "hip power"),
        Signal("knee_power", "knee_power", "w_per_kg", 1.0, "knee power"),
        Signal("ankle_power", "ankle_power", "w_per_kg", 1.0, "ankle power"),
    )
}
"""Every signal a table may carry, by name; signs: +1 where the table's sign is the model's."""


@dataclass(frozen=True)
class HumanGait:
    """Mean and SD curves of human walking in the model's signs (angles in degrees)."""

    name: str
    curves: dict[str, tuple[PeriodicCurve, PeriodicCurve]]

    def corridor(self, signal: str, width: float = 1.0) -> Corridor:
        """Corridor of ``width`` standard deviations around ``signal``, in the table's unit.

        Raises
        ------
        CorridorError
            If the table has no such signal.
        """
        if signal not in self.curves:
            raise CorridorError(
                f"has no columns {' and '.join(SIGNALS[signal].columns)}",
                "add them, or choose another table",
                file=self.name,
            )
        mean, sd = self.curves[signal]
        return Corridor(mean, sd, width)

    def angle_corridor(self, joint: str, width: float) -> Corridor:
        """Corridor of a joint angle in radians."""
        mean, sd = self.curves[f"{joint}_angle"]
        zero = PeriodicCurve((0.0,) * len(mean.cosine), (0.0,) * len(mean.sine))
        scale = math.pi / 180
        return Corridor(zero.combined(mean, scale), zero.combined(sd, scale), width)
