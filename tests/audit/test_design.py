"""The audit holds numbers that were found against their bounds; without any it has no such line."""

from __future__ import annotations

import pytest

from .conftest import Gait
from .tampering import set_problem


def with_design(gait: Gait, lines: str) -> Gait:
    copy = gait.copy()
    copy.dataset.attrs["problem"] += f"\n[design]\n{lines}\n"
    return copy


def test_without_free_numbers_there_is_no_line(marionette: Gait) -> None:
    assert "design" not in [line.key for line in marionette.audited().lines]


def test_numbers_inside_their_bounds_are_accepted(marionette: Gait) -> None:
    before = marionette.audited()
    report = with_design(marionette, '"body.shank_length_m" = [0.01, 10.0]').audited()
    assert report.line("design").accepted
    assert len(report.lines) == len(before.lines) + 1


@pytest.mark.parametrize(
    "lines",
    [
        '"body.shank_length_m" = [10.0, 20.0]',
        '"body.shank_length_m" = [0.001, 0.002]',
        '"body.shank_length" = [0.01, 10.0]',
        '"body.shank_length_m" = [0.01]',
        '"body.shank_length_m" = ["a", "b"]',
        '"devices.ankle.stiffness_nm_per_rad" = [0.0, 1.0]',
    ],
)
def test_numbers_outside_or_not_stated_are_not(marionette: Gait, lines: str) -> None:
    assert not with_design(marionette, lines).audited().line("design").accepted


def test_a_number_moved_after_the_solve_is_found(marionette: Gait) -> None:
    gait = with_design(marionette, '"body.trunk_mass_kg" = [1.0, 100.0]')
    set_problem(gait.dataset, "body", "trunk_mass_kg", "200.0")
    report = gait.audited()
    assert not report.line("design").accepted
    assert not report.line("attributes").accepted
