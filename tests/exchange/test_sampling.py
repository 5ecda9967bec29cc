"""Sampling of a stride: curves with known values between their samples."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from ergowalk.body import Body
from ergowalk.errors import GaitFileError, InputError
from ergowalk.io import Samples


def test_samples_lie_on_the_curves(export):
    """At 1 kHz between stored instants: thigh angle against the cubic's error h^4 / 384 max f''''
    and position against velocity, through the integral of the one being the other."""
    gait = export.gait
    samples = Samples(gait, rate=1000.0)
    angle = samples.segment(1, "thigh")
    stored = gait["segment_angle"].sel(leg=1, segment="thigh").values
    linear = np.interp(samples.time, gait["time"].values, stored)
    rates = gait["segment_angular_acceleration"].sel(leg=1, segment="thigh").values
    step = np.diff(gait["time"].values).max()
    assert np.max(np.abs(angle - linear)) <= 1.01 * step**2 / 8 * np.max(np.abs(rates))
    speed = samples.linear("hip_velocity", axis="x")
    covered = np.concatenate([[0], np.cumsum(np.diff(samples.time) * (speed[1:] + speed[:-1]) / 2)])
    # trapezia of a curve with accelerations up to 20 m/s2 that jump: 1e-5 m
    np.testing.assert_allclose(samples.hip()[:, 0] - samples.hip()[0, 0], covered, atol=3e-5)


def made_up(period: float = 1.25) -> xr.Dataset:
    """A gait of cubics; an instant stands twice, where the force jumps from 10 to 30 N."""
    time = np.array([0.0, 0.3, 0.5, 0.5, 0.9, 1.25]) * period / 1.25
    x, v = 0.1 + 1.2 * time + 0.4 * time**3, 1.2 + 1.2 * time**2
    force = np.array([10.0, 10, 10, 30, 30, 30])
    return xr.Dataset(
        {
            "hip_position": (("time", "axis"), np.stack([x, 0 * x + 1], 1)),
            "hip_velocity": (("time", "axis"), np.stack([v, 0 * v], 1)),
            "ground_reaction_force": (
                ("time", "leg", "axis"),
                np.tile(force[:, None, None], (1, 2, 2)),
            ),
            "center_of_pressure": (
                ("time", "leg"),
                np.stack([[0, 0.1, 0.2, np.nan, np.nan, np.nan]] * 2, 1),
            ),
        },
        coords={"time": time, "leg": [1, 2], "axis": ["x", "y"]},
        attrs={"body_parameters": json.dumps(Body().by_symbol())},
    )


def test_a_cubic_is_reproduced_and_strides_follow_each_other():
    samples = Samples(made_up(), rate=100.0, strides=3)
    assert samples.time[-1] == pytest.approx(3.75)
    assert len(samples.time) == 376
    length = 1.2 * 1.25 + 0.4 * 1.25**3
    whole = np.minimum(np.floor(samples.time / 1.25 + 1e-9), 3)
    t = samples.time - 1.25 * whole
    expected = 0.1 + 1.2 * t + 0.4 * t**3 + whole * length
    np.testing.assert_allclose(samples.hip()[:, 0], expected, atol=1e-12)


def test_where_an_instant_stands_twice_the_later_limit_counts():
    samples = Samples(made_up(), rate=2.0)
    assert samples.time.tolist() == [0.0, 0.5, 1.0]
    assert samples.reaction(1)[:, 1].tolist() == [10.0, 30.0, 30.0]


def test_a_foot_in_the_air_keeps_its_place_on_the_ground():
    samples = Samples(made_up(), rate=10.0, strides=2)
    length = 1.2 * 1.25 + 0.4 * 1.25**3
    pressure = samples.pressure(1)
    assert pressure[5:13].tolist() == pytest.approx(8 * [0.2])
    assert pressure[13] == pytest.approx(length + 0.05 / 0.3 * 0.1)


def test_the_last_instant_of_the_stride_is_sampled_when_the_rate_allows():
    for period, rate in ((1.14, 200.0), (1.1396, 1000 / 1.1396), (0.97, 100.0)):
        samples = Samples(made_up(period), rate)
        assert samples.time[-1] == pytest.approx(period, abs=1e-12)


@pytest.mark.parametrize(
    ("rate", "strides", "match"),
    [
        (0.0, 1, r"rate = 0\.0: must be positive and at most 20000 Hz; give samples"),
        (-1.0, 1, r"rate = -1\.0: must be positive"),
        (np.nan, 1, "rate = nan: must be positive"),
        (1e6, 1, r"rate = 1000000\.0: must be positive and at most"),
        (0.5, 1, r"rate = 0\.5: must give two samples, that is at least 0\.8 Hz; raise it"),
        (200.0, 0, "strides = 0: must lie between 1 and 100"),
        (200.0, 101, "strides = 101: must lie between 1 and 100"),
    ],
)
def test_rates_and_strides_out_of_range_are_refused(rate, strides, match):
    with pytest.raises(InputError, match=match):
        Samples(made_up(), rate, strides)


def test_a_gait_without_a_body_is_refused():
    gait = made_up()
    del gait.attrs["body_parameters"]
    with pytest.raises(GaitFileError, match="attribute body_parameters: must be a JSON object"):
        Samples(gait)
