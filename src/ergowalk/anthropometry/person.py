"""A person by height and mass: what a tape and a scale tell, and the body that follows.

Lengths are fractions of height after Drillis and Contini unless they are measured; masses, centres
of mass and inertias follow from the segments of a table. Head, arms and trunk become the model's
trunk. A foot has no inertia there: its mass goes to the ankle.
"""

from __future__ import annotations

import math
from typing import Literal, Self

from pydantic import Field, model_validator

from ergowalk.anthropometry.lumping import upper_body
from ergowalk.anthropometry.tables import length_fractions, segments
from ergowalk.errors import BodyError
from ergowalk.values import PositiveFloat, Value, invalid

HEIGHTS, MASSES = (1.0, 2.5), (20.0, 300.0)
"""Ranges of body height [m] and mass [kg]: the tables are of adults."""

ON_SOLE = {"ankle_ahead_of_heel": 0.25, "heel_to_ball": 0.70}
"""Where the ankle and the metatarsal joint lie over the sole, as parts of the foot's length from
the heel. No table of the package has them: they are rounded values. The ball of the foot is
measured to the first metatarsal joint, at 0.74 of the foot's length in adults; the fifth lies
further back, and the model's one joint stands for all."""

OFF_BY, TRUNK_OFF_BY = 1.6, 1.3
"""A measured length is this many times the tabulated one at most, or this part of it at least:
beyond that the unit is wrong. The trunk leaves room for the head."""

DIGITS = 6
"""Significant digits of what follows: far more than the tables know, and short to write."""

Measured = PositiveFloat | None


class Person(Value):
    """Height, mass and what else is measured of a person, in SI units.

    Raises
    ------
    BodyError
        For a height, mass or length that no adult has, or that contradicts the others.
    """

    _error = BodyError

    height_m: PositiveFloat = Field(description="body height in m")
    mass_kg: PositiveFloat = Field(description="body mass in kg")
    sex: Literal["male", "female"] | None = Field(
        default=None,
        description="'male' or 'female': which of de Leva's tables; 'male' unless said",
    )
    table: Literal["dempster", "deleva"] | None = Field(
        default=None,
        description="'dempster' (knows no sexes) or 'deleva'; unless said, 'deleva' where a sex "
        "is given and 'dempster' where not",
    )
    thigh_length_m: Measured = Field(
        default=None, description="measured hip to knee, instead of 0.245 of height, in m"
    )
    shank_length_m: Measured = Field(
        default=None, description="measured knee to ankle, instead of 0.246 of height, in m"
    )
    ankle_height_m: Measured = Field(
        default=None, description="measured height of the ankle, instead of 0.039 of height, in m"
    )
    foot_length_m: Measured = Field(
        default=None, description="measured heel to toe tip, instead of 0.152 of height, in m"
    )
    hip_to_shoulder_m: Measured = Field(
        default=None, description="measured hip to shoulder, instead of 0.288 of height, in m"
    )
    heel_to_ball_m: Measured = Field(
        default=None,
        description="measured heel to metatarsal joint along the sole, instead of 0.70 of the "
        "foot's length, in m",
    )
    ankle_ahead_of_heel_m: Measured = Field(
        default=None,
        description="measured heel to the place under the ankle along the sole, instead of 0.25 "
        "of the foot's length, in m",
    )

    def length(self, name: str) -> float:
        """A length [m]: measured, or a fraction of body height by its name in the table.

        ``body_height`` is the height itself, ``hip_height`` that of the fractions.
        """
        measured: float | None = getattr(self, MEASURED[name]) if name in MEASURED else None
        if measured is not None:
            return measured
        if name in ON_SOLE:
            return ON_SOLE[name] * self.length("foot_length")
        fraction = 1.0 if name == "body_height" else length_fractions()[name]
        return fraction * self.height_m

    @property
    def leg_length_m(self) -> float:
        """Height of the hip over the ground, standing [m]."""
        return sum(map(self.length, ("thigh_hip_to_knee", "shank_knee_to_ankle", "ankle_height")))

    @property
    def words(self) -> str:
        """The person in words, for a comment."""
        measured = [
            f"{field} {value:g}" for field in MEASURED.values() if (value := self._of(field))
        ]
        table = {"dempster": "Dempster's", "deleva": f"de Leva's {self._sex}"}[self._table]
        told = f"; measured: {', '.join(measured)}" if measured else ""
        return f"{self.height_m:g} m, {self.mass_kg:g} kg, {table} table{told}"

    def parameters(self) -> dict[str, float]:
        """Fields of :class:`ergowalk.body.Body` in SI units, the same for both legs.

        The trunk's mass is what the legs leave of the body's, so that nothing is lost where the
        fractions of a table do not add up to one exactly. Inertias are about the proximal joint.
        """
        rows = segments(self._table, self._sex)
        shank_row = rows["leg" if self._table == "dempster" else "shank"]
        upper = upper_body(self._table, rows, self.length)
        upper_mass = sum(part.mass for part in upper)
        whole = upper_mass + 2 * (rows["thigh"].mass + shank_row.mass + rows["foot"].mass)
        found = {"foot_mass_kg": rows["foot"].mass / whole * self.mass_kg}
        for name, row, length in (
            ("thigh", rows["thigh"], self.length("thigh_hip_to_knee")),
            ("shank", shank_row, self.length("shank_knee_to_ankle")),
        ):
            mass = row.mass / whole * self.mass_kg
            found[f"{name}_mass_kg"] = mass
            found[f"{name}_length_m"] = length
            found[f"{name}_com_m"] = row.com * length
            found[f"{name}_inertia_kgm2"] = mass * (row.com**2 + row.gyration**2) * length**2
        found = {name: _short(value) for name, value in (found | self._foot()).items()}
        legs = 2 * sum(found[f"{name}_mass_kg"] for name in ("thigh", "shank", "foot"))
        trunk_mass = round(self.mass_kg - legs, 9)
        com = sum(part.mass * part.height for part in upper) / upper_mass
        square = sum(part.mass * (part.height**2 + part.gyration**2) for part in upper) / upper_mass
        return {
            "trunk_mass_kg": trunk_mass,
            "trunk_com_m": _short(com),
            "trunk_inertia_kgm2": _short(trunk_mass * square),
            **found,
        }

    def _foot(self) -> dict[str, float]:
        """The foot triangle: the ankle stands over the sole, between heel and ball."""
        height, place = self.length("ankle_height"), self.length("ankle_ahead_of_heel")
        ball = self.length("heel_to_ball")
        return {
            "heel_to_ankle_m": math.hypot(place, height),
            "ankle_to_metatarsal_m": math.hypot(ball - place, height),
            "heel_to_metatarsal_m": ball,
            "toe_length_m": self.length("foot_length") - ball,
        }

    @property
    def _table(self) -> str:
        return self.table or ("deleva" if self.sex else "dempster")

    @property
    def _sex(self) -> str:
        return self.sex or "male"

    def _of(self, field: str) -> float | None:
        value: float | None = getattr(self, field)
        return value

    @model_validator(mode="after")
    def _can_exist(self) -> Self:
        for field, (low, high) in (("height_m", HEIGHTS), ("mass_kg", MASSES)):
            if not low <= getattr(self, field) <= high:
                raise invalid(
                    field,
                    getattr(self, field),
                    f"must lie between {low:g} and {high:g}",
                    f"give it in {field.rsplit('_', 1)[1]}: the tables are of adults",
                )
        usual = Person.model_construct(height_m=self.height_m, mass_kg=self.mass_kg)
        for name, field in MEASURED.items():
            value, expected = self._of(field), usual.length(name)
            factor = TRUNK_OFF_BY if name == "hip_to_shoulder" else OFF_BY
            if value is not None and not expected / factor <= value <= expected * factor:
                raise invalid(
                    field,
                    value,
                    f"is far from the {expected:.3f} m that a person of {self.height_m:g} m has",
                    f"give m, between {expected / factor:.3f} and {expected * factor:.3f}",
                )
        self._check_foot()
        return self

    def _check_foot(self) -> None:
        ankle, ball, foot = map(self.length, ("ankle_ahead_of_heel", "heel_to_ball", "foot_length"))
        if not ankle < ball < foot:
            raise invalid(
                "heel_to_ball_m",
                round(ball, 4),
                f"must lie between the ankle at {ankle:.3f} m and the toe tip at {foot:.3f} m from "
                "the heel",
                "give ankle_ahead_of_heel_m, heel_to_ball_m and foot_length_m of one foot",
            )


MEASURED = {
    "thigh_hip_to_knee": "thigh_length_m",
    "shank_knee_to_ankle": "shank_length_m",
    "ankle_height": "ankle_height_m",
    "foot_length": "foot_length_m",
    "hip_to_shoulder": "hip_to_shoulder_m",
    "heel_to_ball": "heel_to_ball_m",
    "ankle_ahead_of_heel": "ankle_ahead_of_heel_m",
}
"""The field with the measured value of each length."""


def _short(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
