"""The human mean angles as a walker to look at: a drawing, no solution of the mechanics."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body, LegParameters
from ergowalk.comparison import body_of, stride_fraction
from ergowalk.corridors import ANGLES, HumanGait
from ergowalk.mechanics.kinematics import (
    HALF_PI,
    LegMotion,
    LegPoints,
    Point,
    Rotation,
    leg_points,
    sole,
)
from ergowalk.quantities import JOINTS, TRUNK_DRAWN
from ergowalk.viewer.payload import INTERVALS, POINTS, rounded

Array = NDArray[np.float64]

_FINE = 12
"""Steps between two frames of the viewer in which the hip path is summed up."""


def human_payload(dataset: xr.Dataset, human: HumanGait) -> dict[str, Any]:
    """The walker of the human mean angles on the body of a gait, as :func:`gait_payload` has it.

    Both legs have the mean hip, knee and ankle angles, half a stride apart, under an upright
    trunk. The lowest of heels and metatarsal joints stands on the ground and does not slide:
    that gives the path of the hip, and with it the stride length. Toes are in line with the sole
    and give way to the ground. Powers are the mean ones; where a force would act is not known,
    so none is shown, and there are neither phases nor curves, which the viewer has as the band.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``, for its body and its stride time.
    human : HumanGait
        Human means with the three joint angles.

    Raises
    ------
    GaitFileError
        If the body is missing or not usable, or the times do not run forward from 0.
    """
    stride_fraction(dataset)
    body = body_of(dataset)
    legs = (0, 1)
    fine = np.linspace(0.0, 1.0, _FINE * INTERVALS + 1)
    hip = _hip_path([_motion(body.leg(i), human, fine + i / 2) for i in legs], body)[::_FINE]
    s = fine[::_FINE]
    top = hip + np.array([0.0, TRUNK_DRAWN * body.trunk_com_m])
    length = float(hip[-1, 0] - hip[0, 0])
    return {
        "kind": "human",
        "label": f"human mean angles ({human.name}) on this body, drawn without forces, "
        f"stride {length:.2f} m",
        "acceptable": True,
        "limits": "",
        "stride_time": float(dataset["time"][-1]),
        "stride_length": round(length, 4),
        "human": human.name,
        "hip": rounded(hip),
        "trunk_top": rounded(top),
        "legs": [_leg(body, human, s + i / 2, hip, i) for i in legs],
        "curves": [],
    }


def _motion(leg: LegParameters, human: HumanGait, s: Array) -> LegMotion:
    """Segment angles of the mean joint angles under an upright trunk, toes in line."""
    hip, knee, ankle = (np.radians(human.curves[f"{joint}_angle"][0](s)) for joint in ANGLES)
    shank = hip - knee
    foot = shank + ankle + HALF_PI - leg.foot_angle
    return LegMotion(*(Rotation(a) for a in (hip, shank, foot, foot + leg.foot_angle)))


def _hip_path(motions: list[LegMotion], body: Body) -> Array:
    """Hip points (n, 2) over which the lowest point of heels and metatarsal joints rests."""
    nowhere = Point((0.0, 0.0))
    feet = np.array(
        [
            np.stack(point.position, axis=1)
            for i, motion in enumerate(motions)
            for points in [leg_points(body.leg(i), motion, nowhere)]
            for point in (points.heel, points.metatarsal)
        ]
    )
    lowest = feet[:, :, 1].argmin(axis=0)
    step = np.arange(feet.shape[1] - 1)
    forward = feet[lowest[:-1], step, 0] - feet[lowest[:-1], step + 1, 0]
    x = np.concatenate([[0.0], np.cumsum(forward)])
    return np.stack([x, -feet[:, :, 1].min(axis=0)], axis=1)


def _leg(body: Body, human: HumanGait, s: Array, hip: Array, i: int) -> dict[str, Any]:
    """Points and joint powers of leg 1 or 2 at its own stride fractions s (n,)."""
    leg, motion = body.leg(i), _motion(body.leg(i), human, s)
    points = _on_the_ground(leg, motion, Point((hip[:, 0], hip[:, 1])))
    known = (human.curves.get(f"{joint}_power") for joint in JOINTS)
    power = [np.full_like(s, np.nan) if curves is None else curves[0](s) for curves in known]
    return {
        **{p: rounded(np.stack(getattr(points, p).position, axis=1)) for p in POINTS},
        "reaction": [[0.0, 0.0]] * len(s),
        "pressure": [None] * len(s),
        "power": rounded(np.stack(power, axis=1)),
        "phases": [],
    }


def _on_the_ground(leg: LegParameters, motion: LegMotion, hip: Point) -> LegPoints:
    """Points of a leg whose toes bend up as far as the ground asks."""
    height = leg_points(leg, motion, hip).metatarsal.position[1]
    resting = np.arccos(np.clip(height / leg.toe_length, 0.0, 1.0))
    straight = sole(leg, motion.foot).angle
    toes = np.where((straight < resting) & (height < leg.toe_length), resting, straight)
    return leg_points(leg, LegMotion(motion.thigh, motion.shank, motion.foot, Rotation(toes)), hip)
