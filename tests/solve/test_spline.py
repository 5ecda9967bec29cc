"""The spline method: its choices, what it stores of its way, and what it says of its end."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ergowalk.audit import check_readable
from ergowalk.comparison import compare, human_of
from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM, PhaseOrder
from ergowalk.problem import GaitProblem, preset
from ergowalk.solution import Progress, Solution
from ergowalk.solving import (
    SplineOptions,
    collocation,
    solve,
    spline,
    spline_ipopt,
    spline_rosenbrock,
)
from ergowalk.solving.spline_rosenbrock import POWER
from ergowalk.solving.stages import Effort, OrderSearch
from ergowalk.transcription.halves import Orders
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.spline.semi_inverse import MEASURES
from ergowalk.transcription.walker import Smoothing

FIXED = preset("berbyuk2002-rhythm")
FEW = {"knots": 5, "max_evaluations": 6000}


def descend(**choices: Any) -> Solution:
    """Rosenbrock's method, stopped early."""
    options = SplineOptions(**{**FEW, **choices})
    return solve(FIXED, method="spline", solver="rosenbrock", spline=options)


@pytest.fixture(scope="module")
def descended() -> Solution:
    return descend()


@pytest.fixture(scope="module")
def climbed() -> Solution:
    """IPOPT on few knots, the measures of (19) alone."""
    return solve(FIXED, method="spline", spline=SplineOptions(knots=6, asked="paper"))


@pytest.fixture(params=["descended", "climbed"])
def either(request: pytest.FixtureRequest) -> Solution:
    found: Solution = request.getfixturevalue(request.param)
    return found


# --- choices -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("choice", "match"),
    [
        ({"knots": 3}, "knots = 3: must be a whole number from 4 to 200; give the knot intervals"),
        ({"knots": 12.5}, r"knots = 12\.5: must be a whole number"),
        ({"rho": -1e-9}, "rho = -1e-09: must be a finite number from 0 up; give the freedom"),
        ({"rho": float("nan")}, "rho = nan: must be a finite number"),
        ({"rho": float("inf")}, "rho = inf: must be a finite number"),
        ({"asked": "nothing"}, "asked = 'nothing': must be 'paper' or 'everything'; say which"),
        ({"max_evaluations": 0}, "max_evaluations = 0: must be 1 or more; give a number"),
    ],
)
def test_a_choice_that_is_none_is_refused(choice: dict[str, Any], match: str) -> None:
    with pytest.raises(ProblemError, match=match):
        SplineOptions(**choice)


def test_each_solver_has_its_defaults() -> None:
    descent, climb = (SplineOptions().settled(solver) for solver in ("rosenbrock", "ipopt"))
    assert (descent.knots, descent.asked, descent.extras) == (12, "paper", ())
    assert (climb.knots, climb.asked) == (30, "everything")
    assert climb.extras == ("heel_slope", "swing_foot", "force_toe")
    assert SplineOptions(knots=7, asked="paper").settled("ipopt").knots == 7


def test_rosenbrock_keeps_nothing_but_the_measures_of_19() -> None:
    with pytest.raises(ProblemError, match=r"asked = 'everything': is beyond .*; use asked 'paper"):
        descend(asked="everything")


def test_knots_grow_by_half_at_most() -> None:
    for knots in range(4, 120):
        steps = spline_ipopt.ladder(knots)
        assert steps[-1] == knots
        assert steps[0] == min(knots, 20)
        assert all(a < b <= 1.5 * a + 1 for a, b in itertools.pairwise(steps))


def test_the_rhythm_is_held_at_the_printed_one() -> None:
    assert spline.held_rhythm(FIXED) == PRINTED_RHYTHM
    free = preset("berbyuk2002")
    assert spline.held_rhythm(free) == PRINTED_RHYTHM
    late = free.replace(rhythm=free.rhythm.replace(order="flat-first"))
    assert spline.held_rhythm(late).order is PhaseOrder.FLAT_FIRST


# --- the answer --------------------------------------------------------------------------------


def test_the_answer_is_a_gait_like_any_other(either: Solution, tmp_path: Path) -> None:
    attributes = either.dataset.attrs
    assert attributes["method"] == "spline"
    assert either.rhythm == PRINTED_RHYTHM
    assert either.problem.replace(folder=None) == FIXED
    again = Solution.load(either.save(tmp_path / "gait.nc"))
    check_readable(again.dataset)
    assert [x.key for x in again.audit().failed] == [x.key for x in either.audit().failed]
    found = compare(again.dataset, human_of(again.dataset))
    assert len(found.signals) == 8


def test_what_the_transcription_gives_by_construction_holds(either: Solution) -> None:
    lines = {line.key: line for line in either.audit().lines}
    exact = (
        "equations_of_motion",
        "velocities",
        "accelerations",
        "no_impact",
        "feet_fixed",
        "joint_angles",
        "periodicity",
        "leg_symmetry",
        "energy",
        "joint_power",
        "work_energy",
        "phases",
        "rhythm_as_asked",
        "attributes",
        "finite",
    )
    broken = {key: lines[key].value for key in exact if not lines[key].accepted}
    assert broken == {}


def test_the_choices_are_stored(descended: Solution, climbed: Solution) -> None:
    names = ("solver", "knots", "rho", "asked")
    assert [descended.dataset.attrs[n] for n in names] == ["rosenbrock", 5, 1e-6, "paper"]
    assert [climbed.dataset.attrs[n] for n in names] == ["ipopt", 6, 1e-6, "paper"]
    assert descended.dataset.attrs["evaluations"] == 6000


def test_the_trace_is_that_of_the_penalised_energy(descended: Solution) -> None:
    """Q_1 = E + sum lambda (G / tolerance)^power at every point, and the last is the answer."""
    data = descended.dataset
    assert data["measure"].to_numpy().tolist() == list(MEASURES)
    measures, weights = data["trace_measure"], data["trace_weight"]
    share = measures / data["measure_tolerance"]
    penalised = data["trace_energy"] + (weights * share**POWER).sum("measure")
    np.testing.assert_allclose(data["trace_penalised"], penalised, rtol=1e-12)
    np.testing.assert_allclose(measures[-1], data["measure_value"], rtol=1e-12, atol=1e-15)
    assert float(data["trace_energy"][-1]) == pytest.approx(descended.energy_per_metre, rel=0.05)
    for name in ("trace_evaluations", "trace_round"):
        assert np.all(np.diff(data[name].to_numpy()) >= 0)
    lower = np.diff(data["trace_penalised"].to_numpy())
    same_round = np.diff(data["trace_round"].to_numpy()) == 0
    assert np.all(lower[same_round] <= 0)


def test_measures_above_their_tolerances_are_no_answer(descended: Solution) -> None:
    """Stopped early: the status says which, and no acceptable gait is claimed."""
    data = descended.dataset
    over = data["measure"][data["measure_value"] > data["measure_tolerance"]].to_numpy()
    assert len(over) > 0
    assert descended.acceptable is False
    assert descended.status.startswith("ran out of evaluations: above its tolerance is ")
    assert all(f"{name} (" in descended.status for name in over)
    assert [e.get("final") for e in descended.mesh_history] == [True]


def test_measures_within_their_tolerances_are_not_enough(climbed: Solution) -> None:
    """All that (19) asks for holds; what it does not ask for the audit reports all the same."""
    data = climbed.dataset
    assert np.all(data["measure_value"] <= data["measure_tolerance"])
    assert climbed.status.startswith("converged, E = ")
    assert "asked were the measures of (19) alone" in climbed.status
    failed = [line.key for line in climbed.audit().failed]
    assert {"moment_rate_limits", "center_of_pressure"} < set(failed)
    assert climbed.acceptable is False
    assert climbed.status.endswith(f"the audit rejects it: {', '.join(failed)}")


def test_the_check_takes_twice_the_samples_on_the_same_knots(climbed: Solution) -> None:
    final, finer = climbed.mesh_history
    assert final["final"] and finer["finer"]
    assert (final["knots"], finer["knots"]) == (6, 6)
    assert finer["elements"] == 2 * final["elements"] == 2 * 6 * final["points"]
    assert final["energy_per_metre"] == pytest.approx(climbed.energy_per_metre, rel=1e-12)


def test_the_same_problem_twice_gives_the_same_bytes(descended: Solution) -> None:
    one, two = descended.dataset, descend().dataset
    assert list(one.variables) == list(two.variables)
    for name in one.variables:
        first, second = one[name].to_numpy(), two[name].to_numpy()
        if first.dtype == object:
            assert first.tolist() == second.tolist()
        else:
            assert first.tobytes() == second.tobytes(), name
    clocks = {"solve_time", "build_time"}
    first, second = ({k: v for k, v in d.attrs.items() if k not in clocks} for d in (one, two))
    assert first == second


def test_a_free_rhythm_is_held_and_the_status_says_so() -> None:
    options = SplineOptions(knots=4, max_evaluations=50)
    answer = solve(preset("berbyuk2002"), method="spline", solver="rosenbrock", spline=options)
    assert answer.rhythm == PRINTED_RHYTHM
    assert "the problem leaves the rhythm free, this method holds it" in answer.status


def test_a_collocation_can_begin_with_it(climbed: Solution) -> None:
    """Less than a hundred iterations, which the human means need before the rhythm is free."""

    def search(
        problem: GaitProblem, orders: Orders, store: KernelStore | None = None
    ) -> OrderSearch:
        return OrderSearch(problem, orders, Smoothing(), Effort(), None, store)

    found = collocation._begin(search, FIXED, climbed)
    assert found is not None
    assert found.result.minimum.converged
    assert found.result.minimum.iterations < 100


# --- parts -------------------------------------------------------------------------------------


def test_progress_is_told_and_an_interrupt_ends_the_search() -> None:
    told: list[Progress] = []

    def interrupt(line: Progress) -> None:
        told.append(line)
        if len(told) == 3:
            raise KeyboardInterrupt("enough")

    with pytest.raises(KeyboardInterrupt, match="enough"):
        solve(
            FIXED,
            method="spline",
            solver="rosenbrock",
            spline=SplineOptions(knots=4),
            progress=interrupt,
        )
    assert [line.iteration for line in told] == [1, 2, 3]
    assert {line.stage for line in told} == {spline_rosenbrock.COARSE.name}
    assert all(np.isfinite(line.energy_per_metre) and line.violation >= 0 for line in told)


def test_the_history_is_json(either: Solution) -> None:
    assert json.loads(either.dataset.attrs["mesh_history"]) == either.mesh_history
