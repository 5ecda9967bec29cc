"""The stick figure against the mechanics, which places the same points by its own code."""

from __future__ import annotations

import json

import numpy as np
import pytest
from matplotlib.figure import Figure

from ergowalk.body import Body
from ergowalk.errors import GaitFileError
from ergowalk.mechanics.kinematics import LegMotion, Point, Rotation, leg_points
from ergowalk.plots.cyclogram import INTERVALS, TRUNK_DRAWN, draw_cyclogram, sticks

from .synthetic import BODY, STEP_LENGTH, fractions, gait

STORED = fractions()[::37]


def test_the_points_are_those_of_the_mechanics():
    dataset = gait()
    drawn = sticks(dataset, STORED)
    at = dataset.isel(time=slice(None, None, 37))
    hip = Point((at.hip_position.values[:, 0], at.hip_position.values[:, 1]))
    for i, leg in enumerate(drawn.legs):
        motion = LegMotion(*(Rotation(at.segment_angle.values[:, i, k]) for k in range(4)))
        expected = leg_points(BODY.leg(i), motion, hip)
        for name in ("knee", "ankle", "heel", "metatarsal", "toe_tip"):
            position = np.stack(getattr(expected, name).position, axis=1)
            np.testing.assert_allclose(getattr(leg, name), position, atol=1e-12, err_msg=name)


def test_each_leg_is_drawn_with_its_own_lengths():
    own = Body(shank_length_m=(0.53, 0.45))
    dataset = gait()
    dataset.attrs["body_parameters"] = json.dumps(own.by_symbol())
    legs = sticks(dataset, np.linspace(0, 1, 9)).legs
    lengths = [np.linalg.norm(leg.ankle - leg.knee, axis=1) for leg in legs]
    np.testing.assert_allclose(lengths[0], 0.53, atol=1e-12)
    np.testing.assert_allclose(lengths[1], 0.45, atol=1e-12)


def test_one_leg_stands_where_the_other_stood_half_a_stride_before():
    early, late = sticks(gait(), np.array([0.1, 0.2])), sticks(gait(), np.array([0.6, 0.7]))
    for before, after in ((early.legs[0], late.legs[1]), (early.legs[1], late.legs[0])):
        step = after.toe_tip - before.toe_tip
        np.testing.assert_allclose(step, [[STEP_LENGTH, 0.0]] * 2, atol=1e-4)


def test_a_trunk_with_a_positive_angle_leans_back():
    dataset = gait()
    dataset["trunk_angle"][:] = 0.2
    bottom, top = np.moveaxis(sticks(dataset, np.array([0.3])).trunk, 1, 0)
    length = TRUNK_DRAWN * BODY.trunk_com_m
    expected = [[-length * np.sin(0.2), length * np.cos(0.2)]]
    np.testing.assert_allclose(top - bottom, expected, atol=1e-12)


def test_an_instant_that_stands_twice_does_not_break_the_drawing():
    drawn = sticks(gait(), np.array([0.0, 0.1, 0.23, 0.5, 1.0]))
    assert np.all(np.isfinite(drawn.legs[0].lines))
    assert np.all(np.isfinite(drawn.trunk))


def test_the_drawing_holds_the_whole_double_step_to_scale():
    axes = Figure().add_axes((0.1, 0.1, 0.8, 0.8))
    draw_cyclogram(axes, gait())
    assert axes.get_aspect() == 1.0
    paths = [p for c in axes.collections for p in c.get_paths()]
    lines = INTERVALS + 1
    assert len(paths) == lines * 5  # trunk, and two legs of leg line and toes
    points = np.concatenate([p.vertices for p in paths])
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert left < points[:, 0].min() < points[:, 0].max() < right
    assert low < points[:, 1].min() < points[:, 1].max() < high
    heels = sticks(gait(), np.array([0.0, 1.0])).legs[0].heel
    assert heels[1, 0] - heels[0, 0] == pytest.approx(2 * STEP_LENGTH, abs=1e-9)


def test_a_gait_without_positions_is_refused():
    with pytest.raises(GaitFileError, match="hip_position: must be there as numbers over time"):
        sticks(gait().drop_vars("hip_position"), np.array([0.5]))
