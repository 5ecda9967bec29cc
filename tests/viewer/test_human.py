"""The walker of the human means: its angles, a standing foot that rests, no more than is known."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr

from ergowalk.comparison import body_of, human_of
from ergowalk.corridors import HumanGait, human_gait
from ergowalk.errors import GaitFileError
from ergowalk.solution import Solution
from ergowalk.viewer import human_payload, report_html
from ergowalk.viewer.payload import INTERVALS, gait_payload

ROUNDING = 2e-4  # m: both ends of a segment have four decimals in x and y
HALF = INTERVALS // 2


@pytest.fixture(scope="module")
def walker(paper_gait: xr.Dataset) -> dict[str, Any]:
    return human_payload(paper_gait, human_of(paper_gait))


def points(walker: dict[str, Any], name: str, leg: int = 0) -> np.ndarray:
    return np.array(walker[name] if name == "hip" else walker["legs"][leg][name], dtype=float)


def pitch(walker: dict[str, Any], first: str, second: str) -> np.ndarray:
    """Angle [deg] of a line from the downward vertical, forward positive."""
    x, y = (points(walker, second) - points(walker, first)).T
    return np.degrees(np.arctan2(x, -y))


def test_it_is_what_the_viewer_takes(walker: dict[str, Any], paper_gait: xr.Dataset) -> None:
    assert json.loads(json.dumps(walker, allow_nan=False)) == walker
    gait = gait_payload(paper_gait, human_of(paper_gait), "a gait")
    assert set(walker) - set(gait) == {"kind"}
    assert set(gait) <= set(walker)
    assert set(walker["legs"][0]) == set(gait["legs"][0])
    assert walker["label"].startswith("human mean angles (winter-natural) on this body")


def test_its_joint_angles_are_the_means_of_the_table(
    walker: dict[str, Any], paper_gait: xr.Dataset
) -> None:
    human, s = human_of(paper_gait), np.linspace(0, 1, INTERVALS + 1)
    thigh, shank = pitch(walker, "hip", "knee"), pitch(walker, "knee", "ankle")
    sole = pitch(walker, "heel", "metatarsal")
    found = {"hip": thigh, "knee": thigh - shank, "ankle": sole - shank - 90}
    for joint, angle in found.items():
        off = (angle - human.curves[f"{joint}_angle"][0](s) + 180) % 360 - 180
        assert np.abs(off).max() < 0.06, joint  # deg: rounding over the 0.2 m of the sole


@pytest.mark.parametrize("source", ["winter-slow", "winter-natural", "winter-fast"])
def test_one_point_stands_and_none_is_below_the_ground(paper_gait: xr.Dataset, source: str):
    walker = human_payload(paper_gait, human_gait(source))
    feet = {(n, i): points(walker, n, i) for n in ("heel", "metatarsal", "toe_tip") for i in (0, 1)}
    heights = np.array([p[:, 1] for p in feet.values()])
    assert heights.min() >= 0.0
    soles = np.array([p for (name, _), p in feet.items() if name != "toe_tip"])
    lowest = soles[:, :, 1].argmin(axis=0)
    frame = np.arange(INTERVALS + 1)
    assert soles[lowest, frame, 1] == pytest.approx(0, abs=1e-9)
    still = np.flatnonzero(lowest[1:] == lowest[:-1])
    slid = soles[lowest[still], still + 1, 0] - soles[lowest[still], still, 0]
    assert len(still) > 0.95 * INTERVALS
    assert np.abs(slid).max() < ROUNDING


def test_it_goes_on_where_it_began(walker: dict[str, Any]) -> None:
    way = [walker["stride_length"], 0.0]
    assert 1.2 < way[0] < 1.5
    for name in ("hip", "knee", "heel", "toe_tip"):
        path = points(walker, name)
        assert path[-1] - path[0] == pytest.approx(way, abs=2e-4), name
    later = points(walker, "ankle", 1)[HALF:] - [way[0] / 2, 0]
    assert later == pytest.approx(points(walker, "ankle", 0)[: HALF + 1], abs=ROUNDING)


def test_segments_keep_their_lengths_and_toes_bend_upward_alone(
    walker: dict[str, Any], paper_gait: xr.Dataset
) -> None:
    body = body_of(paper_gait).leg(0)
    toes = np.linalg.norm(points(walker, "toe_tip") - points(walker, "metatarsal"), axis=1)
    assert toes == pytest.approx(body.toe_length, abs=ROUNDING)
    bend = pitch(walker, "metatarsal", "toe_tip") - pitch(walker, "heel", "metatarsal")
    bend = (bend + 180) % 360 - 180
    assert bend.min() > -0.1  # deg: rounding
    assert 10 < bend.max() < 90


def test_powers_are_the_means_and_no_force_is_made_up(
    walker: dict[str, Any], paper_gait: xr.Dataset
) -> None:
    s = np.linspace(0, 1, INTERVALS + 1)
    power = np.array(walker["legs"][0]["power"], dtype=float)
    mean = human_of(paper_gait).curves["ankle_power"][0](s)
    assert power[:, 2] == pytest.approx(mean, abs=1e-4)
    assert {row[3] for row in walker["legs"][0]["power"]} == {None}
    assert set(walker["legs"][0]["pressure"]) == {None}
    assert walker["curves"] == walker["legs"][1]["phases"] == []


def test_a_table_of_angles_alone_is_enough(paper_gait: xr.Dataset) -> None:
    curves = {n: c for n, c in human_of(paper_gait).curves.items() if n.endswith("angle")}
    walker = human_payload(paper_gait, HumanGait("angles.csv", curves))
    assert set(map(tuple, walker["legs"][0]["power"])) == {(None,) * 4}


def test_a_gait_without_a_body_is_refused(paper_gait: xr.Dataset) -> None:
    with pytest.raises(GaitFileError, match="body_parameters"):
        human_payload(paper_gait.assign_attrs(body_parameters="{}"), human_of(paper_gait))


def test_a_report_lays_it_over_the_gaits_when_asked(paper_gait: xr.Dataset) -> None:
    solution = Solution(paper_gait)
    assert "human mean angles" in report_html([solution], human=True)
    assert "human mean angles" not in report_html([solution])
