"""Which human data bound the joint angles (6), and how widely."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ergowalk.errors import CorridorError
from ergowalk.problem.legs import Same
from ergowalk.problem.limits import Off
from ergowalk.values import PositiveFloat, Value

Width = PositiveFloat | Literal["same"] | Off


class LegCorridors(Value):
    """Corridors of one leg; "same" as of both."""

    _error = CorridorError

    source: str = Field(default="same", description="human data, or 'same'")
    width_sd: PositiveFloat | Same = Field(default="same", description="half width in SDs")
    hip_width_sd: Width = Field(default="same", description="half width at the hip")
    knee_width_sd: Width = Field(default="same", description="half width at the knee")
    ankle_width_sd: Width = Field(default="same", description="half width at the ankle")


class Corridors(Value):
    """Which human data bound the joint angles (6), and how widely."""

    _error = CorridorError

    source: str = Field(
        default="winter-natural",
        description="'winter-slow', 'winter-natural', 'winter-fast', or a CSV file",
    )
    width_sd: PositiveFloat = Field(
        default=1.0, description="half width of the corridors in standard deviations"
    )
    hip_width_sd: Width = Field(
        default="same", description="half width at the hip, 'same', or 'off' (no corridor)"
    )
    knee_width_sd: Width = Field(default="same", description="half width at the knee")
    ankle_width_sd: Width = Field(default="same", description="half width at the ankle")
    leg_1: LegCorridors | None = Field(default=None, description="corridors of leg 1 that differ")
    leg_2: LegCorridors | None = Field(default=None, description="corridors of leg 2 that differ")

    def width(self, joint: str) -> float | None:
        """Half width at a joint in standard deviations, None where there is no corridor."""
        value = getattr(self, f"{joint}_width_sd")
        if value == "off":
            return None
        return self.width_sd if value == "same" else float(value)
