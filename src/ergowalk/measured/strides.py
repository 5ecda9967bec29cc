"""Strides of a measured leg: cut from heel contact to heel contact and laid on one grid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ergowalk.measured.dynamics import JointLoads
from ergowalk.measured.events import Events
from ergowalk.measured.kinematics import LegAngles
from ergowalk.measured.loads import FootLoad, pressure
from ergowalk.measured.trial import Trial

Array = NDArray[np.float64]

POINTS = 101
"""Points of a stride, one for each percent."""

DENSE = 2001
"""Points of a stride over which work is summed."""

SHORTEST, LONGEST = 0.4, 3.0
"""Range of the time of a stride [s]."""

FLAT_WITHIN = np.radians(5.0)
"""A foot whose sole is inclined by less than this lies flat."""

JOINTS = ("hip", "knee", "ankle", "metatarsal")


@dataclass(frozen=True)
class LegRecord:
    """All that is known of a leg over a trial: arrays over its frames."""

    side: str
    events: Events
    angles: LegAngles
    load: FootLoad
    loads: JointLoads


@dataclass(frozen=True)
class Stride:
    """One stride of a leg from ``start`` to ``end`` [s], which leads ``length`` [m] forward.

    ``rhythm``: end of rotation over the heel, heel-off and toe-off as fractions of its time.
    ``curves`` (101,) by name: angles of joints and segments [rad], and, if a plate has seen the
    whole stance (``kinetic``), moments [N m], powers [W], reactions [N] and the distance of the
    centre of pressure ahead of the heel contact's hip [m]. ``work`` is the time integral of the
    absolute powers [J] by joint.
    """

    side: str
    start: float
    end: float
    length: float
    rhythm: tuple[float, float, float]
    curves: Mapping[str, Array]
    work: Mapping[str, float]
    kinetic: bool

    @property
    def duration(self) -> float:
        """Stride time [s]."""
        return self.end - self.start


def strides_of(trial: Trial, leg: LegRecord, belt: float) -> list[Stride]:
    """The strides of a leg that the trial holds whole, with one toe-off each."""
    contacts = leg.events.contacts
    found = []
    for start, end in pairwise(contacts):
        toe_off = leg.events.toe_off_in(start, end)
        inside = trial.time[0] <= start and end <= trial.time[-1]
        if inside and toe_off is not None and SHORTEST <= end - start <= LONGEST:
            found.append(_stride(trial, leg, belt, start, end, toe_off))
    return found


def _stride(
    trial: Trial, leg: LegRecord, belt: float, start: float, end: float, toe_off: float
) -> Stride:
    kinetic = leg.load.covers(trial.time, start, toe_off)
    smooth = _smooth_curves(trial, leg, belt)
    grid = np.linspace(start, end, POINTS)
    curves = {name: CubicSpline(trial.time, values)(grid) for name, values in smooth.items()}
    origin = float(curves["hip_x"][0])
    curves["hip_x"] = curves["hip_x"] - origin
    work: dict[str, float] = {}
    if kinetic:
        rough = _rough_curves(trial, leg, belt)
        curves |= {name: np.interp(grid, trial.time, values) for name, values in rough.items()}
        curves["pressure"] = curves["pressure"] - origin
        dense = np.linspace(start, end, DENSE)
        for joint in JOINTS:
            power = np.abs(np.interp(dense, trial.time, rough[f"{joint}_power"]))
            work[joint] = float(np.trapezoid(power, dense))
    length = float(curves["hip_x"][-1])
    rhythm = _rhythm(curves["sole"], (toe_off - start) / (end - start))
    return Stride(leg.side, start, end, length, rhythm, curves, work, kinetic)


def _smooth_curves(trial: Trial, leg: LegRecord, belt: float) -> dict[str, Array]:
    angles, hips = leg.angles, trial.hips
    since = trial.time - trial.time[0]
    return {
        **{f"{joint}_angle": values for joint, values in angles.joints().items()},
        "thigh": angles.thigh,
        "shank": angles.shank,
        "sole": angles.sole,
        "toes": angles.toes,
        "trunk": angles.trunk,
        "hip_x": hips[:, 0] - belt * since,
        "hip_y": hips[:, 1],
    }


def _rough_curves(trial: Trial, leg: LegRecord, belt: float) -> dict[str, Array]:
    """What jumps at a contact, and is therefore only interpolated linearly."""
    rates = leg.angles.relative_rates(trial.rate)
    load = leg.load.load
    since = trial.time - trial.time[0]
    found = {"reaction_x": load[:, 0], "reaction_y": load[:, 1]}
    found["pressure"] = pressure(load) - belt * since
    for joint in JOINTS:
        found[f"{joint}_moment"] = leg.loads.moments[joint]
        found[f"{joint}_power"] = leg.loads.moments[joint] * rates[joint]
    return found


def _rhythm(sole: Array, toe_off: float) -> tuple[float, float, float]:
    """Foot-flat, heel-off, toe-off: the sole (101,) comes within, and leaves, five degrees."""
    fraction = np.linspace(0.0, 1.0, len(sole))
    pitch = sole - np.pi / 2  # toes up +
    stance = fraction <= toe_off
    middle = int(np.argmin(np.abs(fraction - 0.4 * toe_off)))
    steep = np.flatnonzero(stance & (pitch > FLAT_WITHIN) & (fraction < fraction[middle]))
    flat = fraction[steep[-1] + 1] if len(steep) else 0.0
    raised = np.flatnonzero(stance & (pitch < -FLAT_WITHIN) & (fraction > fraction[middle]))
    heel_off = fraction[raised[0]] if len(raised) else toe_off
    return float(flat), float(heel_off), float(toe_off)
