"""A solved gait, seen by cameras and plates, is measured as what it is."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.comparison import body_of
from ergowalk.measured.choices import Choices
from ergowalk.measured.strides import Stride
from ergowalk.measured.walk import MeasuredWalk, measure
from ergowalk.mechanics.kinematics import LegMotion, Point, Rotation, leg_points
from ergowalk.quantities import SEGMENTS
from ergowalk.recording import Plate, Recording

Array = NDArray[np.float64]

RATE, STRIDES = 250.0, 3


def filmed(gait: xr.Dataset) -> Recording:
    """Markers and plates [m, N] of three strides of a gait in the plane; leg 1 is the right one."""
    duration, way = float(gait.stride_time), 2 * float(gait.step_length)
    time = np.arange(int(STRIDES * duration * RATE)) / RATE
    own, keep = np.unique(gait["time"].values, return_index=True)

    def at(values: xr.DataArray) -> Array:
        return np.interp(time % duration, own, values.values[keep])

    base = way * (time // duration)
    hip = Point((at(gait.hip_position.sel(axis="x")) + base, at(gait.hip_position.sel(axis="y"))))
    lean, markers, plates = at(gait.trunk_angle), {}, []
    top = np.stack([hip.position[0] - 0.5 * np.sin(lean), hip.position[1] + 0.5 * np.cos(lean)], 1)
    for leg, side in ((1, "R"), (2, "L")):
        angles = (Rotation(at(gait.segment_angle.sel(leg=leg, segment=s))) for s in SEGMENTS)
        points = leg_points(body_of(gait).leg(leg - 1), LegMotion(*angles), hip)
        named = {"HJC": hip, "KJC": points.knee, "AJC": points.ankle, "CAL": points.heel}
        named |= {"MT1": points.metatarsal, "MT2": points.metatarsal, "TOE": points.toe_tip}
        for name, point in named.items():
            markers[side + name] = np.stack([*point.position, 0 * time], axis=1)
        force = [at(gait.ground_reaction_force.sel(leg=leg, axis=a)) for a in "xy"]
        load = np.stack([*force, 0 * time], axis=1)
        press = at(gait.center_of_pressure.sel(leg=leg).fillna(0.0)) + base
        where = np.stack([press, 0 * time, 0 * time], axis=1)
        plates.append(Plate(f"{side} plate", time, load, 0 * load, where, "m"))
    markers["C7"] = np.stack([*top.T, 0 * time], axis=1)
    return Recording("filmed gait", time, markers, "m", tuple(plates), planar=True)


def feet_in_shanks(body: Body) -> Body:
    """The body with the mass of the feet, which the model has in the ankle, in the shank's end."""
    p = body.leg(0)
    mass = p.shank_mass + p.foot_mass
    com = (p.shank_mass * p.shank_com + p.foot_mass * p.shank_length) / mass
    inertia = p.shank_inertia + p.foot_mass * p.shank_length**2
    changed: Body = body.replace(
        shank_mass_kg=mass, shank_com_m=com, shank_inertia_kgm2=inertia, foot_mass_kg=1e-6
    )
    return changed


@pytest.fixture(scope="module")
def film(paper_gait: xr.Dataset) -> MeasuredWalk:
    """The solved gait of the paper's case, measured from its film."""
    body = feet_in_shanks(body_of(paper_gait))
    return measure(filmed(paper_gait), Choices(mass_kg=body.total_mass, cutoff_hz=40.0), body=body)


def curve(gait: xr.Dataset, name: str, joint: str, stride: Stride) -> Array:
    """A curve of leg 1 (101,) at each percent of a measured stride of it, which begins when the
    plate feels 20 N."""
    own, keep = np.unique(gait["time"].values, return_index=True)
    values = gait[name].sel(leg=1, joint=joint).values[keep]
    time = np.linspace(stride.start, stride.end, 101) % float(gait.stride_time)
    return np.interp(time, own, values)


def test_step_and_time_of_a_solved_gait_are_measured(
    film: MeasuredWalk, paper_gait: xr.Dataset
) -> None:
    assert film.step_length.mean == pytest.approx(paper_gait.step_length, abs=1e-4)
    assert film.stride_time.mean == pytest.approx(paper_gait.stride_time, abs=1e-4)


@pytest.mark.parametrize("joint", ["hip", "knee", "ankle"])
def test_angles_of_a_solved_gait_are_measured(
    film: MeasuredWalk, paper_gait: xr.Dataset, joint: str
) -> None:
    stride = next(s for s in film.strides if s.side == "right")
    error = stride.curves[f"{joint}_angle"] - curve(paper_gait, "joint_angle", joint, stride)
    assert np.degrees(np.abs(error)).max() < 0.2  # what 40 Hz take away


@pytest.mark.parametrize(("joint", "tolerance"), [("hip", 0.12), ("knee", 0.06), ("ankle", 0.02)])
def test_moments_of_a_solved_gait_are_measured(
    film: MeasuredWalk, paper_gait: xr.Dataset, joint: str, tolerance: float
) -> None:
    """Root mean square as a share of the peak. Accelerations of an optimum jump at its contacts,
    and no filter follows them."""
    stride = next(s for s in film.strides if s.side == "right")
    known = curve(paper_gait, "joint_moment", joint, stride)
    error = stride.curves[f"{joint}_moment"] - known
    assert np.sqrt(np.mean(error**2)) < tolerance * np.abs(known).max()


def test_energy_of_a_solved_gait_is_measured(film: MeasuredWalk, paper_gait: xr.Dataset) -> None:
    """Hip, knee and ankle: the film has no toe markers."""
    power = np.abs(paper_gait["joint_power"]).sum("leg").drop_sel(joint="metatarsal").sum("joint")
    work = float(np.trapezoid(power.values, paper_gait["time"].values))
    known = work / (2 * float(paper_gait.step_length))
    assert film.energy_per_metre is not None
    assert film.energy_per_metre.mean == pytest.approx(known, rel=0.12)
