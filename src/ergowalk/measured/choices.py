"""What a person may choose when a walk is measured."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ergowalk.errors import RecordingError
from ergowalk.values import FiniteFloat, PositiveFloat, Value


class Choices(Value):
    """How a recording becomes a measured walk; every figure depends on these."""

    _error = RecordingError

    name: str = Field(default="measured", description="a name for the person or the trial")
    markers: str | None = Field(
        default=None, description="a marker set by name or a TOML file; none: by the markers' names"
    )
    units: Literal["mm", "cm", "m"] | None = Field(
        default=None, description="unit of lengths, where the file states none or a wrong one"
    )
    flip_forces: bool = Field(
        default=False, description="whether the plates give the force of the foot on the ground"
    )
    mass_kg: PositiveFloat | None = Field(
        default=None, description="mass of the body; none: what the plates carry over a stride"
    )
    height_m: PositiveFloat | None = Field(
        default=None, description="height of the body; none: from the length of the legs"
    )
    sex: Literal["male", "female"] | None = Field(
        default=None, description="de Leva's table of segments; Dempster's unless said"
    )
    cutoff_hz: FiniteFloat = Field(
        default=6.0, ge=2.0, le=50.0, description="cut-off of the low-pass filter of markers, Hz"
    )
    force_cutoff_hz: FiniteFloat | None = Field(
        default=None,
        ge=2.0,
        le=500.0,
        description="cut-off of the low-pass filter of forces, Hz; none: only what the rate of the "
        "markers cannot hold is taken away",
    )
    sd_floor_deg: FiniteFloat = Field(
        default=5.0, ge=0.5, le=30.0, description="least SD of an angle in the corridors, degrees"
    )
    kinematic_events: bool = Field(
        default=False, description="whether contacts are found without the plates"
    )
