"""The audit accepts good gaits, and names the right line for each way of tampering with them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ergowalk.audit import AuditReport, audit
from ergowalk.audit.reading import MAY_BE_MISSING, VARIABLES

from . import lies_of_force, lies_of_motion, lies_of_record  # noqa: F401  (they register)
from .conftest import Gait
from .tampering import FLAT, HEEL, LIES, METATARSAL, Lie, set_problem


@pytest.fixture(scope="module")
def truth(good: Gait) -> AuditReport:
    """What the audit says before anything is tampered with."""
    return good.audited()


def test_a_walk_led_by_hand_is_accepted(marionette: Gait) -> None:
    report = marionette.audited()
    assert report.accepted, report.table()


def test_the_solved_gait_of_the_paper_is_accepted(paper_gait: xr.Dataset) -> None:
    report = audit(paper_gait)
    assert report.accepted, report.table()


@pytest.mark.parametrize("lie", LIES, ids=lambda lie: lie.name)
def test_the_audit_names_the_lie(good: Gait, truth: AuditReport, lie: Lie) -> None:
    gait = good.copy()
    changed = lie.tell(gait.dataset)
    report = Gait(gait.dataset if changed is None else changed, gait.folder).audited()
    assert not report.line(lie.line).accepted
    assert report.line(lie.line) != truth.line(lie.line)
    more = {line.key for line in report.failed} - {line.key for line in truth.failed}
    assert more <= {lie.line} | lie.others


@pytest.mark.parametrize("name", sorted(set(VARIABLES) - set(MAY_BE_MISSING)))
def test_a_missing_number_fails_and_is_named(marionette: Gait, name: str) -> None:
    gait = marionette.copy()
    if name == "contact_phase":
        gait.dataset[name] = gait.dataset[name].astype(float)
    gait.dataset[name].values[100] = np.nan
    report = gait.audited()
    line = report.line("finite")
    assert not line.accepted
    assert name in line.where
    json.dumps(report.as_dict(), allow_nan=False)


@pytest.mark.parametrize("name", sorted(VARIABLES))
def test_infinite_numbers_fail_without_a_traceback(marionette: Gait, name: str) -> None:
    gait = marionette.copy()
    gait.dataset[name] = gait.dataset[name].astype(float)
    gait.dataset[name].values[:] = np.inf
    report = gait.audited()
    assert not report.accepted
    json.dumps(report.as_dict(), allow_nan=False)


def test_a_jump_of_a_moment_counts_in_full(marionette: Gait) -> None:
    gait = marionette.copy()
    set_problem(gait.dataset, "limits.moment_rate_nm_per_kg_s", "knee", "10000.0")
    double = 225 + int(np.argmin(np.diff(gait.dataset["time"].values)[225:]))
    gait.dataset["joint_moment"].values[double + 1 :, 0, 1] += 100.0
    line = gait.audited().line("moment_rate_limits")
    mass, gravity = 46.7 + 2 * (8.49 + 3.51 + 1.24), 9.81
    assert line.value == pytest.approx(100 / (mass * gravity), rel=0.1)
    assert f"t = {gait.dataset['time'].values[double]:.4f} s, leg 1, knee" in line.where


def test_a_slow_drift_of_a_moment_breaks_no_rate_limit(marionette: Gait) -> None:
    gait = marionette.copy()
    set_problem(gait.dataset, "limits.moment_rate_nm_per_kg_s", "hip", "1.0")
    phase = 2 * np.pi * gait.dataset["time"].values / gait.dataset.attrs["stride_time"]
    fastest = 73.18 * gait.dataset.attrs["stride_time"] / (2 * np.pi)  # 1 N m/(kg s)
    moment = gait.dataset["joint_moment"].values[:, :, 0]
    moment[:] = 0.99 * fastest * np.sin(phase)[:, None]
    assert gait.audited().line("moment_rate_limits").value == 0
    moment *= 1.2
    assert gait.audited().line("moment_rate_limits").value > 1e-3


def test_a_corridor_table_that_is_lost_is_said_to_be_taken_on_trust(
    marionette: Gait, tmp_path: Path
) -> None:
    line = audit(marionette.dataset, tmp_path).line("corridors_as_asked")
    assert line.accepted
    assert "taken on trust" in line.note


def test_a_corridor_table_that_is_broken_fails(marionette: Gait, tmp_path: Path) -> None:
    (tmp_path / "marionette.csv").write_text("nonsense\n", encoding="utf-8")
    line = audit(marionette.dataset, tmp_path).line("corridors_as_asked")
    assert not line.accepted
    assert "column is missing" in line.note


def test_a_stored_file_says_the_same_as_the_dataset(marionette: Gait, tmp_path: Path) -> None:
    marionette.dataset.to_netcdf(tmp_path / "gait.nc")
    with xr.open_dataset(tmp_path / "gait.nc") as stored:
        assert audit(stored, marionette.folder) == marionette.audited()


def test_labels_and_dimensions_may_stand_in_any_order(marionette: Gait) -> None:
    shuffled = marionette.dataset.isel(leg=[1, 0], joint=[3, 1, 0, 2], axis=[1, 0])
    shuffled = shuffled.transpose("segment", "joint", "leg", "axis", "time")
    assert audit(shuffled, marionette.folder) == marionette.audited()


@pytest.mark.parametrize("name", sorted(set(VARIABLES) - {"contact_phase"}))
def test_one_value_off_by_one_percent_is_noticed(marionette: Gait, name: str) -> None:
    gait = marionette.copy()
    values = gait.dataset[name].values
    place = np.unravel_index(int(np.nanargmax(np.abs(values))), values.shape)
    values[place] *= 1.01
    assert not gait.audited().accepted


def test_up_to_heel_off_the_metatarsal_moment_only_balances_a_line_of_1(marionette: Gait) -> None:
    gait = marionette.copy()
    moment = gait.dataset["joint_moment"].values[:, :, METATARSAL]
    formal = np.isin(gait.dataset["contact_phase"].values, (HEEL, FLAT))
    moment[formal] *= 10.0
    physical = float(np.abs(moment[~formal]).max()) / 73.18  # per kg
    limits = "limits.moment_nm_per_kg"
    set_problem(gait.dataset, limits, "metatarsal", str(1.01 * physical))
    assert gait.audited().line("moment_limits").accepted
    set_problem(gait.dataset, limits, "metatarsal", str(0.9 * physical))
    assert "metatarsal" in gait.audited().line("moment_limits").where


@pytest.mark.parametrize(
    "nonsense", ["true", '"much"', "[]", "[1, 2, 3]", "nan", "-1", "1979-05-27"]
)
def test_nonsense_in_the_stored_problem_gives_failing_lines(
    marionette: Gait, nonsense: str
) -> None:
    names = {
        "": ["step_length_m"],
        "body": ["trunk_mass_kg"],
        "corridors": ["source", "width_sd"],
        "rhythm": ["heel_end", "order"],
        "limits": ["vertical_reaction_body_weights", "friction_coefficient"],
        "limits.moment_nm_per_kg": ["hip"],
        "limits.moment_rate_nm_per_kg_s": ["knee"],
    }
    gait = marionette.copy()
    for table, keys in names.items():
        for key in keys:
            set_problem(gait.dataset, table, key, nonsense)
    report = gait.audited()
    keys = {
        "attributes",
        "corridors_as_asked",
        "rhythm_as_asked",
        "vertical_reaction_cap",
        "friction",
        "moment_limits",
        "moment_rate_limits",
    }
    assert keys <= {line.key for line in report.failed}
    json.dumps(report.as_dict(), allow_nan=False)


def test_tables_that_are_no_tables_give_failing_lines(marionette: Gait) -> None:
    gait = marionette.copy()
    gait.dataset.attrs["problem"] = "\n".join(
        f"{name} = 3" for name in ("body", "corridors", "rhythm", "limits", "step_length_m")
    )
    keys = {line.key for line in gait.audited().failed}
    assert {"attributes", "corridors_as_asked", "rhythm_as_asked", "moment_limits"} <= keys


@pytest.mark.parametrize(
    "history",
    ["[]", "3", "{}", "[1, null]", '[{"final": true}]', "not json",
     '[{"elements": "many", "energy_per_metre": null, "final": true}]'],
)  # fmt: skip
def test_a_mesh_history_that_says_nothing_fails(marionette: Gait, history: str) -> None:
    gait = marionette.copy()
    gait.dataset.attrs["mesh_history"] = history
    assert "mesh" in {line.key for line in gait.audited().failed}
