"""The dataset of a stride obeys the contract of a gait file."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ergowalk.gait.rhythm import PRINTED_RHYTHM, Contact, boundary_fractions
from ergowalk.mechanics.kinematics import joint_angles
from ergowalk.quantities import AXES, JOINTS, LEGS, QUANTITIES, SEGMENTS
from ergowalk.solution.stride import stride_dataset

from .made_up import PROBLEM, SAMPLES, motion, pieces

HALF = 4 * SAMPLES
STEP = PROBLEM.step_length_m


@pytest.fixture(scope="module")
def stride() -> xr.Dataset:
    return stride_dataset(PROBLEM, [pieces()])


def halves(stride: xr.Dataset, name: str) -> tuple[np.ndarray, np.ndarray]:
    """A variable in the first and the second half of the stride."""
    values = stride[name].to_numpy()
    return values[:HALF], values[HALF:]


def test_every_quantity_is_there_with_its_dimensions_and_nothing_else(stride: xr.Dataset) -> None:
    assert set(stride.data_vars) | {"time"} == set(QUANTITIES)
    for name, quantity in QUANTITIES.items():
        assert stride[name].dims == quantity.dims
        assert np.issubdtype(stride[name].dtype, np.number)


def test_every_quantity_says_its_unit_its_meaning_and_its_symbol(stride: xr.Dataset) -> None:
    for name, quantity in QUANTITIES.items():
        stored = stride[name].attrs
        assert (stored["units"], stored["long_name"], stored["symbol"]) == (
            quantity.units,
            quantity.long_name,
            quantity.symbol,
        )


def test_labels_are_those_of_the_contract(stride: xr.Dataset) -> None:
    for dim, labels in (("leg", LEGS), ("axis", AXES), ("segment", SEGMENTS), ("joint", JOINTS)):
        assert tuple(stride[dim].to_numpy().tolist()) == labels


def test_contact_phases_are_flags_with_meanings(stride: xr.Dataset) -> None:
    phase = stride["contact_phase"]
    assert np.issubdtype(phase.dtype, np.integer)
    meanings = dict(
        zip(phase.attrs["flag_meanings"].split(), phase.attrs["flag_values"].tolist(), strict=True)
    )
    assert meanings == {"swing": 0, "heel": 1, "flat": 2, "forefoot": 3, "toe": 4}


def test_time_runs_from_zero_to_the_stride_time_and_stands_twice_at_jumps(
    stride: xr.Dataset,
) -> None:
    time = stride["time"].to_numpy()
    assert (time[0], time[-1]) == (0.0, PROBLEM.stride_time_s)
    assert len(time) == 2 * HALF
    steps = np.diff(time)
    assert steps.min() == 0.0
    fractions = sorted(boundary_fractions(PRINTED_RHYTHM).values())[1:-1]
    jumps = [*fractions, 0.5, *(0.5 + f for f in fractions)]
    found = time[:-1][steps == 0.0] / PROBLEM.stride_time_s
    np.testing.assert_allclose(found, jumps, atol=1e-12)


def test_legs_change_places_in_the_second_half(stride: xr.Dataset) -> None:
    for name, quantity in QUANTITIES.items():
        if "leg" not in quantity.dims or name == "center_of_pressure":
            continue
        if name.startswith("corridor"):
            continue  # follows from the time, below
        first, second = halves(stride, name)
        np.testing.assert_array_equal(second, first[:, ::-1])


def test_the_second_half_is_one_step_further_on(stride: xr.Dataset) -> None:
    first, second = halves(stride, "hip_position")
    np.testing.assert_allclose(
        second - first, np.broadcast_to([STEP, 0.0], first.shape), atol=1e-15
    )
    first, second = halves(stride, "center_of_pressure")
    np.testing.assert_allclose(second, first[:, ::-1] + STEP, atol=1e-15)
    for name in ("hip_velocity", "hip_acceleration", "trunk_angle", "trunk_angular_velocity"):
        np.testing.assert_array_equal(*halves(stride, name))


def test_the_motion_is_stored_as_it_was_given(stride: xr.Dataset) -> None:
    given = motion(stride["time"].to_numpy()[:HALF])
    np.testing.assert_array_equal(halves(stride, "trunk_angle")[0], given.trunk.angle)
    np.testing.assert_array_equal(
        halves(stride, "hip_velocity")[0], np.stack(given.hip.velocity, axis=1)
    )
    stored = {
        "angle": "segment_angle",
        "rate": "segment_angular_velocity",
        "acceleration": "segment_angular_acceleration",
    }
    for kind, name in stored.items():
        for i, leg in enumerate(given.legs):
            for j, segment in enumerate(SEGMENTS):
                found = halves(stride, name)[0][:, i, j]
                np.testing.assert_array_equal(found, getattr(getattr(leg, segment), kind))


def test_joint_angles_follow_from_segment_angles(stride: xr.Dataset) -> None:
    for i, leg in enumerate(LEGS):
        own = stride["segment_angle"].sel(leg=leg)
        segments = (own.sel(segment=s).to_numpy() for s in SEGMENTS)
        expected = joint_angles(PROBLEM.body.leg(i), stride["trunk_angle"].to_numpy(), *segments)
        stored = stride["joint_angle"].sel(leg=leg).to_numpy()
        np.testing.assert_allclose(stored, np.stack(expected, axis=1), atol=1e-15)


def test_power_is_moment_times_relative_rate(stride: xr.Dataset) -> None:
    rate = stride["segment_angular_velocity"].to_numpy()
    trunk = np.broadcast_to(
        stride["trunk_angular_velocity"].to_numpy()[:, None, None], (*rate.shape[:2], 1)
    )
    relative = np.diff(np.concatenate([trunk, rate], axis=2), axis=2)
    expected = stride["joint_moment"].to_numpy() * relative
    np.testing.assert_allclose(stride["joint_power"].to_numpy(), expected, rtol=1e-12, atol=1e-9)


def test_pressure_is_missing_exactly_in_swing(stride: xr.Dataset) -> None:
    swing = stride["contact_phase"].to_numpy() == Contact.SWING
    assert swing.any() and not swing.all()
    np.testing.assert_array_equal(np.isnan(stride["center_of_pressure"].to_numpy()), swing)


def test_swing_carries_no_load(stride: xr.Dataset) -> None:
    swing = stride["contact_phase"] == Contact.SWING
    force = stride["ground_reaction_force"].where(swing, 0.0)
    assert float(np.abs(force).max()) == 0.0
    distal = stride["joint_moment"].sel(joint=["ankle", "metatarsal"]).where(swing, 0.0)
    assert float(np.abs(distal).max()) == 0.0


def test_corridors_of_leg_2_are_half_a_stride_late(stride: xr.Dataset) -> None:
    fraction = stride["time"].to_numpy() / PROBLEM.stride_time_s
    for joint, corridor in PROBLEM.angle_corridors().items():
        for leg, shift in ((1, 0.0), (2, 0.5)):
            for name, bound in (
                ("corridor_lower", corridor.lower),
                ("corridor_upper", corridor.upper),
            ):
                stored = stride[name].sel(leg=leg, joint=joint).to_numpy()
                np.testing.assert_allclose(stored, bound(fraction + shift), atol=1e-12)


def test_the_metatarsal_joint_has_no_corridor(stride: xr.Dataset) -> None:
    for name in ("corridor_lower", "corridor_upper"):
        assert bool(np.isnan(stride[name].sel(joint="metatarsal")).all())
        assert not bool(np.isnan(stride[name].sel(joint=["hip", "knee", "ankle"])).any())
