"""Both forms of Rosenbrock's method find the known minima, by directions that stay orthonormal."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import ortho_group

from ergowalk.errors import InputError
from ergowalk.solvers.descent import Stage
from ergowalk.solvers.rosenbrock import Rosenbrock, RosenbrockLineSearch
from ergowalk.solvers.rotation import rotate

from .classics import FUNCTIONS, Array, Known, beale, valleys

METHODS = (Rosenbrock(), Rosenbrock(reset_steps=True), RosenbrockLineSearch())
START = np.array([-1.2, 1.0])


def method_name(method: Any) -> str:
    return type(method).__name__ + ("-textbook" if method.reset_steps else "")


each_method = pytest.mark.parametrize("method", METHODS, ids=method_name)
each_function = pytest.mark.parametrize("case", FUNCTIONS, ids=repr)


def bowl(n: int, condition: float, seed: int = 0) -> tuple[Any, Array]:
    """A quadratic in turned axes, and its minimum."""
    turn = ortho_group.rvs(n, random_state=seed)
    hessian = turn * np.geomspace(1.0, condition, n) @ turn.T
    lowest = np.linspace(-1.0, 1.0, n)
    return lambda x: float((x - lowest) @ hessian @ (x - lowest)), lowest


# --- known answers


@each_method
@each_function
def test_known_minima_are_found(method: Any, case: Known) -> None:
    """Largest error of the value 1.1e-12 (Powell's singular function, textbook form)."""
    found = method.minimise(case.problem, case.start)
    assert found.converged
    assert found.message == "converged: a stage brought less than the tolerances"
    assert found.objective == pytest.approx(case.minimum, abs=2e-12)
    assert found.objective == case.problem(found.x)
    # a fourth power hides errors of the fourth root of that
    place = 2e-3 if case.name == "powell singular" else 1e-6
    np.testing.assert_allclose(found.x, case.point, atol=place)


@pytest.mark.parametrize("method", [METHODS[0], METHODS[2]], ids=method_name)
def test_an_ill_conditioned_bowl_of_sixty_variables_is_within_reach(method: Any) -> None:
    function, lowest = bowl(60, 1e3)
    found = method.minimise(function, np.zeros(60))
    assert found.objective < 1e-12
    np.testing.assert_allclose(found.x, lowest, atol=1e-6)
    assert found.evaluations <= 100_000


def test_progress_as_the_next_steps_saves_half_of_the_textbooks_evaluations() -> None:
    saving = {
        case.name: Rosenbrock().minimise(case.problem, case.start).evaluations
        / Rosenbrock(reset_steps=True).minimise(case.problem, case.start).evaluations
        for case in FUNCTIONS
    }
    assert math.prod(saving.values()) ** (1 / len(saving)) < 0.5


@pytest.mark.parametrize("n", [2, 3, 5])
def test_line_searches_along_the_axes_of_a_bowl_need_one_stage(n: int) -> None:
    """Each line search is a parabola's; further stages find nothing above rounding."""
    weights = np.arange(1.0, n + 1.0)
    method = RosenbrockLineSearch(line_tolerance=1e-9)
    stages: list[Stage] = []
    method.minimise(lambda x: float(weights @ (x - 1.0) ** 2), np.zeros(n), 0.1, stages.append)
    assert stages[0].objective == pytest.approx(weights.sum())
    assert stages[1].objective < 1e-14


@pytest.mark.parametrize(("method", "most"), [(METHODS[0], 12), (METHODS[2], 6)])
def test_a_bowl_in_turned_axes_needs_few_stages(method: Any, most: int) -> None:
    """Measured: 10 stages of discrete steps and 5 of line searches from 19 to 1e-10."""
    function, _ = bowl(2, 10.0)
    stages: list[Stage] = []
    method.minimise(function, np.zeros(2), 0.1, stages.append)
    assert stages[0].objective > 10.0
    assert next(stage.number for stage in stages if stage.objective < 1e-10) <= most


# --- directions

progress_vectors = st.integers(1, 12).flatmap(
    lambda n: arrays(
        float,
        n,
        elements=st.one_of(
            st.just(0.0), st.floats(-1e3, 1e3), st.floats(-1e-9, 1e-9), st.just(1e-300)
        ),
    )
)


@given(st.lists(progress_vectors, min_size=1, max_size=6), st.integers(0, 2**32 - 1))
def test_directions_stay_orthonormal(vectors: list[Array], seed: int) -> None:
    n = len(vectors[0])
    directions = np.linalg.qr(np.random.default_rng(seed).normal(size=(n, n)))[0]
    for vector in vectors:
        directions = rotate(directions, np.resize(vector, n)).directions
        np.testing.assert_allclose(directions @ directions.T, np.eye(n), rtol=0, atol=1e-12)


@given(progress_vectors)
def test_the_first_direction_is_the_total_progress(progress: Array) -> None:
    rotation = rotate(np.eye(len(progress)), progress)
    length = np.linalg.norm(progress)
    if length > 0.0:
        np.testing.assert_allclose(rotation.directions[0] * length, progress, atol=1e-12 * length)
    assert rotation.lengths[0] == pytest.approx(length, rel=1e-12)
    assert np.all(np.diff(rotation.lengths) <= 1e-12 * length)


@given(arrays(float, 5, elements=st.floats(0.1, 10.0)), st.integers(0, 31))
def test_palmers_form_is_gram_and_schmidts(sizes: Array, signs: int) -> None:
    progress = sizes * np.where([signs >> i & 1 for i in range(5)], 1.0, -1.0)
    old = ortho_group.rvs(5, random_state=3)
    rotation = rotate(old, progress)
    terms = (progress[:, None] * old)[rotation.order]
    tails = np.array([terms[i:].sum(axis=0) for i in range(5)])
    triangular = np.linalg.qr(tails.T)
    expected = (triangular.Q * np.sign(np.diag(triangular.R))).T
    agree = np.sum(expected * rotation.directions, axis=1)
    np.testing.assert_allclose(np.abs(agree), 1.0, atol=1e-10)
    np.testing.assert_allclose(agree[0], 1.0, atol=1e-10)


def test_directions_without_progress_stay() -> None:
    old = ortho_group.rvs(4, random_state=1)
    rotation = rotate(old, np.array([0.0, 2.0, 0.0, -1.0]))
    np.testing.assert_array_equal(rotation.directions[2:], old[[0, 2]])
    np.testing.assert_array_equal(rotation.order, [1, 3, 0, 2])
    np.testing.assert_array_equal(rotate(old, np.zeros(4)).directions, old)


def test_ten_thousand_rotations_leave_the_directions_orthonormal() -> None:
    random = np.random.default_rng(0)
    directions = np.eye(6)
    for progress in random.normal(size=(10_000, 6)) * 10.0 ** random.uniform(-6, 0, (10_000, 6)):
        directions = rotate(directions, progress).directions
    np.testing.assert_allclose(directions @ directions.T, np.eye(6), rtol=0, atol=1e-12)


# --- laws of a run


@each_method
@each_function
def test_the_objective_never_rises(method: Any, case: Known) -> None:
    found = method.minimise(case.problem, case.start)
    assert np.all(np.diff(found.trace.objective) <= 0.0)
    assert np.all(np.diff(found.trace.evaluations) > 0)
    assert np.all(np.diff(found.trace.seconds) >= 0.0)
    assert found.trace.objective[0] == case.problem(case.start)
    assert found.trace.objective[-1] == found.objective
    assert found.trace.evaluations[-1] == found.evaluations


@each_method
def test_evaluations_are_counted_and_the_best_point_is_kept(method: Any) -> None:
    seen: list[tuple[float, Array]] = []

    def function(x: Array) -> float:
        seen.append((beale(x), x))
        return seen[-1][0]

    found = method.minimise(function, np.ones(2))
    assert found.evaluations == len(seen)
    assert found.objective == min(value for value, _ in seen)
    assert any(x is found.x for _, x in seen)
    assert len({id(x) for _, x in seen}) == len(seen)  # an array of its own each time


@each_method
def test_the_same_start_gives_the_same_answer_to_the_last_bit(method: Any) -> None:
    first, second = (method.minimise(valleys, START) for _ in range(2))
    assert first.x.tobytes() == second.x.tobytes()
    assert first.evaluations == second.evaluations


@each_method
@settings(max_examples=25)
@given(powers=st.tuples(st.integers(-20, 20), st.integers(-20, 20)))
def test_other_units_take_the_same_path_to_the_last_bit(
    method: Any, powers: tuple[int, int]
) -> None:
    """Powers of two, which rounding commutes with."""
    unit = np.exp2(np.array(powers))
    plain = method.minimise(valleys, START, 0.125)
    scaled = method.minimise(lambda x: valleys(x / unit), START * unit, 0.125 * unit)
    np.testing.assert_array_equal(scaled.x, plain.x * unit)
    np.testing.assert_array_equal(scaled.trace.objective, plain.trace.objective)


@each_method
@settings(max_examples=25)
@given(shift=arrays(float, 2, elements=st.integers(-8, 8)))
def test_another_origin_takes_the_same_path(method: Any, shift: Array) -> None:
    """For sixty evaluations, to rounding, which later turns a comparison somewhere."""

    def path(origin: Array) -> list[float]:
        values: list[float] = []

        def function(x: Array) -> float:
            values.append(valleys(x - origin))
            return values[-1]

        replace(method, max_evaluations=60).minimise(function, START + origin, 0.125)
        return values

    assert len(path(shift)) == 60
    np.testing.assert_allclose(path(shift), path(np.zeros(2)), rtol=1e-9, atol=1e-9)


@each_method
@pytest.mark.parametrize("order", [(1, 0), (0, 1)])
def test_mirrored_axes_are_searched_as_well(method: Any, order: tuple[int, int]) -> None:
    """Only the axes of the start are special: mirrored and exchanged, the minimum is found."""
    turned = method.minimise(lambda x: beale(-x[list(order)]), -np.ones(2))
    np.testing.assert_allclose(-turned.x[list(order)], [3.0, 0.5], atol=1e-6)


@each_method
@pytest.mark.parametrize("angle", [0.1, 0.7, 2.0])
def test_turned_axes_lead_to_the_same_minimum(method: Any, angle: float) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    found = method.minimise(lambda x: valleys(turn @ x), turn.T @ START)
    np.testing.assert_allclose(turn @ found.x, [1.0, 1.0], atol=1e-6)


# --- functions that are not numbers everywhere


@each_method
@pytest.mark.parametrize("hole", [math.nan, math.inf, -math.inf])
def test_values_that_are_no_numbers_are_failures(method: Any, hole: float) -> None:
    found = method.minimise(lambda x: hole if x[0] > 1.5 else valleys(x), START)
    assert found.converged
    assert found.objective < 1e-12


@each_method
def test_a_start_without_a_value_is_left_if_one_is_near(method: Any) -> None:
    found = method.minimise(lambda x: math.nan if x[0] < -1.15 else valleys(x), START)
    assert found.objective < 1e-12


@each_method
def test_no_value_near_the_start_is_told_in_a_sentence(method: Any) -> None:
    found = method.minimise(lambda x: math.nan, START)
    assert not found.converged
    assert found.message == "the function has no finite value near the start"
    np.testing.assert_array_equal(found.x, START)


@each_method
def test_a_constant_is_at_its_minimum_everywhere(method: Any) -> None:
    found = method.minimise(lambda x: 7.0, START)
    assert found.converged and found.objective == 7.0 and found.restarts == 0
    np.testing.assert_array_equal(found.x, START)


@each_method
def test_a_variable_without_influence_does_not_hold_the_others_up(method: Any) -> None:
    found = method.minimise(lambda x: valleys(x[:2]), np.array([-1.2, 1.0, 5.0]))
    assert found.converged
    assert found.objective < 1e-12


@each_method
def test_a_function_without_a_minimum_ends_by_its_limits(method: Any) -> None:
    found = method.minimise(lambda x: float(x[0]), np.zeros(2))
    assert found.objective < -1e300
    assert np.all(np.isfinite(found.x))


# --- stopping


@each_method
def test_the_limit_of_evaluations_is_exact_and_told(method: Any) -> None:
    short = type(method)(max_evaluations=37)
    found = short.minimise(valleys, START)
    assert (found.evaluations, found.converged) == (37, False)
    assert found.message == "ran out of evaluations"
    assert found.trace.evaluations[-1] == 37
    assert found.trace.objective[-1] == found.objective < valleys(START)


@each_method
def test_the_limit_of_time_is_told(method: Any) -> None:
    found = type(method)(max_seconds=0.0).minimise(valleys, START)
    assert not found.converged
    assert found.message == "ran out of CPU seconds"
    assert found.evaluations == 1


@each_method
def test_a_target_ends_the_search(method: Any) -> None:
    found = method.minimise(valleys, START, target=1e-3)
    assert found.converged
    assert found.message == "reached the target"
    assert found.objective <= 1e-3
    assert found.evaluations < method.minimise(valleys, START).evaluations


@each_method
def test_a_looser_tolerance_stops_earlier(method: Any) -> None:
    loose = type(method)(progress_tolerance=0.1).minimise(lambda x: 1.0 + valleys(x), START)
    tight = type(method)().minimise(lambda x: 1.0 + valleys(x), START)
    assert loose.converged and tight.converged
    assert loose.evaluations < tight.evaluations
    assert tight.objective < loose.objective


def test_a_restart_is_tried_and_not_repeated_in_vain() -> None:
    counts = [Rosenbrock(restarts=k).minimise(valleys, START).restarts for k in (0, 1, 50)]
    assert counts[:2] == [0, 1]
    assert 1 <= counts[2] < 10


@pytest.mark.parametrize("form", [Rosenbrock, RosenbrockLineSearch])
def test_restarts_leave_directions_that_have_collapsed_at_kinks(form: Any) -> None:
    """Measured: 42 becomes 18 with discrete steps, 15 becomes 0.3 with line searches."""

    def chain(x: Array) -> float:
        return float(100 * np.abs(np.diff(x)).sum() + np.sum((x - 1) ** 2))

    start = 0.3 * np.arange(16)
    none, three = (form(restarts=k).minimise(chain, start).objective for k in (0, 3))
    assert three < none / 2


# --- monitor, interruptions, refusals


@each_method
def test_the_monitor_sees_every_stage(method: Any) -> None:
    stages: list[Stage] = []
    found = method.minimise(valleys, START, monitor=stages.append)
    assert [stage.number for stage in stages] == list(range(found.stages))
    assert [stage.objective for stage in stages] == found.trace.objective[:-1].tolist()
    assert all(valleys(stage.x) == stage.objective for stage in stages)
    assert found.rotations + found.restarts == found.stages - 1


@each_method
@pytest.mark.parametrize("error", [KeyboardInterrupt(), BrokenPipeError("reader is gone")])
def test_what_monitor_or_function_raise_comes_through(method: Any, error: BaseException) -> None:
    def raising(at: Any) -> float:
        if not isinstance(at, Stage) or at.number == 2:
            raise error
        return 0.0

    with pytest.raises(type(error)) as caught:
        method.minimise(valleys, START, monitor=raising)
    assert caught.value is error
    with pytest.raises(type(error)) as caught:
        method.minimise(raising, START)
    assert caught.value is error


@each_method
@pytest.mark.parametrize(
    ("start", "steps", "message"),
    [
        ([[1.0]], None, "start = .*: must be a non-empty vector of finite numbers; give a start"),
        ([], None, "start = .*: must be a non-empty vector"),
        ([1.0, math.nan], None, "start = .*nan.*: must be a non-empty vector of finite numbers"),
        ([1.0, 1.0], 0.0, "steps = .*0.*: must be one positive number or 2 of them; give the"),
        ([1.0, 1.0], [1.0, -1.0], "steps = .*-1.*: must be one positive number or 2 of them"),
        ([1.0, 1.0], [1.0] * 3, "steps = .*: must be one positive number or 2 of them"),
        ([1.0, 1.0], math.inf, "steps = .*inf.*: must be one positive number or 2 of them"),
    ],
)
def test_unusable_starts_are_refused(method: Any, start: Any, steps: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        method.minimise(valleys, start, steps)


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"step": 0.0}, "step = 0.0: must be a finite number from 1e-300 up; give such a number"),
        ({"step_tolerance": 0.0}, "step_tolerance = 0.0: must be a finite number from 1e-15 up"),
        ({"progress_tolerance": -1.0}, "progress_tolerance = -1.0: must be a finite number from 0"),
        ({"restarts": -1}, "restarts = -1: must be a finite number from 0 up"),
        ({"max_evaluations": 0}, "max_evaluations = 0: must be a finite number from 1 up"),
        ({"max_seconds": math.nan}, "max_seconds = nan: must be a finite number from 0 up"),
        ({"expansion": 0.5}, "expansion = 0.5: must be a finite number from 1"),
    ],
)
def test_unusable_options_are_refused(option: dict[str, Any], message: str) -> None:
    for form in (Rosenbrock, RosenbrockLineSearch):
        with pytest.raises(InputError, match=message):
            form(**option)


@pytest.mark.parametrize("value", [0.0, 1.0, math.nan])
def test_a_contraction_must_contract(value: float) -> None:
    with pytest.raises(InputError, match=r"contraction = .*: must lie above 0 and below 1"):
        Rosenbrock(contraction=value)
    with pytest.raises(InputError, match=r"line_tolerance = .*: must lie above 0 and below 1"):
        RosenbrockLineSearch(line_tolerance=value)
