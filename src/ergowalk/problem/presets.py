"""Named problems: the paper's case in three readings, and Winter's three cadences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ergowalk.body import Body
from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM
from ergowalk.problem.corridors import Corridors, LegCorridors
from ergowalk.problem.devices import Device, Devices, LegDevices
from ergowalk.problem.gait_problem import GaitProblem
from ergowalk.problem.limits import JointBounds, LegJointBounds, LegLimits, Limits
from ergowalk.problem.rhythm import RhythmBounds

DEFAULT_PRESET = "berbyuk2002"

_NO_LIMITS = Limits(
    vertical_reaction_body_weights="off",
    friction_coefficient="off",
    moment_rate_nm_per_kg_s=JointBounds(),
)

_PRINTED_RHYTHM = RhythmBounds(
    heel_end=PRINTED_RHYTHM.heel_end,
    heel_off=PRINTED_RHYTHM.heel_off,
    toe_off=PRINTED_RHYTHM.toe_off,
)


_ANKLE_EXOSKELETON = Devices(
    ankle=Device(kind="spring", stiffness_nm_per_rad=180.0, stiffness_below_nm_per_rad=0.0)
)
"""Collins, Wiggin and Sawicki, Nature 522 (2015), found least metabolic cost at 180 N m/rad. Their
clutch is replaced by a spring that is slack below the neutral ankle."""

_HIP_EXOSUIT = Devices(hip=Device(kind="spring", stiffness_below_nm_per_rad=50.0))


_PROSTHETIC_FOOT = Device(
    kind="parallel",
    own_moment=False,
    stiffness_nm_per_rad=300.0,
    damping_nms_per_rad=5.0,
)
"""An elastic ankle: 300 N m/rad (5.2 N m a degree) as a human ankle in stance, a damping that
brings the foot back to neutral in 0.02 s; both assumed."""

_BELOW_KNEE = Body(
    shank_mass_kg=(3.51, 2.2), shank_inertia_kgm2=(0.16, 0.102), foot_mass_kg=(1.24, 0.6)
)
"""Shank and foot of leg 2 are 1.95 kg lighter: the difference often reported for people with one
transtibial amputation (Smith & Martin, J. Prosthet. Orthot. 23, 2011). How that divides between
stump, socket and foot, and a shank of the same shape, are assumed."""

_ABOVE_KNEE = Body(
    thigh_mass_kg=(8.49, 7.0),
    thigh_inertia_kgm2=(0.57, 0.47),
    shank_mass_kg=(3.51, 2.5),
    shank_inertia_kgm2=(0.16, 0.116),
    foot_mass_kg=(1.24, 0.6),
)
"""Thigh of leg 2 1.49 kg, shank and foot 1.65 kg lighter, shapes the same; assumed."""

_KNEE_UNIT = Device(
    kind="damper",
    own_moment=False,
    damping_nms_per_rad=200.0,
    active=("heel", "flat", "forefoot"),
)
"""A knee that yields slowly in stance and is free from the other heel's contact on; assumed."""

_LATCHED_FOOT = Device(
    kind="spring",
    own_moment=False,
    stiffness_nm_per_rad=300.0,
    active=("heel", "flat", "forefoot", "toe"),
)
"""The same ankle without damping; a latch lets the foot go in swing, or no gait is found."""

_ORTHOSIS = Device(kind="spring", stiffness_nm_per_rad=150.0, stiffness_below_nm_per_rad="same")
"""A leaf of 150 N m/rad (2.6 N m a degree); assumed."""


@dataclass(frozen=True)
class Preset:
    """A named problem with one line about it."""

    name: str
    summary: str
    build: Callable[[], GaitProblem]


def preset(name: str) -> GaitProblem:
    """The problem of a preset.

    Raises
    ------
    ProblemError
        If there is no preset of that name.
    """
    if name not in PRESETS:
        raise ProblemError(
            "no such preset", f"choose one of {', '.join(PRESETS)}", field="preset", value=name
        )
    return PRESETS[name].build()


def _paper(
    name: str,
    rhythm: RhythmBounds = RhythmBounds(),  # noqa: B008 - a frozen value
    limits: Limits = Limits(),  # noqa: B008
    devices: Devices = Devices(),  # noqa: B008
) -> GaitProblem:
    return GaitProblem(
        name=name,
        step_length_m=0.76,
        stride_time_s=1.14,
        rhythm=rhythm,
        limits=limits,
        devices=devices,
    )


def _one_leg(
    name: str,
    body: Body = Body(),  # noqa: B008 - a frozen value
    devices: LegDevices | None = None,
    limits: LegLimits | None = None,
    corridors: LegCorridors | None = None,
) -> GaitProblem:
    """The paper's case with what belongs to leg 2 alone; its ankle has no corridor."""
    return GaitProblem(
        name=name,
        step_length_m=0.76,
        stride_time_s=1.14,
        body=body,
        limits=Limits(leg_2=limits),
        corridors=Corridors(leg_2=corridors or LegCorridors(ankle_width_sd="off")),
        devices=Devices(leg_2=devices),
    )


def _winter(cadence: str, step_length: float, stride_time: float) -> GaitProblem:
    return GaitProblem(
        name=f"winter-{cadence}",
        step_length_m=step_length,
        stride_time_s=stride_time,
        corridors=Corridors(source=f"winter-{cadence}"),
    )


PRESETS = {
    p.name: p
    for p in (
        Preset(
            "berbyuk2002",
            "the paper's case: L = 0.76 m, T = 1.14 s, Winter natural +- 1 SD, free rhythm, "
            "default limits",
            lambda: _paper("berbyuk2002"),
        ),
        Preset(
            "berbyuk2002-rhythm",
            "the same with the rhythm fixed to the printed values",
            lambda: _paper("berbyuk2002-rhythm", rhythm=_PRINTED_RHYTHM),
        ),
        Preset(
            "berbyuk2002-printed",
            "Problem A as printed, no limits: has no smooth minimiser, and the status says so",
            lambda: _paper("berbyuk2002-printed", limits=_NO_LIMITS),
        ),
        Preset(
            "ankle-exoskeleton",
            "berbyuk2002 with an elastic ankle exoskeleton: 180 N m/rad in dorsiflexion, slack in "
            "plantarflexion, no mass (stiffness: Collins et al. 2015)",
            lambda: _paper("ankle-exoskeleton", devices=_ANKLE_EXOSKELETON),
        ),
        Preset(
            "hip-exosuit",
            "berbyuk2002 with an elastic hip exosuit: 50 N m/rad in extension, slack in flexion, "
            "no mass (stiffness assumed)",
            lambda: _paper("hip-exosuit", devices=_HIP_EXOSUIT),
        ),
        Preset(
            "below-knee-prosthesis",
            "berbyuk2002 with an elastic ankle of 300 N m/rad in place of leg 2's own moment, "
            "shank and foot 1.95 kg lighter (mass: Smith & Martin 2011; the rest assumed)",
            lambda: _one_leg(
                "below-knee-prosthesis",
                body=_BELOW_KNEE,
                devices=LegDevices(ankle=_PROSTHETIC_FOOT),
            ),
        ),
        Preset(
            "above-knee-prosthesis",
            "berbyuk2002 with a knee of leg 2 that a damper of 200 N m s/rad holds in stance and "
            "that is free from then on, an elastic ankle that is free in swing, thigh, shank and "
            "foot 3.14 kg lighter, corridors of leg 2 of 3 and 4 SD (all assumed)",
            lambda: _one_leg(
                "above-knee-prosthesis",
                body=_ABOVE_KNEE,
                devices=LegDevices(knee=_KNEE_UNIT, ankle=_LATCHED_FOOT),
                corridors=LegCorridors(width_sd=3.0, knee_width_sd=4.0, ankle_width_sd="off"),
            ),
        ),
        Preset(
            "ankle-foot-orthosis",
            "berbyuk2002 with a weak ankle of leg 2, at most 0.7 N m/kg, beside a leaf of 150 N "
            "m/rad (both assumed)",
            lambda: _one_leg(
                "ankle-foot-orthosis",
                devices=LegDevices(ankle=_ORTHOSIS),
                limits=LegLimits(moment_nm_per_kg=LegJointBounds(ankle=0.7)),
            ),
        ),
        Preset(
            "winter-slow",
            "Winter's slow cadence: L = 0.69 m, T = 1.40 s (time estimated from the tables, "
            "length recalled, unverified)",
            lambda: _winter("slow", 0.69, 1.40),
        ),
        Preset(
            "winter-natural",
            "Winter's natural cadence: L = 0.755 m, T = 1.1396 s",
            lambda: _winter("natural", 0.755, 1.1396),
        ),
        Preset(
            "winter-fast",
            "Winter's fast cadence: L = 0.82 m, T = 0.97 s (time estimated from the tables, "
            "length recalled, unverified)",
            lambda: _winter("fast", 0.82, 0.97),
        ),
    )
}
"""All presets by name."""
