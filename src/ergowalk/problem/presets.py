"""Named problems: the paper's case in three readings, and Winter's three cadences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM
from ergowalk.problem.devices import Device, Devices
from ergowalk.problem.gait_problem import Corridors, GaitProblem, RhythmBounds
from ergowalk.problem.limits import JointBounds, Limits

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
