"""A gait at even instants, over one stride or several: what the exchange formats are made of."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.comparison import body_of, curve, stride_fraction
from ergowalk.errors import InputError
from ergowalk.mechanics.kinematics import LegMotion, LegPoints, Point, Rotation, leg_points
from ergowalk.quantities import LEGS, SEGMENTS

Array = NDArray[np.float64]

RATE, STRIDES = 200.0, 1
"""Default rate [Hz] and number of strides."""

HIGHEST_RATE, MOST_STRIDES = 20_000.0, 100
"""Beyond these a file is larger than any reader wants."""

SNAP = 1e-9
"""A stride fraction this near to a whole number is one: times k / rate are rounded."""


class Samples:
    """The curves of a gait at times k / rate over some strides.

    The stride is repeated, each time a stride length further on. At an instant that stands twice
    in the file the later limit counts.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.
    rate : float
        Samples per second.
    strides : int

    Raises
    ------
    GaitFileError
        If a variable or an attribute that is asked for is missing or not usable.
    InputError
        If rate or strides are out of range.
    """

    def __init__(self, dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> None:
        _check(rate, strides)
        self._dataset = dataset
        self._own = curve(dataset, "time")
        stride_fraction(dataset)  # runs from 0 and never back
        period = float(self._own[-1])
        lowest = 1 / (strides * period)
        if rate < lowest:
            raise InputError(
                f"must give two samples, that is at least {lowest:.3g} Hz",
                "raise it",
                field="rate",
                value=rate,
            )
        count = int(np.floor(strides * period * rate + SNAP))
        self.rate = rate
        self.time: Array = np.arange(count + 1) / rate
        self.body: Body = body_of(dataset)
        whole = np.floor(self.time / period + SNAP)
        within = np.maximum(self.time - whole * period, 0.0)
        within[within < SNAP * period] = 0.0
        self._advance = whole * self._stride_length()
        # an interval of no length, where an instant stands twice, holds no sample
        ends = np.flatnonzero(np.diff(self._own) > 0)
        after = np.searchsorted(self._own[ends], within, side="right") - 1
        self._left = ends[after]
        self._width = self._own[self._left + 1] - self._own[self._left]
        self._share = (within - self._own[self._left]) / self._width

    def smooth(self, variable: str, rate: str, **labels: int | str) -> Array:
        """A curve (n,) by cubics through its samples and their rates."""
        value, slope = (curve(self._dataset, name, labels) for name in (variable, rate))
        s, width, left = self._share, self._width, self._left
        start, end = value[left], value[left + 1]
        rise = end - start
        bend = width * slope[left] - rise
        swing = rise - width * slope[left + 1]
        return np.asarray(start + s * rise + s * (1 - s) * ((1 - s) * bend + s * swing))

    def linear(self, variable: str, gaps: bool = False, **labels: int | str) -> Array:
        """A curve (n,) by lines through its samples; a gap takes the value before it."""
        value = curve(self._dataset, variable, labels, gaps=gaps)
        if gaps:
            value = _held(value)
        left = self._left
        return np.asarray((1 - self._share) * value[left] + self._share * value[left + 1])

    def hip(self) -> Array:
        """Position of the hip (n, 2) [m]."""
        x, y = (self.smooth("hip_position", "hip_velocity", axis=axis) for axis in "xy")
        return np.stack([x + self._advance, y], axis=1)

    def trunk(self) -> Array:
        """Trunk angle psi (n,) [rad]."""
        return self.smooth("trunk_angle", "trunk_angular_velocity")

    def segment(self, leg: int, name: str) -> Array:
        """Absolute angle of a segment (n,) [rad]."""
        return self.smooth("segment_angle", "segment_angular_velocity", leg=leg, segment=name)

    def moment(self, leg: int, joint: str) -> Array:
        """Joint moment (n,) [N m], counter-clockwise on the distal segment."""
        return self.linear("joint_moment", leg=leg, joint=joint)

    def reaction(self, leg: int) -> Array:
        """Ground reaction (n, 2) [N]."""
        return np.stack([self.linear("ground_reaction_force", leg=leg, axis=a) for a in "xy"], 1)

    def pressure(self, leg: int) -> Array:
        """Centre of pressure (n,) [m]; while the foot is in the air, where it left the ground."""
        return self.linear("center_of_pressure", gaps=True, leg=leg) + self._advance

    def points(self, leg: int) -> LegPoints:
        """Positions of the points of a leg; their velocities are not sampled."""
        hip = self.hip()
        motion = LegMotion(*(Rotation(self.segment(leg, name)) for name in SEGMENTS))
        return leg_points(self.body.leg(LEGS.index(leg)), motion, Point((hip[:, 0], hip[:, 1])))

    def _stride_length(self) -> float:
        x = curve(self._dataset, "hip_position", {"axis": "x"})
        return float(x[-1] - x[0])


def _check(rate: float, strides: int) -> None:
    if not 0 < rate <= HIGHEST_RATE:
        raise InputError(
            f"must be positive and at most {HIGHEST_RATE:g} Hz",
            "give samples per second",
            field="rate",
            value=rate,
        )
    if not 1 <= strides <= MOST_STRIDES:
        raise InputError(
            f"must lie between 1 and {MOST_STRIDES}",
            "give a number of strides",
            field="strides",
            value=strides,
        )


def _held(value: Array) -> Array:
    """Values with each gap filled by the last value before it, the first gap by the next one."""
    known = np.flatnonzero(np.isfinite(value))
    if not len(known):
        return np.zeros_like(value)
    before = np.searchsorted(known, np.arange(len(value)), side="right") - 1
    return value[known[np.maximum(before, 0)]]
