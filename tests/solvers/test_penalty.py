"""The exterior penalty drives every block below its tolerance, at the known answers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from ergowalk.errors import InputError
from ergowalk.solvers.blocks import BlockedFunction, blocked
from ergowalk.solvers.penalty import ExteriorPenalty
from ergowalk.solvers.penalty_answer import PenaltyPoint
from ergowalk.solvers.rosenbrock import Rosenbrock, RosenbrockLineSearch

from .classics import (
    HS71_POINT,
    HS71_START,
    PROGRAMMES,
    Array,
    Known,
    corner_of_a_polygon,
    hock_schittkowski_12,
    hock_schittkowski_43,
    hock_schittkowski_71,
    line_past_a_circle,
)

INNER = (Rosenbrock(), RosenbrockLineSearch())
each_inner = pytest.mark.parametrize("inner", INNER, ids=lambda m: type(m).__name__)
each_programme = pytest.mark.parametrize("case", PROGRAMMES, ids=repr)


def two_walls(x: Array) -> tuple[float, Array]:
    """Minimise (x - 3)^2 + (y - 3)^2, x <= 1, y <= 2: multipliers 4 and 2."""
    return float(np.sum((x - 3.0) ** 2)), np.maximum(x - [1.0, 2.0], 0.0)


WALLS = BlockedFunction(("left", "right"), two_walls, np.array([1e-4, 1e-4]))


# --- known answers


@each_inner
@each_programme
def test_known_answers_are_found_with_squared_measures(inner: Any, case: Known) -> None:
    """A violation G <= 1e-5 is worth up to multiplier times 1e-5: largest error 2.5e-5 (HS43)."""
    function = blocked(case.problem(), tolerances=1e-5)
    found = ExteriorPenalty(inner=inner, power=2).minimise(function, case.start)
    assert found.converged and found.accepted
    assert found.message == "converged: every measure is within its tolerance"
    assert max(found.measures.values()) <= 1e-5
    assert found.objective == pytest.approx(case.minimum, abs=3e-5)
    np.testing.assert_allclose(found.x, case.point, atol=6e-3)


@each_inner
@each_programme
def test_known_answers_are_found_with_squared_rows(inner: Any, case: Known) -> None:
    function = blocked(case.problem(), tolerances=1e-10, power=2)
    found = ExteriorPenalty(inner=inner).minimise(function, case.start)
    assert found.converged
    assert max(found.measures.values()) <= 1e-10
    assert found.objective == pytest.approx(case.minimum, abs=3e-5)


def test_an_exact_penalty_needs_weights_above_the_multipliers_only() -> None:
    found = ExteriorPenalty(weights=5.0).minimise(WALLS, np.zeros(2))
    assert found.converged and found.rounds == 1
    assert found.weights == {"left": 5.0, "right": 5.0}
    np.testing.assert_allclose(found.x, [1.0, 2.0], atol=1e-6)
    assert found.objective == pytest.approx(5.0, abs=1e-5)


def test_kinks_stop_rosenbrocks_method_where_squares_do_not() -> None:
    """The limit of the method that the paper names; figures in ExteriorPenalty."""
    case = next(case for case in PROGRAMMES if case.name == "HS43")
    function = blocked(hock_schittkowski_43(), tolerances=1e-5)
    errors = [
        ExteriorPenalty(power=power).minimise(function, case.start).objective - case.minimum
        for power in (1, 2)
    ]
    assert errors[0] > 100 * abs(errors[1])


def test_another_inner_method_will_do() -> None:
    class NelderMead:
        def minimise(
            self, function: Any, start: Array, steps: Any = None, monitor: Any = None
        ) -> Any:
            found = minimize(function, start, method="Nelder-Mead", options={"fatol": 1e-10})
            return type("Answer", (), {"x": found.x, "converged": found.success})

    found = ExteriorPenalty(inner=NelderMead(), power=2).minimise(WALLS, np.zeros(2))
    assert found.converged
    np.testing.assert_allclose(found.x, [1.0, 2.0], atol=1e-3)


# --- laws of the outer loop


@each_inner
@settings(max_examples=25)
@given(
    weights=st.tuples(st.floats(0.1, 10.0), st.floats(0.1, 10.0)),
    growth=st.tuples(st.floats(1.5, 20.0), st.floats(1.5, 20.0)),
)
def test_weights_never_fall_and_grow_only_where_a_measure_is_too_large(
    inner: Any, weights: tuple[float, float], growth: tuple[float, float]
) -> None:
    names = WALLS.names
    found = ExteriorPenalty(
        inner=inner,
        weights=dict(zip(names, weights, strict=True)),
        growth=dict(zip(names, growth, strict=True)),
        power=2,
        max_rounds=6,
    ).minimise(WALLS, np.zeros(2))
    trace = found.trace
    assert np.all(np.diff(trace.weights, axis=0) >= 0.0)
    np.testing.assert_array_equal(trace.weights[0], weights)
    ends = np.flatnonzero(trace.ends_round)
    assert np.all(np.diff(trace.weights, axis=0)[np.setdiff1d(np.arange(ends[-1]), ends)] == 0.0)
    for end in ends[:-1]:
        over = trace.measures[end] > WALLS.tolerances
        expected = np.where(over, trace.weights[end] * growth, trace.weights[end])
        np.testing.assert_array_equal(trace.weights[end + 1], expected)


@each_inner
def test_heavier_weights_trade_objective_for_measures(inner: Any) -> None:
    """Of the minima of Q + lambda G, Q never falls and G never rises with lambda."""
    function = blocked(hock_schittkowski_12(), tolerances=1e-6)
    trace = ExteriorPenalty(inner=inner, power=2).minimise(function, np.zeros(2)).trace
    ends = trace.ends_round
    assert ends.sum() > 5
    assert np.all(np.diff(trace.objective[ends]) > -1e-4)
    assert np.all(np.diff(trace.measures[ends, 0]) <= 0.0)
    assert trace.measures[ends, 0][-1] < 1e-5 * trace.measures[ends, 0][0]


@each_inner
@pytest.mark.parametrize("power", [1, 2])
def test_the_trace_adds_up(inner: Any, power: int) -> None:
    """Q_1 = Q + sum lambda G^power at each point, and falls within a round."""
    points: list[PenaltyPoint] = []
    function = blocked(hock_schittkowski_71(), tolerances=1e-5)
    loop = ExteriorPenalty(inner=inner, power=power, max_rounds=3)
    found = loop.minimise(function, HS71_START, monitor=points.append)
    trace = found.trace
    total = trace.objective + np.sum(trace.weights * trace.measures**power, axis=1)
    np.testing.assert_allclose(trace.penalised, total, rtol=1e-13)
    for number in range(1, found.rounds + 1):
        assert np.all(np.diff(trace.penalised[trace.round == number]) <= 0.0)
    assert trace.ends_round.sum() == found.rounds
    assert np.all(np.diff(trace.evaluations) >= 0) and np.all(np.diff(trace.seconds) >= 0.0)
    assert trace.evaluations[-1] == found.evaluations
    assert trace.names == function.names
    assert len(points) == len(trace.round)
    for point, penalised in zip(points, trace.penalised, strict=True):
        objective, measures = function.evaluate(point.x)
        assert point.penalised == penalised
        assert point.objective == objective
        np.testing.assert_array_equal(point.measures, measures)


def test_each_round_starts_afresh_with_smaller_steps_from_the_last_point() -> None:
    seen: list[tuple[Array, Array]] = []

    class Spy(Rosenbrock):
        def minimise(self, function: Any, start: Array, steps: Any = None, **rest: Any) -> Any:
            seen.append((start, steps))
            return super().minimise(function, start, steps, **rest)

    loop = ExteriorPenalty(inner=Spy(), weights=0.01, power=2, shrink=0.5, smallest_steps=0.2)
    trace = loop.minimise(WALLS, np.zeros(2), np.array([0.4, 0.8])).trace
    parts = [1.0, 0.5, 0.25, 0.2, 0.2]
    for part, (_, steps) in zip(parts, seen, strict=False):
        np.testing.assert_allclose(steps, [0.4 * part, 0.8 * part], rtol=1e-15)
    ends = trace.objective[trace.ends_round][:-1]
    assert [two_walls(start)[0] for start, _ in seen[1:]] == ends.tolist()
    assert len(seen) > len(parts)


def test_the_same_start_gives_the_same_answer_to_the_last_bit() -> None:
    runs = [ExteriorPenalty(power=2).minimise(WALLS, np.zeros(2)) for _ in range(2)]
    assert runs[0].x.tobytes() == runs[1].x.tobytes()
    assert runs[0].trace.penalised.tobytes() == runs[1].trace.penalised.tobytes()


def test_the_weights_of_an_answer_start_a_closer_search() -> None:
    coarse = ExteriorPenalty(inner=Rosenbrock(progress_tolerance=1e-2), power=2)
    rough = coarse.minimise(WALLS, np.zeros(2))
    fine = ExteriorPenalty(power=2, weights=rough.weights).minimise(WALLS, rough.x, 0.01)
    assert rough.converged and fine.converged
    assert fine.rounds < rough.rounds / 2
    exact = 5.0
    assert abs(fine.objective - exact) < abs(rough.objective - exact)


# --- limits


def test_the_limit_of_evaluations_is_exact_and_told() -> None:
    calls: list[Array] = []

    def counted(x: Array) -> tuple[float, Array]:
        calls.append(x)
        return two_walls(x)

    function = BlockedFunction(WALLS.names, counted, WALLS.tolerances)
    found = ExteriorPenalty(max_evaluations=25, weights=0.1).minimise(function, np.zeros(2))
    assert found.evaluations == len(calls) == 25
    assert not found.accepted and not found.converged
    assert found.message.startswith("ran out of evaluations: above its tolerance is left (")
    assert found.trace.penalised[-1] < found.trace.penalised[0]


def test_the_limit_of_time_is_told() -> None:
    found = ExteriorPenalty(max_seconds=0.0).minimise(WALLS, np.full(2, 4.0))
    assert not found.converged
    assert found.message.startswith("ran out of CPU seconds: above its tolerance is left (3 > 0.")
    assert found.evaluations == 1


@each_inner
def test_constraints_that_contradict_each_other_are_told_by_name(inner: Any) -> None:
    found = ExteriorPenalty(inner=inner, max_rounds=5, power=2).minimise(
        blocked(line_past_a_circle()), np.ones(2)
    )
    assert not found.accepted
    assert found.rounds == 5
    assert found.message.startswith("ran out of rounds: above its tolerance is row 0 (")
    assert "row 1 (" in found.message


def test_an_accepted_round_is_kept_when_time_runs_out_in_a_later_one() -> None:
    """Rounds go on while the inner method has not converged."""
    impatient = Rosenbrock(max_evaluations=60)
    found = ExteriorPenalty(inner=impatient, weights=10.0, max_rounds=2).minimise(
        WALLS, np.zeros(2)
    )
    assert found.accepted and not found.converged
    assert found.message == "ran out of rounds: every measure is within its tolerance"
    assert max(found.measures.values()) <= 1e-4


def test_no_value_anywhere_is_told() -> None:
    nowhere = BlockedFunction(("a",), lambda x: (math.nan, np.zeros(1)), np.ones(1))
    found = ExteriorPenalty(max_rounds=2).minimise(nowhere, np.zeros(2))
    assert not found.accepted
    assert found.message == "ran out of rounds: the function has no finite value near the start"


@pytest.mark.parametrize("error", [KeyboardInterrupt(), BrokenPipeError("reader is gone")])
def test_what_the_monitor_raises_comes_through(error: BaseException) -> None:
    def raising(point: PenaltyPoint) -> None:
        if point.round == 2:
            raise error

    with pytest.raises(type(error)) as caught:
        ExteriorPenalty(weights=0.1).minimise(WALLS, np.zeros(2), monitor=raising)
    assert caught.value is error


# --- programmes as blocks


def test_rows_are_grouped_by_label_and_bounds_come_last() -> None:
    function = blocked(hock_schittkowski_71())
    assert function.names == ("row 0", "row 1", "variable bounds")
    assert blocked(hock_schittkowski_43()).names == ("row 0", "row 1", "row 2")
    objective, measures = function.evaluate(np.array([0.5, 6.0, 5.0, 1.0]))
    assert objective == pytest.approx(0.5 * 1.0 * 11.5 + 5.0)
    np.testing.assert_allclose(measures, [25.0 - 15.0, 62.25 - 40.0, 0.5 + 1.0])


def test_both_sides_of_an_equality_count() -> None:
    function = blocked(hock_schittkowski_71(), power=2)
    for radius in (39.0, 41.0):
        x = HS71_POINT * np.sqrt(radius / np.sum(HS71_POINT**2))
        assert function.evaluate(x)[1][1] == pytest.approx(1.0)


@given(st.lists(st.floats(-10.0, 30.0), min_size=2, max_size=2))
def test_measures_vanish_exactly_where_all_constraints_hold(point: list[float]) -> None:
    x, y = point
    inside = 0 <= x <= 4 and y >= 0 and 2 * y <= 12 and 3 * x + 2 * y <= 18
    measures = blocked(corner_of_a_polygon()).evaluate(np.array(point))[1]
    assert np.all(measures >= 0.0)
    assert (not measures.any()) == inside


# --- refusals


def penalty_of(**options: Any) -> Any:
    return lambda: ExteriorPenalty(**options).minimise(WALLS, np.zeros(2))


def blocks_of(names: tuple[str, ...], tolerances: Any) -> Any:
    return lambda: BlockedFunction(names, two_walls, tolerances)


def answering(measures: Any) -> Any:
    function = BlockedFunction(("a", "b"), lambda x: (0.0, measures), np.ones(2))
    return lambda: ExteriorPenalty().minimise(function, np.zeros(2))


REFUSALS: Mapping[str, Any] = {
    r"weights = \[0.0, 0.0\]: must be finite and above 0; give such": penalty_of(weights=0.0),
    r"growth = \[1.0, 1.0\]: must be finite and above 1; give such": penalty_of(growth=1.0),
    r"weights = \['left'\]: must name each of left, right and nothing else; look at right": (
        penalty_of(weights={"left": 1.0})
    ),
    r"growth = .*'up'\]: must name each of left, right and nothing else; look at up": (
        penalty_of(growth={"left": 2.0, "right": 2.0, "up": 2.0})
    ),
    r"power = 3: must lie between 1 and 2; give such a number": penalty_of(power=3),
    r"shrink = 0.0: must lie between 1e-06 and 1": penalty_of(shrink=0.0),
    r"max_rounds = 0: must lie between 1 and inf": penalty_of(max_rounds=0),
    r"max_seconds = nan: must lie between 0 and inf": penalty_of(max_seconds=math.nan),
    r"start = .*nan.*: must be a non-empty vector of finite numbers; give a start": (
        lambda: ExteriorPenalty().minimise(WALLS, np.array([math.nan, 0.0]))
    ),
    r"steps = .*: must be one positive number or 2 of them; give the starting step": (
        lambda: ExteriorPenalty().minimise(WALLS, np.zeros(2), np.ones(3))
    ),
    r"names = \('a', 'a'\): must differ; give each block its own name": (
        blocks_of(("a", "a"), np.ones(2))
    ),
    r"tolerances = .*: must be 2 finite numbers that are not negative; give the tolerance": (
        blocks_of(("a", "b"), np.ones(3))
    ),
    r"tolerances = .*-1.*: must be 2 finite numbers that are not negative": (
        blocks_of(("a", "b"), np.array([1.0, -1.0]))
    ),
    r"measures = .*: must be 2 numbers that are not negative; return one measure": (
        answering(np.zeros(3))
    ),
    r"measures = .*-1.*: must be 2 numbers that are not negative": answering([-1.0, 0.0]),
    r"power = 0: must be 1 or 2; choose one of them": (
        lambda: blocked(hock_schittkowski_12(), power=0)
    ),
    r"tolerances = \['x'\]: must name each of row 0 and nothing else; look at row 0, x": (
        lambda: blocked(hock_schittkowski_12(), {"x": 1.0})
    ),
}


@pytest.mark.parametrize("message", REFUSALS, ids=range(len(REFUSALS)))
def test_unusable_input_is_refused(message: str) -> None:
    with pytest.raises(InputError, match=message):
        REFUSALS[message]()
