"""What is compared, and the yardstick."""

from __future__ import annotations

from dataclasses import dataclass

SD_FLOOR = 0.05
"""Smallest SD used, as a share of the largest SD of the same signal over the stride.

With Winter's natural cadence it applies in swing alone. RMS distances of the reactions hardly
feel it (1 % between floors of 2 and 10 %); at 10 % it would reach the knee moment in swing too.
"""

ANGLE_TOLERANCE_DEG = 0.1
"""How far an angle may stand outside a corridor and still count as inside: the tolerance that an
acceptable gait has. An optimum rides on its bounds, so without it rounding would decide."""


@dataclass(frozen=True)
class ComparedSignal:
    """One curve of Figures 3-10; ``positive`` says in words what its sign means."""

    figure: int
    name: str
    symbol: str
    unit: str
    positive: str


COMPARED = (
    ComparedSignal(3, "hip_angle", "mu^o", "deg", "flexion"),
    ComparedSignal(4, "knee_angle", "mu^k", "deg", "flexion"),
    ComparedSignal(5, "ankle_angle", "mu^a", "deg", "dorsiflexion"),
    ComparedSignal(6, "reaction_x", "R_x/M", "N/kg", "forward"),
    ComparedSignal(7, "reaction_y", "R_y/M", "N/kg", "up"),
    ComparedSignal(8, "hip_moment", "q/M", "N m/kg", "flexion"),
    ComparedSignal(9, "knee_moment", "u/M", "N m/kg", "extension"),
    ComparedSignal(10, "ankle_moment", "p/M", "N m/kg", "dorsiflexion"),
)
"""The signals of Figures 3-10 in the paper's order, with the paper's signs."""
