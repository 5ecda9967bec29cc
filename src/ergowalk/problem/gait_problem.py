"""Problem A as a value: what is given, what is free, and between which bounds."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Any, Self

from pydantic import Field, model_validator

from ergowalk.anthropometry import Person
from ergowalk.body import Body, LegParameters
from ergowalk.corridors import ANGLES, Corridor, HumanGait, human_gait
from ergowalk.errors import BodyError, ProblemError
from ergowalk.problem.corridors import Corridors
from ergowalk.problem.design import Design, check_design, with_values
from ergowalk.problem.devices import Device, Devices
from ergowalk.problem.legs import Stride, exchanged, has_leg_tables, of_leg
from ergowalk.problem.limits import Limits
from ergowalk.problem.objective import Objective
from ergowalk.problem.rhythm import RhythmBounds
from ergowalk.values import INPUT_ONLY, PositiveFloat, Value, invalid


class DoubleSupport(StrEnum):
    """How the load is shared while both feet are on the ground."""

    OPTIMAL = "optimal"
    LINEAR = "linear"


class GaitProblem(Value):
    """Problem A: the cheapest periodic walk of a body at a step length and a stride time.

    Raises
    ------
    ProblemError, BodyError, CorridorError
        For fields out of range or contradicting each other, and for a step that the legs cannot
        reach.
    """

    _error = ProblemError

    name: str = Field(default="custom", description="a name for the problem")
    step_length_m: PositiveFloat = Field(description="step length L, half the stride, in m")
    stride_time_s: PositiveFloat = Field(
        description="stride time T (double step) as a positive number in s"
    )
    double_support: DoubleSupport = Field(
        default=DoubleSupport.OPTIMAL,
        description="'optimal' (sharing of load left to the optimiser) or 'linear' (12)",
    )
    person: Person | None = Field(
        default=None,
        exclude=True,
        description="a person's height and mass, from which the body follows",
        json_schema_extra=INPUT_ONLY,
    )
    body: Body = Field(
        default=Body(),
        description="the walker; what is left out is the paper's, or that of a table [person] "
        "with height_m and mass_kg",
    )
    corridors: Corridors = Field(default=Corridors(), description="human corridors (6)")
    rhythm: RhythmBounds = Field(default=RhythmBounds(), description="contact instants (3)")
    limits: Limits = Field(default=Limits(), description="physical limits")
    objective: Objective = Field(
        default=Objective(), description="what is minimised: a weighted sum, (10) alone by default"
    )
    stride: Stride = Field(default=Stride(), description="both legs' steps, where they differ")
    devices: Devices = Field(
        default=Devices(),
        description="passive devices, a table [devices.hip], [devices.knee], [devices.ankle] or "
        "[devices.metatarsal] for each joint that has one",
    )
    design: Design = Field(
        default=Design(),
        description="numbers of body and devices that are found with the gait, as "
        '"PATH" = [lowest, highest]; their values above are where the search starts',
        json_schema_extra={"default": {}},
    )
    folder: Path | None = Field(
        default=None, exclude=True, description="where relative file names start"
    )

    @property
    def well_posed(self) -> bool:
        """Whether a bound or a cost keeps the moments from growing to spikes."""
        return self.limits.bounds_moment_rate or self.objective.charges_moments

    def conditions(self) -> str:
        """What every E is stated with, in words: the limits, and what was minimised if not E."""
        parts = [self.limits.sentence()]
        if not self.objective.is_eq10:
            parts.append(f"minimised: {self.objective.sentence()}")
        if self.devices.sentence():
            parts.append(f"devices: {self.devices.sentence()}")
        if self.design:
            parts.append(f"free: {self.design.sentence()}")
        return "; ".join(parts)

    def devices_of(self, leg: int) -> tuple[tuple[str, Device], ...]:
        """(joint, device) of every device of a leg (0 is leg 1 of the paper)."""
        return tuple(self.devices.of(leg).items())

    def limits_of(self, leg: int) -> Limits:
        """Limits of a leg (0 is leg 1)."""
        return of_leg(self.limits, leg)

    def rhythm_of(self, leg: int) -> RhythmBounds:
        """Bounds of the rhythm of a leg (0 is leg 1)."""
        return of_leg(self.rhythm, leg)

    def corridors_of(self, leg: int) -> Corridors:
        """What is asked of the corridors of a leg (0 is leg 1)."""
        return of_leg(self.corridors, leg)

    @property
    def legs_differ(self) -> bool:
        """Whether a parameter, a bound or a device is that of one leg alone."""
        tables = (self.limits, self.rhythm, self.corridors, self.devices)
        return not self.body.legs_equal or any(has_leg_tables(table) for table in tables)

    @property
    def full_stride(self) -> bool:
        """Whether both halves of the stride are solved, each leg with a rhythm of its own."""
        if self.stride.legs == "auto":
            return self.legs_differ
        return self.stride.legs == "each"

    def exchanged(self) -> GaitProblem:
        """The same problem with the legs exchanged: leg 2 is called leg 1."""
        changes = {name: exchanged(getattr(self, name)) for name in LEG_SPECIFIC}
        changes |= {"body": self.body.exchanged(), "stride": self.stride.exchanged()}
        return self.model_copy(update=changes)  # may hold expressions: nothing to validate anew

    def mirrored(self) -> GaitProblem:
        """The problem of a walker whose legs are equal: the mean of both, and what both share."""
        found: GaitProblem = self.replace(
            body=self.body.mirrored(),
            stride=Stride(legs="mirrored"),
            design=Design(),
            **{name: getattr(self, name).replace(leg_1=None, leg_2=None) for name in LEG_SPECIFIC},
        )
        return found

    def with_design(self, values: Mapping[str, float]) -> GaitProblem:
        """The problem with numbers of body and devices replaced, by path; bounds are kept."""
        return with_values(self, values)

    def human(self) -> HumanGait:
        """The human data that the corridors come from."""
        return human_gait(self.corridors.source, self.folder)

    def angle_corridors(self, leg: int = 0) -> dict[str, Corridor]:
        """Corridors of hip, knee and ankle angle of a leg in radians (6).

        One that is off is there too, :meth:`Corridors.width` says so: its middle is where a search
        begins.
        """
        asked = self.corridors_of(leg)
        human = human_gait(asked.source, self.folder)
        return {
            joint: human.angle_corridor(joint, asked.width(joint) or asked.width_sd)
            for joint in ANGLES
        }

    @model_validator(mode="before")
    @classmethod
    def _older_files(cls, data: Any) -> Any:
        """The cost of moment rates once stood among the limits."""
        limits = data.get("limits") if isinstance(data, dict) else None
        if not isinstance(limits, dict) or "moment_rate_cost_s3_per_m2" not in limits:
            return data
        objective = data.get("objective", {})
        weight = limits["moment_rate_cost_s3_per_m2"]
        if weight != "off" and isinstance(objective, dict):
            objective = {"moment_rate_squared_s3_per_m2": weight, **objective}
        rest = {k: v for k, v in limits.items() if k != "moment_rate_cost_s3_per_m2"}
        return {**data, "limits": rest, "objective": objective}

    @model_validator(mode="before")
    @classmethod
    def _body_of_person(cls, data: Any) -> Any:
        """A person becomes the body, except for what is given of that; the body alone is kept."""
        if not isinstance(data, dict) or not isinstance(data.get("person"), dict | Person):
            return data
        person, given = data["person"], data.get("body", {})
        if isinstance(given, Body):
            raise BodyError("is given twice", "give either person or body", field="person")
        if isinstance(person, dict):
            try:
                person = Person(**person)
            except BodyError as error:
                error.field = ".".join(["person", *([error.field] if error.field else [])])
                raise
        body = {**person.parameters(), **given} if isinstance(given, dict) else given
        return {**data, "person": None, "body": body}

    @model_validator(mode="after")
    def _mirrored_legs_are_equal(self) -> Self:
        if self.stride.legs == "mirrored" and self.legs_differ:
            raise invalid(
                "stride.legs",
                "mirrored",
                "the legs differ, so one cannot mirror the other",
                "leave it out, or give both legs the same parameters, bounds and devices",
            )
        return self

    @model_validator(mode="after")
    def _step_reachable(self) -> Self:
        longest = min(
            _longest_step(self.body.leg(behind), self.body.leg(1 - behind)) for behind in (0, 1)
        )
        if self.step_length_m >= longest:
            raise invalid(
                "step_length_m",
                self.step_length_m,
                f"out of reach: these legs span at most {longest:.2f} m between heel contacts",
                "shorten the step or lengthen the legs",
            )
        return self

    @model_validator(mode="after")
    def _design_can_be(self) -> Self:
        check_design(self)
        return self


LEG_SPECIFIC = ("limits", "rhythm", "corridors", "devices")
"""Tables that may say something of one leg alone."""


def _longest_step(behind: LegParameters, ahead: LegParameters) -> float:
    """Longest step [m] with stretched legs.

    In double support the trailing toe tip and the leading heel are L - (l_h + l_m) apart, and each
    is at most the stretched leg away from the hip, which is above the ground.
    """
    foot = behind.heel_to_metatarsal + behind.toe_length
    trailing = behind.thigh_length + behind.shank_length
    trailing += behind.ankle_to_metatarsal + behind.toe_length
    leading = ahead.thigh_length + ahead.shank_length + ahead.heel_to_ankle
    return trailing + leading + foot
