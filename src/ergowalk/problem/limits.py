"""Physical limits beyond the paper's constraints: what keeps the problem well posed."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ergowalk.corridors import ANGLES
from ergowalk.errors import ProblemError
from ergowalk.problem.legs import LEG_TABLES, Same, of_leg
from ergowalk.quantities import JOINTS
from ergowalk.values import PositiveFloat, Value

Off = Literal["off"]
Bound = PositiveFloat | Off


class JointBounds(Value):
    """One bound per joint, or "off"."""

    _error = ProblemError

    hip: Bound = Field(default="off", description="bound at the hip, or 'off'")
    knee: Bound = Field(default="off", description="bound at the knee, or 'off'")
    ankle: Bound = Field(default="off", description="bound at the ankle, or 'off'")
    metatarsal: Bound = Field(default="off", description="bound at the metatarsal joint, or 'off'")

    def of(self, joint: str) -> float | None:
        """The bound of a joint, None where it is off."""
        value = getattr(self, joint)
        return None if value == "off" else value


class LegJointBounds(Value):
    """One bound per joint of one leg; "same" as of both."""

    _error = ProblemError

    hip: Bound | Same = Field(default="same", description="bound at the hip, 'off' or 'same'")
    knee: Bound | Same = Field(default="same", description="bound at the knee, 'off' or 'same'")
    ankle: Bound | Same = Field(default="same", description="bound at the ankle, 'off' or 'same'")
    metatarsal: Bound | Same = Field(
        default="same", description="bound at the metatarsal joint, 'off' or 'same'"
    )


class LegLimits(Value):
    """Limits of one leg; "same" as of both."""

    _error = ProblemError

    vertical_reaction_body_weights: Bound | Same = Field(
        default="same", description="cap on the vertical reaction in body weights"
    )
    friction_coefficient: Bound | Same = Field(default="same", description="friction cone")
    moment_rate_nm_per_kg_s: LegJointBounds | None = Field(
        default=None, description="bounds on the rate of the joint moments, N m/(kg s)"
    )
    moment_nm_per_kg: LegJointBounds | None = Field(
        default=None, description="bounds on the joint moments, N m/kg"
    )


class Limits(Value):
    """Physical limits beyond the paper's constraints; each can be switched off.

    As printed, Problem A has no smooth minimiser: work-optimal walking is impulsive, and with
    finer meshes moments and reactions grow into spikes while E keeps falling. Only a bound or a
    cost on the rate of the joint moments makes E converge.
    """

    _error = ProblemError

    vertical_reaction_body_weights: Bound = Field(
        default=1.3,
        description="cap on each leg's vertical reaction in body weights, or 'off'; a person "
        "walking at natural cadence peaks near 1.1",
    )
    friction_coefficient: Bound = Field(
        default=0.6,
        description="friction cone |R_x| <= mu R_y, or 'off'; dry floors give 0.5 to 0.8",
    )
    moment_rate_nm_per_kg_s: JointBounds = Field(
        default=JointBounds(hip=25.0, knee=25.0, ankle=25.0),
        description="bounds on the rate of the joint moments, N m/(kg s); muscles need time, "
        "and Winter's mean moments peak near 17",
    )
    moment_nm_per_kg: JointBounds = Field(
        default=JointBounds(), description="bounds on the joint moments, N m/kg: strength"
    )
    leg_1: LegLimits | None = Field(default=None, description="limits of leg 1 that differ")
    leg_2: LegLimits | None = Field(default=None, description="limits of leg 2 that differ")

    @property
    def bounds_moment_rate(self) -> bool:
        """Whether hip, knee and ankle have a bound that makes the problem well posed."""
        return all(
            of_leg(self, leg).moment_rate_nm_per_kg_s.of(joint) is not None
            for joint in ANGLES
            for leg in (0, 1)
        )

    def sentence(self) -> str:
        """The limits in words, to stand beside every E."""
        parts = []
        if self.vertical_reaction_body_weights != "off":
            parts.append(f"R_y <= {self.vertical_reaction_body_weights:g} body weights")
        if self.friction_coefficient != "off":
            parts.append(f"|R_x| <= {self.friction_coefficient:g} R_y")
        parts += _joint_sentence("moment rate", self.moment_rate_nm_per_kg_s, "N m/(kg s)")
        parts += _joint_sentence("moment", self.moment_nm_per_kg, "N m/kg")
        words = [", ".join(parts) or "no limits"]
        for leg, name in enumerate(LEG_TABLES):
            if getattr(self, name) is not None:
                words.append(f"leg {leg + 1}: {of_leg(self, leg).sentence()}")
        return "; ".join(words)


def _joint_sentence(what: str, bounds: JointBounds, unit: str) -> list[str]:
    by_value: dict[float, list[str]] = {}
    for joint in JOINTS:
        value = bounds.of(joint)
        if value is not None:
            by_value.setdefault(value, []).append(joint)
    return [f"{what} <= {v:g} {unit} at {', '.join(j)}" for v, j in by_value.items()]
