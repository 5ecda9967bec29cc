"""The CSV table: every number of the gait, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ergowalk.errors import GaitFileError
from ergowalk.io import FORMATS
from ergowalk.quantities import QUANTITIES

from .readers import floats, read_csv


def test_every_variable_comes_back_to_the_last_bit(export):
    table, gait = read_csv(export.text("csv")), export.gait
    seen = 0
    for name in QUANTITIES:
        if name == "contact_phase":
            continue
        for index in np.ndindex(gait[name].shape[1:]):
            labels = {d: gait[d].values[i] for d, i in zip(gait[name].dims[1:], index, strict=True)}
            words = [f"leg{v}" if d == "leg" else str(v) for d, v in labels.items()]
            stem = "_".join([name, *words]) + "_"
            (column,) = [c for c in table if c.startswith(stem) and "leg" not in c[len(stem) :]]
            np.testing.assert_array_equal(floats(table[column]), gait[name].sel(labels).values)
            seen += 1
    assert seen + 2 == len(table)  # two columns of contact phases


def test_units_stand_in_the_names(export):
    table = read_csv(export.text("csv"))
    for column in (
        "time_s",
        "hip_position_x_m",
        "hip_acceleration_y_m_s2",
        "trunk_angular_velocity_rad_s",
        "segment_angle_leg2_toes_rad",
        "joint_moment_leg1_hip_Nm",
        "joint_power_leg1_ankle_W",
        "ground_reaction_force_leg2_y_N",
        "center_of_pressure_leg1_m",
    ):
        assert column in table


def test_contact_is_told_in_words(export):
    words = read_csv(export.text("csv"))["contact_phase_leg1"]
    assert list(dict.fromkeys(words)) == ["heel", "flat", "forefoot", "toe", "swing"]


def test_labels_in_another_order_change_nothing(export):
    gait = export.gait
    turned = gait.isel(leg=[1, 0], axis=[1, 0], joint=[3, 1, 0, 2])
    written = read_csv(FORMATS["csv"].text(turned, 200.0, 1))
    expected = read_csv(export.text("csv"))
    assert {k: written[k] for k in expected} == expected


def test_a_gait_without_a_variable_is_refused(export):
    broken: xr.Dataset = export.gait.drop_vars("joint_moment")
    for name in ("csv", "sto"):
        with pytest.raises(GaitFileError, match="joint_moment: must be there as numbers over time"):
            FORMATS[name].text(broken, 200.0, 1)
