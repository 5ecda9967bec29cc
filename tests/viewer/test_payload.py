"""What the viewer is given is the gait: rigid segments, feet at rest, E from the powers."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
import xarray as xr

from ergowalk.comparison import body_of, contact_phases, human_of
from ergowalk.corridors import HumanGait
from ergowalk.errors import GaitFileError
from ergowalk.solution import Solution
from ergowalk.viewer.payload import INTERVALS, Frames, gait_payload

ROUNDING = 2e-4  # m: both ends of a segment have four decimals in x and y


@pytest.fixture(scope="module")
def payload(paper_gait: xr.Dataset) -> dict[str, Any]:
    return gait_payload(paper_gait, human_of(paper_gait), "a gait")


def test_payload_is_plain_json_of_even_frames(payload: dict[str, Any]) -> None:
    assert json.loads(json.dumps(payload, allow_nan=False)) == payload
    for leg in payload["legs"]:
        assert {len(leg[k]) for k in leg if k != "phases"} == {INTERVALS + 1}
    assert {len(c["values"]) for c in payload["curves"]} == {INTERVALS + 1}


@pytest.mark.parametrize("i", [0, 1])
def test_segments_keep_their_lengths(payload: dict[str, Any], paper_gait: xr.Dataset, i: int):
    leg, body = payload["legs"][i], body_of(paper_gait).leg(i)
    lengths = {
        ("hip", "knee"): body.thigh_length,
        ("knee", "ankle"): body.shank_length,
        ("ankle", "heel"): body.heel_to_ankle,
        ("ankle", "metatarsal"): body.ankle_to_metatarsal,
        ("heel", "metatarsal"): body.heel_to_metatarsal,
        ("metatarsal", "toe_tip"): body.toe_length,
    }
    points = {**leg, "hip": payload["hip"]}
    for (a, b), length in lengths.items():
        between = np.linalg.norm(np.subtract(points[a], points[b]), axis=1)
        assert between == pytest.approx(length, abs=ROUNDING), (a, b)


@pytest.mark.parametrize(
    ("point", "phases"), [("heel", {"heel", "flat"}), ("toe_tip", {"flat", "forefoot", "toe"})]
)
def test_what_stands_on_the_ground_rests(
    payload: dict[str, Any], point: str, phases: set[str]
) -> None:
    leg = payload["legs"][0]
    spans = [(p["start"], p["end"]) for p in leg["phases"] if p["name"] in phases]
    fraction = np.linspace(0, 1, INTERVALS + 1)
    there = [(fraction >= a) & (fraction <= b) for a, b in spans]
    standing = np.array(leg[point])[np.logical_or.reduce(there)]
    assert len(standing) > 50
    assert np.ptp(standing, axis=0) == pytest.approx(0, abs=3e-4)  # m: heights are interpolated
    assert standing[:, 1] == pytest.approx(0, abs=3e-4)


def test_powers_integrate_to_the_energy(payload: dict[str, Any], paper_gait: xr.Dataset) -> None:
    mass, step = body_of(paper_gait).total_mass, payload["stride_time"] / INTERVALS
    power = mass * sum(np.abs(leg["power"]) for leg in payload["legs"])
    work = np.trapezoid(power, dx=step, axis=0) / payload["stride_length"]
    exact = Solution(paper_gait).energy_by_joint
    assert work[:2] == pytest.approx([exact["hip"], exact["knee"]], rel=0.01)
    # ankle and metatarsal power jump to peaks of a few milliseconds, which frames of 4 ms widen
    assert work.sum() == pytest.approx(paper_gait.attrs["energy_per_metre"], rel=0.04)


def test_leg_2_is_leg_1_half_a_stride_later(payload: dict[str, Any]) -> None:
    half, step = INTERVALS // 2, payload["stride_length"] / 2
    first, second = (np.array(leg["ankle"]) for leg in payload["legs"])
    assert second[half:] - [step, 0] == pytest.approx(first[: half + 1], abs=ROUNDING)


def test_pressure_is_under_the_foot_and_nowhere_in_swing(payload: dict[str, Any]) -> None:
    leg = payload["legs"][0]
    swing = next(p for p in leg["phases"] if p["name"] == "swing")
    fraction = np.linspace(0, 1, INTERVALS + 1)
    inside = (fraction > swing["start"]) & (fraction < swing["end"])
    assert {leg["pressure"][i] for i in np.flatnonzero(inside)} == {None}
    assert all(x is not None for x in np.array(leg["pressure"])[fraction < swing["start"]])


@pytest.mark.parametrize("leg", [1, 2])
def test_phases_fill_the_stride(paper_gait: xr.Dataset, leg: int) -> None:
    phases = contact_phases(paper_gait, leg)
    assert [p.start for p in phases] == [0.0, *(p.end for p in phases[:-1])]
    assert phases[-1].end == 1.0
    assert {p.name for p in phases} == {"heel", "flat", "forefoot", "toe", "swing"}


def test_phases_change_where_the_rhythm_says(paper_gait: xr.Dataset) -> None:
    rhythm = json.loads(paper_gait.attrs["rhythm"])
    ends = {p.name: p.end for p in contact_phases(paper_gait, 1)}
    assert ends["heel"] == pytest.approx(rhythm["heel_end"], abs=1e-9)
    assert ends["toe"] == pytest.approx(rhythm["toe_off"], abs=1e-9)


def test_curves_carry_the_human_band_where_the_table_has_it(
    payload: dict[str, Any], paper_gait: xr.Dataset
) -> None:
    human = human_of(paper_gait)
    for curve in payload["curves"]:
        assert ("human" in curve) == (curve["name"] in human.curves)
    weight = next(c for c in payload["curves"] if c["name"] == "reaction_y")
    assert weight["unit"] == "body weights"
    assert 0.9 < max(weight["human"]["mean"]) < 1.3
    assert max(weight["values"]) == pytest.approx(1.3, abs=0.02)  # the limit of the problem


def test_without_human_data_there_is_no_band(paper_gait: xr.Dataset) -> None:
    bare = gait_payload(paper_gait, HumanGait("none", {}), "x")
    assert [c for c in bare["curves"] if "human" in c] == []


def test_an_instant_that_stands_twice_counts_with_its_later_limit(paper_gait: xr.Dataset) -> None:
    jump = np.array([0.0, 0.5, 0.5, 1.0])
    dataset = xr.Dataset(coords={"time": ("time", jump * 1.14)})
    frames = Frames(dataset)
    values = frames.of(np.array([0.0, 1.0, 3.0, 4.0]))
    assert values[INTERVALS // 2] == 3.0
    assert values[INTERVALS // 2 - 1] == pytest.approx(1.0 - 2 / INTERVALS)
    assert (values[0], values[-1]) == (0.0, 4.0)


def test_a_missing_variable_is_named(paper_gait: xr.Dataset) -> None:
    with pytest.raises(GaitFileError, match="joint_power: must be there as numbers over time"):
        gait_payload(paper_gait.drop_vars("joint_power"), human_of(paper_gait), "x")


def test_work_of_the_joints_adds_up_to_the_energy(paper_gait: xr.Dataset) -> None:
    from ergowalk.viewer.figures import work_by_joint

    work = work_by_joint(Solution(paper_gait))
    total = sum(part.total for part in work.values())
    assert total == pytest.approx(paper_gait.attrs["energy_per_metre"], rel=1e-3)
    assert all(w.positive >= 0 and w.negative >= 0 for w in work.values())
    # on level ground as much is taken up as is done
    assert sum(w.positive - w.negative for w in work.values()) == pytest.approx(0, abs=0.01)
