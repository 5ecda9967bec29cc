"""What is drawn of the curves, and where the names of the phases go."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from ergowalk.comparison import COMPARED, contact_phases
from ergowalk.corridors import HumanGait, human_gait
from ergowalk.errors import GaitFileError
from ergowalk.plots.curves import (
    Material,
    axis_label,
    curve_keys,
    draw_curve,
    problem_corridor,
    spread,
)

from .synthetic import PHASE_ENDS, gait

HUMAN = human_gait("winter-natural")
HIP, KNEE, ANKLE, FORCE_X, FORCE_Y, HIP_MOMENT, KNEE_MOMENT, ANKLE_MOMENT = COMPARED


def drawn(material: Material, signal):
    axes = Figure(figsize=(6, 4)).add_axes((0.1, 0.1, 0.8, 0.8))
    draw_curve(axes, material, signal)
    return axes


def lines_of(axes, style: str, width: float | None = None):
    return [
        line
        for line in axes.lines
        if line.get_linestyle() == style
        and len(line.get_xdata()) > 2
        and (width is None or line.get_linewidth() == width)
    ]


def test_the_solid_curve_is_the_gait_and_the_dashed_one_the_human_mean():
    dataset = gait()
    dataset["joint_angle"].loc[{"leg": 1, "joint": "knee"}] += np.radians(3.0)
    axes = drawn(Material.of(dataset, HUMAN), KNEE)
    mean, _ = HUMAN.curves["knee_angle"]
    (solid,), (dashed,) = lines_of(axes, "-", 1.8), lines_of(axes, "--")
    s = dataset.time.values / dataset.time.values[-1]
    np.testing.assert_allclose(solid.get_xdata(), 100 * s, atol=1e-12)
    np.testing.assert_allclose(solid.get_ydata(), mean(s) + 3.0, atol=1e-9)
    np.testing.assert_allclose(dashed.get_ydata(), mean(np.array(dashed.get_xdata()) / 100))


def test_the_band_is_one_sd_wide_and_never_negative():
    axes = drawn(Material.of(gait(), HUMAN), FORCE_Y)
    (band,) = axes.collections
    vertices = band.get_paths()[0].vertices
    at_14 = vertices[np.abs(vertices[:, 0] - 14.0) < 1e-9, 1]
    assert np.ptp(at_14) == pytest.approx(2 * 0.74, abs=1e-9)  # the table's SD at 14 %
    mean, _ = HUMAN.curves["reaction_y"]
    x, y = vertices.T
    upper = np.array([y[x == p].max() for p in np.unique(x)])
    assert np.all(upper >= mean(np.unique(x) / 100) - 1e-9)


def test_a_corridor_of_one_sd_is_the_band_and_is_not_drawn_twice():
    assert problem_corridor(gait(), HIP, HUMAN) is None
    assert problem_corridor(gait(), HIP_MOMENT, HUMAN) is None


def test_a_wider_corridor_is_drawn_in_degrees():
    dataset = gait()
    middle = (dataset.corridor_lower + dataset.corridor_upper) / 2
    half = (dataset.corridor_upper - dataset.corridor_lower) / 2
    dataset["corridor_lower"], dataset["corridor_upper"] = middle - 2 * half, middle + 2 * half
    lower, upper = problem_corridor(dataset, ANKLE, HUMAN)
    _, sd = HUMAN.curves["ankle_angle"]
    s = dataset.time.values / dataset.time.values[-1]
    np.testing.assert_allclose(upper - lower, 4 * sd(s), atol=1e-9)
    material = Material.of(dataset, HUMAN)
    assert set(material.corridors) == {"hip_angle", "knee_angle", "ankle_angle"}
    assert len(lines_of(drawn(material, ANKLE), "-", 0.8)) == 2
    assert len(lines_of(drawn(material, FORCE_X), "-", 0.8)) == 0
    labels = [key.get_label() for key in curve_keys(material, ANKLE)]
    assert labels[-1] == "corridor"


def test_no_corridor_at_all_is_no_line():
    dataset = gait()
    dataset["corridor_lower"][:] = np.nan
    dataset["corridor_upper"][:] = np.nan
    assert problem_corridor(dataset, KNEE, HUMAN) is None


def test_a_signal_without_human_data_is_drawn_alone():
    angles = HumanGait("own.csv", {n: c for n, c in HUMAN.curves.items() if n.endswith("angle")})
    material = Material.of(gait(), angles)
    axes = drawn(material, KNEE_MOMENT)
    assert len(axes.collections) == 0
    assert lines_of(axes, "--") == []
    labels = [key.get_label() for key in curve_keys(material, KNEE_MOMENT)]
    assert labels == ["optimum, leg 1"]


@pytest.mark.parametrize(
    ("signal", "label"),
    [
        (HIP, "hip angle μᵒ [deg], flexion +"),
        (ANKLE, "ankle angle μᵃ [deg], dorsiflexion +"),
        (FORCE_X, "horizontal reaction Rx/M [N/kg], forward +"),
        (HIP_MOMENT, "hip moment q/M [N m/kg], flexion +"),
        (KNEE_MOMENT, "knee moment u/M [N m/kg], extension +"),
        (ANKLE_MOMENT, "ankle moment p/M [N m/kg], dorsiflexion +"),
    ],
)
def test_the_axis_tells_symbol_unit_and_sign(signal, label):
    assert axis_label(signal) == label


def test_the_phases_of_leg_1_stand_where_its_contact_changes():
    spans = contact_phases(gait())
    assert [span.name for span in spans] == ["heel", "flat", "forefoot", "toe", "swing"]
    assert [span.start for span in spans] == pytest.approx([0.0, *PHASE_ENDS[:-1]])
    assert [span.end for span in spans] == pytest.approx(PHASE_ENDS)


@pytest.mark.parametrize("stands_twice", [True, False])
def test_a_heel_contact_at_the_last_instant_is_no_phase(stands_twice):
    dataset = gait()
    last = dataset.isel(time=[-1]).copy(deep=True)
    last["contact_phase"][0, 0] = 1
    kept = dataset if stands_twice else dataset.isel(time=slice(None, -1))
    longer = xr.concat([kept, last], dim="time", data_vars="minimal")
    spans = contact_phases(longer)
    assert [span.name for span in spans] == ["heel", "flat", "forefoot", "toe", "swing"]
    assert spans[-1].end == 1.0


def test_phase_names_follow_the_flags_of_the_file():
    dataset = gait()
    dataset["contact_phase"].attrs["flag_values"] = [4, 3, 2, 1, 0]
    # codes 1 2 3 4 0 in time order, each now under the name of 4 minus itself
    names = [span.name for span in contact_phases(dataset)]
    assert names == ["forefoot", "flat", "heel", "swing", "toe"]


def test_a_gait_without_contact_phases_is_refused():
    with pytest.raises(GaitFileError, match="contact_phase: must be there"):
        contact_phases(gait().drop_vars("contact_phase"))


def test_labels_with_room_stay_in_the_middle_of_their_phases():
    assert spread([0.1, 0.5, 0.9], [0.1, 0.2, 0.1]) == pytest.approx([0.1, 0.5, 0.9])


def test_colliding_labels_share_the_shift():
    assert spread([0.50, 0.52], [0.1, 0.1]) == pytest.approx([0.46, 0.56])
    assert spread([0.01, 0.02], [0.1, 0.1]) == pytest.approx([0.05, 0.15])


@given(st.lists(st.tuples(st.floats(0, 1), st.floats(0.01, 0.1)), min_size=1, max_size=9))
def test_spread_labels_keep_order_and_place_and_never_overlap(labels):
    centres = sorted(centre for centre, _ in labels)
    widths = [width for _, width in labels]
    placed = spread(centres, widths)
    left = np.array(placed) - np.array(widths) / 2
    right = np.array(placed) + np.array(widths) / 2
    assert np.all(left[1:] >= right[:-1] - 1e-12)
    assert left[0] >= -1e-12
    assert right[-1] <= 1 + 1e-12
