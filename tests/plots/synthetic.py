"""A gait file with known answers: the human mean curves carried by the paper's body.

Angles, reactions and moments of both legs are those of the human table (leg 2 half a stride
later); the trunk is upright, the hip advances evenly, and the lowest point of the feet touches
the ground. It obeys no law of motion: only its shape and its curves are meant.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.corridors import HumanGait, human_gait
from ergowalk.mechanics.kinematics import LegMotion, LegPoints, Point, Rotation, leg_points

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]

STEP_LENGTH, STRIDE_TIME = 0.76, 1.14
PHASE_ENDS = (0.10, 0.23, 0.50, 0.58, 1.0)
JOINTS = ("hip", "knee", "ankle", "metatarsal")
PROBLEM = (
    'name = "synthetic"\nstep_length_m = 0.76\nstride_time_s = 1.14\n'
    '[corridors]\nsource = "winter-natural"\nwidth_sd = 1.0\n'
)
BODY = Body()


def fractions(per_phase: int = 120) -> Array:
    """Stride fractions crowding towards the phase ends, each of which stands twice.

    Leg 2's phase ends are leg 1's half a stride later, so both legs' instants are on the grid.
    """
    ends = sorted({0.0, *PHASE_ENDS, *(round((e + 0.5) % 1.0, 9) for e in PHASE_ENDS)})
    shape = (1 - np.cos(np.linspace(0, np.pi, per_phase))) / 2
    pieces = [a + (b - a) * shape for a, b in pairwise(ends)]
    return np.concatenate(pieces)


def human_signals(human: HumanGait, sds: float = 0.0) -> dict[str, Curve]:
    """The human mean plus ``sds`` standard deviations, as functions of the stride fraction."""

    def shifted(name: str) -> Curve:
        mean, sd = human.curves[name]
        return lambda s: mean(s) + sds * sd(s)

    return {name: shifted(name) for name in human.curves}


def gait(
    signals: dict[str, Curve] | None = None,
    fraction: Array | None = None,
    source: str = "winter-natural",
) -> xr.Dataset:
    """A dataset in the format of gait.nc from ``signals``; the human mean if none are given."""
    signals = signals or human_signals(human_gait(source))
    s = fractions() if fraction is None else fraction
    own = [s, (s + 0.5) % 1.0]  # stride fraction as each leg counts it
    n = len(s)
    angle, moment = np.zeros((n, 2, 4)), np.zeros((n, 2, 4))
    force = np.zeros((n, 2, 2))
    for i, t in enumerate(own):
        for j, joint in enumerate(JOINTS[:3]):
            angle[:, i, j] = np.radians(signals[f"{joint}_angle"](t))
            moment[:, i, j] = BODY.total_mass * signals[f"{joint}_moment"](t)
        for k, axis in enumerate("xy"):
            force[:, i, k] = BODY.total_mass * signals[f"reaction_{axis}"](t)
    segment = np.stack([_segments(angle[:, i]) for i in (0, 1)], axis=1)
    hip, points = _place(s, segment)
    human = human_gait(source)
    under_ankle = np.stack([leg.ankle.position[0] for leg in points], axis=1)
    pressure = np.where(force[:, :, 1] > 1.0, under_ankle, np.nan)
    data = {
        "hip_position": (("time", "axis"), hip),
        "trunk_angle": (("time",), np.zeros(n)),
        "segment_angle": (("time", "leg", "segment"), segment),
        "joint_angle": (("time", "leg", "joint"), angle),
        "joint_moment": (("time", "leg", "joint"), moment),
        "ground_reaction_force": (("time", "leg", "axis"), force),
        "center_of_pressure": (("time", "leg"), pressure),
        "contact_phase": (
            ("time", "leg"),
            np.stack([_phases(s, 0.0), _phases(s, 0.5)], axis=1),
            {"flag_values": [0, 1, 2, 3, 4], "flag_meanings": "swing heel flat forefoot toe"},
        ),
        "corridor_lower": (("time", "leg", "joint"), _corridor(human, own, "lower")),
        "corridor_upper": (("time", "leg", "joint"), _corridor(human, own, "upper")),
    }
    return xr.Dataset(
        data,
        coords={
            "time": s * STRIDE_TIME,
            "leg": [1, 2],
            "axis": ["x", "y"],
            "segment": ["thigh", "shank", "foot", "toes"],
            "joint": list(JOINTS),
        },
        attrs={
            "energy_per_metre": 100.0,
            "step_length": STEP_LENGTH,
            "stride_time": STRIDE_TIME,
            "acceptable": 1,
            "limits": "R_y <= 1.3 body weights, |R_x| <= 0.6 R_y, moment rate <= 25 N m/(kg s) "
            "at hip, knee, ankle",
            "rhythm": json.dumps(
                {"heel_end": 0.1, "heel_off": 0.23, "toe_tip_start": 0.5, "toe_off": 0.58}
            ),
            "body_parameters": json.dumps(BODY.by_symbol()),
            "problem": PROBLEM.replace("winter-natural", source),
        },
    )


def _segments(angle: Array) -> Array:
    """Absolute segment angles (n, 4) of joint angles (n, 4) under an upright trunk."""
    phi = BODY.leg(0).foot_angle
    thigh = angle[:, 0]
    shank = thigh - angle[:, 1]
    foot = angle[:, 2] + shank - phi + np.pi / 2
    return np.stack([thigh, shank, foot, angle[:, 3] + foot + phi], axis=1)


def _place(s: Array, segment: Array) -> tuple[Array, list[LegPoints]]:
    """Hip path on which the lowest point of the feet touches the ground, and the legs' points."""

    def legs(hip: Point) -> list[LegPoints]:
        motions = [LegMotion(*(Rotation(segment[:, i, k]) for k in range(4))) for i in (0, 1)]
        return [leg_points(BODY.leg(i), motions[i], hip) for i in (0, 1)]

    x = 2 * STEP_LENGTH * s
    hanging = legs(Point((x, np.zeros_like(x))))
    low = [p.position[1] for leg in hanging for p in (leg.heel, leg.metatarsal, leg.toe_tip)]
    hip = np.stack([x - hanging[0].heel.position[0][0], -np.min(low, axis=0)], axis=1)
    return hip, legs(Point((hip[:, 0], hip[:, 1])))


def _corridor(human: HumanGait, own: list[Array], side: str) -> Array:
    bound = np.full((len(own[0]), 2, 4), np.nan)
    for i, t in enumerate(own):
        for j, joint in enumerate(JOINTS[:3]):
            bound[:, i, j] = getattr(human.angle_corridor(joint, 1.0), side)(t)
    return bound


def _phases(s: Array, shift: float) -> NDArray[np.int8]:
    """Contact of one leg; an instant that stands twice has the phase on each of its sides."""
    middle = (s + np.roll(s, -1)) / 2  # looks forward, except at the last sample of a piece
    middle[-1] = s[-1]
    step = np.diff(s, append=s[-1]) == 0
    middle[step] = (s[step] + np.roll(s, 1)[step]) / 2
    codes = np.array([1, 2, 3, 4, 0], dtype=np.int8)
    return codes[np.searchsorted(PHASE_ENDS[:-1], (middle + shift) % 1.0, side="right")]
