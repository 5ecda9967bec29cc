"""What the viewer is given: one stride of a gait in even frames, as plain values."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.comparison import body_of, contact_phases, curve, stride_curves, stride_fraction
from ergowalk.corridors import HumanGait
from ergowalk.mechanics.kinematics import LegMotion, Point, Rotation, leg_points
from ergowalk.quantities import JOINTS, LEGS, SEGMENTS, TRUNK_DRAWN

Array = NDArray[np.float64]

INTERVALS = 300
"""Intervals between the frames of a stride: at a usual stride time more than the 60 a second that
a screen shows. Even, so that half a stride is a frame."""

POINTS = ("knee", "ankle", "heel", "metatarsal", "toe_tip")
"""The points of a leg below the hip, as :class:`ergowalk.mechanics.kinematics.LegPoints` has
them."""

ANGLE, MOMENT, POWER, REACTION = "°", "N m/kg", "W/kg", "body weights"
"""Units of the curves."""

_KINDS = {
    "angle": (
        ANGLE,
        {"hip": "flexion", "knee": "flexion", "ankle": "dorsiflexion", "metatarsal": "toes up"},
    ),
    "moment": (
        MOMENT,
        {"hip": "flexion", "knee": "extension", "ankle": "dorsiflexion", "metatarsal": "toes up"},
    ),
    "power": (POWER, dict.fromkeys(JOINTS, "into the walker")),
}
"""Unit of each kind of joint curve, and by joint what its positive sign means."""

_REACTIONS = {
    "reaction_x": ("horizontal reaction", "forward"),
    "reaction_y": ("vertical reaction", "up"),
}


def gait_payload(dataset: xr.Dataset, human: HumanGait, label: str) -> dict[str, Any]:
    """A gait as plain values that ``json.dumps`` takes; None stands for NaN.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.
    human : HumanGait
        Human mean and SD; :func:`ergowalk.comparison.human_of` gives those of the gait's problem.
    label : str
        What the gait is called in the legend.

    Returns
    -------
    dict
        Positions [m], reactions [body weights] and powers [W/kg] at stride fractions
        0, 1/300, ..., 1, the contact phases of both legs in stride fractions, and the curves of
        leg 1. At an instant that stands twice the later of both limits counts.

    Raises
    ------
    GaitFileError
        If a variable or an attribute is missing or not usable.
    """
    body, frames = body_of(dataset), Frames(dataset)
    hip = np.stack([frames.at("hip_position", axis=axis) for axis in "xy"], axis=1)
    lean = frames.at("trunk_angle")
    up = np.stack([-np.sin(lean), np.cos(lean)], axis=1)
    return {
        "label": label,
        "acceptable": bool(dataset.attrs.get("acceptable") == 1),
        "limits": str(dataset.attrs.get("limits", "")),
        "stride_time": float(dataset["time"][-1]),
        "stride_length": round(float(hip[-1, 0] - hip[0, 0]), 4),
        "human": human.name,
        "hip": rounded(hip),
        "trunk_top": rounded(hip + TRUNK_DRAWN * body.trunk_com_m * up),
        "legs": [_leg(dataset, frames, body, hip, leg) for leg in LEGS],
        "curves": _curves(dataset, frames, body, human),
    }


class Frames:
    """Even samples of the variables of a gait over the stride.

    ``fraction`` are the stride fractions (n,) of the frames.

    Raises
    ------
    GaitFileError
        If the times do not run forward from 0.
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self.fraction = np.linspace(0.0, 1.0, INTERVALS + 1)
        self._dataset = dataset
        self._own = stride_fraction(dataset)
        # an interval of no length, where an instant stands twice, holds no frame
        ends = np.flatnonzero(np.diff(self._own) > 0)
        after = np.searchsorted(self._own[ends], self.fraction, side="right") - 1
        self._left = ends[after]
        width = self._own[self._left + 1] - self._own[self._left]
        self._share = (self.fraction - self._own[self._left]) / width

    def at(self, variable: str, gaps: bool = False, **labels: int | str) -> Array:
        """A variable of the file (n,) at coordinate ``labels``, linearly between its samples.

        Raises
        ------
        GaitFileError
            If it is missing or, unless it may have ``gaps``, not finite everywhere.
        """
        return self.of(curve(self._dataset, variable, labels, gaps))

    def of(self, samples: Array) -> Array:
        """Samples at the instants of the file, at the frames instead (n,)."""
        left, right = samples[self._left], samples[self._left + 1]
        mixed: Array = left + self._share * (right - left)
        return mixed


def _leg(dataset: xr.Dataset, frames: Frames, body: Body, hip: Array, leg: int) -> dict[str, Any]:
    """Points, reaction, pressure and joint powers of leg 1 or 2 at the frames."""
    angles = (Rotation(frames.at("segment_angle", leg=leg, segment=s)) for s in SEGMENTS)
    points = leg_points(body.leg(leg - 1), LegMotion(*angles), Point((hip[:, 0], hip[:, 1])))
    weight = body.total_mass * body.gravity_m_s2
    force = [frames.at("ground_reaction_force", leg=leg, axis=axis) / weight for axis in "xy"]
    power = [frames.at("joint_power", leg=leg, joint=j) / body.total_mass for j in JOINTS]
    return {
        **{p: rounded(np.stack(getattr(points, p).position, axis=1)) for p in POINTS},
        "reaction": rounded(np.stack(force, axis=1)),
        "pressure": rounded(frames.at("center_of_pressure", gaps=True, leg=leg)),
        "power": rounded(np.stack(power, axis=1)),
        "phases": [asdict(span) for span in contact_phases(dataset, leg)],
    }


def _curves(
    dataset: xr.Dataset, frames: Frames, body: Body, human: HumanGait
) -> list[dict[str, Any]]:
    """The curves of leg 1, by kind and joint, then the reactions."""
    known, mass = stride_curves(dataset).values, body.total_mass
    found = []
    for kind, (unit, signs) in _KINDS.items():
        for joint in JOINTS:
            name = f"{joint}_{kind}"
            if name in known:
                values = frames.of(known[name])
            else:
                raw = frames.at(f"joint_{kind}", leg=1, joint=joint)
                values = np.degrees(raw) if kind == "angle" else raw / mass
            place = "toes" if joint == "metatarsal" else joint
            found.append(_curve(name, f"{place} {kind}", unit, signs[joint], values, human))
    for name, (title, sign) in _REACTIONS.items():
        values, g = frames.of(known[name]), body.gravity_m_s2
        found.append(_curve(name, title, REACTION, sign, values / g, human, g))
    return found


def _curve(
    name: str,
    title: str,
    unit: str,
    positive: str,
    values: Array,
    human: HumanGait,
    human_unit: float = 1.0,
) -> dict[str, Any]:
    """One curve at the frames (n,); the human mean and SD divided by ``human_unit``."""
    band: dict[str, Any] = {}
    if name in human.curves:
        mean, sd = (c(np.linspace(0.0, 1.0, len(values))) for c in human.curves[name])
        band = {
            "mean": rounded(mean / human_unit),
            "sd": rounded(np.maximum(sd, 0.0) / human_unit),
        }
    values = rounded(values)
    return {"name": name, "title": title, "unit": unit, "positive": positive, "values": values} | (
        {"human": band} if band else {}
    )


def rounded(values: Array) -> Any:
    """Nested lists of four decimals (a tenth of a millimetre); None where it is not a number."""
    finite = np.isfinite(values)
    found = (np.round(values, 4) + 0.0).astype(object)
    found[~finite] = None
    return found.tolist()
