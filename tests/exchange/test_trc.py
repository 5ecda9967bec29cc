"""Joint centres as markers: counts, units, and segments that keep their length."""

from __future__ import annotations

import numpy as np
import pytest

from ergowalk.io import Samples

from .readers import read_trc


def test_header_tells_rates_frames_and_units(export):
    header = read_trc(export.text("trc")).header
    assert header == {
        "DataRate": "200",
        "CameraRate": "200",
        "NumFrames": "229",
        "NumMarkers": "12",
        "Units": "mm",
        "OrigDataRate": "200",
        "OrigDataStartFrame": "1",
        "OrigNumFrames": "229",
    }


def test_frames_are_even_and_the_walk_is_in_the_plane(export):
    read = read_trc(export.text("trc"))
    np.testing.assert_allclose(np.diff(read.time), 1 / 200, atol=1e-9)
    for place in read.places.values():
        assert np.all(place[:, 2] == 0)


def test_segments_between_markers_have_the_lengths_of_the_body(export):
    """In mm, six decimals: 1e-5 mm."""
    places = read_trc(export.text("trc")).places
    for i, side in enumerate("RL"):
        leg = Samples(export.gait).body.leg(i)
        for first, second, length in (
            ("Hip", f"{side}.Knee", leg.thigh_length),
            (f"{side}.Knee", f"{side}.Ankle", leg.shank_length),
            (f"{side}.Heel", f"{side}.Ankle", leg.heel_to_ankle),
            (f"{side}.Ankle", f"{side}.Metatarsal", leg.ankle_to_metatarsal),
            (f"{side}.Heel", f"{side}.Metatarsal", leg.heel_to_metatarsal),
            (f"{side}.Metatarsal", f"{side}.Toe.Tip", leg.toe_length),
        ):
            found = np.linalg.norm(places[first] - places[second], axis=1)
            np.testing.assert_allclose(found, 1000 * length, atol=1e-5)


def test_feet_stand_where_the_gait_says(export):
    """Leg 1's heel meets the ground at t = 0 at x = 0 and leg 2's a step later: 0.1 mm."""
    read = read_trc(export.text("trc"))
    assert read.places["R.Heel"][0] == pytest.approx([0, 0, 0], abs=0.1)
    half = np.argmin(np.abs(read.time - 0.57))
    assert read.places["L.Heel"][half] == pytest.approx([760, 0, 0], abs=0.1)
    for name, place in read.places.items():
        if name.split(".")[-1] in ("Heel", "Metatarsal", "Tip"):
            assert place[:, 1].min() > -0.1
    hip = read.places["Hip"]
    assert hip[-1, 0] - hip[0, 0] == pytest.approx(1520, abs=1e-3)
