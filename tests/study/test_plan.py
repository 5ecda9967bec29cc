"""The tree of a sweep: every case begins at a near one that is before it, whoever works."""

from __future__ import annotations

import numpy as np
import pytest

from ergowalk.problem import preset
from ergowalk.study import Sweep
from ergowalk.study.cases import cases_of
from ergowalk.study.plan import Step, planned


def plan(**given: object) -> tuple[Step, ...]:
    sweep = Sweep(**{"base": preset("berbyuk2002"), **given})
    return planned(sweep, cases_of(sweep))


def edges(steps: tuple[Step, ...]) -> list[tuple[dict, dict]]:
    """Values of each case that has a neighbour, and of that."""
    return [(s.case.values, s.neighbour.values) for s in steps if s.neighbour is not None]


GRID = {
    "step_length_m": [0.60, 0.68, 0.76, 0.84],
    "stride_time_s": [1.0, 1.07, 1.14, 1.21, 1.28],
}


def test_a_grid_grows_from_the_base_problem_one_step_at_a_time() -> None:
    steps = plan(grid=GRID)
    assert len(steps) == 20
    assert steps[0].case.values == {"step_length_m": 0.76, "stride_time_s": 1.14}
    assert steps[0].neighbour is None
    for here, there in edges(steps):
        moves = [GRID[f].index(here[f]) - GRID[f].index(there[f]) for f in GRID]
        assert sorted(map(abs, moves)) == [0, 1]


def test_a_case_comes_after_the_one_that_it_begins_at() -> None:
    for given in ({"grid": GRID}, {"random": RANDOM}):
        seen: set[str] = set()
        for step in plan(**given):
            assert step.neighbour is None or step.neighbour.key in seen
            seen.add(step.case.key)


RANDOM = {
    "count": 40,
    "seed": 3,
    "between": {"step_length_m": [0.6, 0.9], "stride_time_s": [0.9, 1.4]},
}


def test_random_cases_begin_at_the_nearest_before_them() -> None:
    steps = plan(random=RANDOM)
    place = {
        s.case.key: np.array(
            [s.case.values["step_length_m"] / 0.3, s.case.values["stride_time_s"] / 0.5]
        )
        for s in steps
    }
    ends = {k: (v - [0.6 / 0.3, 0.9 / 0.5]) for k, v in place.items()}
    low = np.min(list(ends.values()), axis=0)
    span = np.max(list(ends.values()), axis=0) - low
    unit = {k: (v - low) / span for k, v in ends.items()}
    for n, step in enumerate(steps[1:], 1):
        assert step.neighbour is not None
        apart = [np.linalg.norm(unit[s.case.key] - unit[step.case.key]) for s in steps[:n]]
        mine = np.linalg.norm(unit[step.neighbour.key] - unit[step.case.key])
        assert mine == pytest.approx(min(apart))
    assert sum(s.neighbour is None for s in steps) == 1


def test_there_is_one_step_from_kind_to_kind() -> None:
    grid = {"corridors.source": ["winter-slow", "winter-natural", "winter-fast"], **GRID}
    crossings = [
        (here, there)
        for here, there in edges(plan(grid=grid))
        if here["corridors.source"] != there["corridors.source"]
    ]
    assert len(crossings) == 2
    for here, there in crossings:
        assert {f: here[f] for f in GRID} == {f: there[f] for f in GRID}


def test_a_bound_that_is_off_is_a_kind_of_its_own() -> None:
    grid = {"limits.vertical_reaction_body_weights": [1.2, 1.3, "off"], **GRID}
    crossings = [1 for a, b in edges(plan(grid=grid)) if "off" in {*a.values()} ^ {*b.values()}]
    assert len(crossings) == 1


def test_without_continuation_every_case_stands_alone() -> None:
    assert edges(plan(grid=GRID, solve={"continuation": False})) == []


def test_a_case_without_a_problem_is_not_in_the_plan() -> None:
    steps = plan(grid={"step_length_m": [0.7, 0.76, 3.0]})
    assert [s.case.values["step_length_m"] for s in steps] == [0.76, 0.7]


def test_a_single_case_is_a_plan() -> None:
    assert len(plan(grid={"step_length_m": [0.7]})) == 1
    assert len(plan(cases=[{"step_length_m": 0.7, "stride_time_s": 1.0}])) == 1
