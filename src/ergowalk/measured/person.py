"""The body of a measured person: mass, measured lengths, fractions of a table."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.anthropometry import MASSES, length_fractions
from ergowalk.body import Body
from ergowalk.errors import InputError, RecordingError
from ergowalk.measured.choices import Choices
from ergowalk.measured.kinematics import FootShape
from ergowalk.measured.trial import Trial

Array = NDArray[np.float64]


TOES = 0.44
"""Metatarsals to toe tip over heel to metatarsals, where no marker shows it: as in the measured
subject of Winter (2009)."""


@dataclass(frozen=True)
class Lengths:
    """Measured lengths of a person [m], means of the legs; ``trunk`` hip to shoulder or None."""

    thigh: float
    shank: float
    foot: FootShape
    trunk: float | None

    @property
    def height(self) -> float:
        """Height of the body [m] by that of the hip."""
        return (self.thigh + self.shank + self.foot.ankle_height) / length_fractions()["hip_height"]


def measured_lengths(trial: Trial, feet: Sequence[FootShape]) -> Lengths:
    """Mean lengths of the segments over the trial."""

    def between(upper: str, lower: str) -> float:
        return float(
            np.mean(
                [
                    np.linalg.norm((leg[upper] - leg[lower])[:, :2], axis=1).mean()
                    for leg in trial.legs.values()
                ]
            )
        )

    trunk = None
    if trial.trunk is not None and trial.marker_set.shoulder:
        trunk = float(np.linalg.norm((trial.trunk - trial.hips)[:, :2], axis=1).mean())
    foot = FootShape(*(float(np.mean(v)) for v in zip(*map(_sizes, feet), strict=True)))
    return Lengths(between("hip", "knee"), between("knee", "ankle"), foot, trunk)


def _sizes(foot: FootShape) -> tuple[float, ...]:
    return foot.ankle_height, foot.ankle_ahead, foot.metatarsal_ahead, foot.toe_ahead


def person_body(mass: float, lengths: Lengths, choices: Choices) -> Body:
    """The walker with this mass and these lengths.

    Raises
    ------
    RecordingError
        If the mass or the foot is nobody's.
    """
    lightest, heaviest = MASSES
    if not lightest <= mass <= heaviest:
        raise RecordingError(
            f"must lie between {lightest:g} and {heaviest:g} kg",
            "give --mass in kg, or mend the forces",
            field="mass",
            value=round(mass, 2),
        )
    measured = {"thigh_length_m": lengths.thigh, "shank_length_m": lengths.shank}
    if lengths.trunk is not None:
        measured["hip_to_shoulder_m"] = lengths.trunk
    try:
        height = choices.height_m or lengths.height
        body = Body.from_height_mass(height, mass, choices.sex, None, **measured)
        return Body(**{**dict(body), **_foot(lengths.foot)})
    except InputError as error:
        raise RecordingError(
            f"the measured lengths make no body ({error})", "check the map of the markers"
        ) from None


def _foot(foot: FootShape) -> dict[str, float]:
    """The foot triangle, heel and metatarsals on the ground, and the toes."""
    toe = foot.toe_ahead - foot.metatarsal_ahead
    if not math.isfinite(toe):
        toe = TOES * foot.metatarsal_ahead
    sizes = {
        "heel_to_ankle_m": math.hypot(foot.ankle_ahead, foot.ankle_height),
        "ankle_to_metatarsal_m": math.hypot(
            foot.metatarsal_ahead - foot.ankle_ahead, foot.ankle_height
        ),
        "heel_to_metatarsal_m": foot.metatarsal_ahead,
        "toe_length_m": toe,
    }
    return {name: round(float(size), 4) for name, size in sizes.items()}


def carried_mass(load: Mapping[str, Array], time: Array, gravity: float) -> float:
    """Mass [kg] that the feet's vertical forces (n,) carry over a stride; one foot counts twice."""
    duration = float(time[-1] - time[0])
    impulse = sum(float(np.trapezoid(force, time)) for force in load.values())
    return 2 / len(load) * impulse / (gravity * duration)
