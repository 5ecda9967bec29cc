"""IPOPT finds the known answers of classical problems, and says so when it finds none."""

from __future__ import annotations

import os
import signal
import threading

import casadi as ca
import numpy as np
import pytest

from ergowalk.solvers.ipopt import Ipopt

from .classics import (
    HS71_MINIMUM,
    HS71_MULTIPLIERS,
    HS71_POINT,
    HS71_START,
    ROSENBROCK_START,
    corner_of_a_polygon,
    hock_schittkowski_71,
    line_past_a_circle,
    rosenbrock_valley,
    single_block,
)


def test_rosenbrocks_valley_is_walked_to_its_end() -> None:
    found = Ipopt().minimise(rosenbrock_valley(), ROSENBROCK_START)
    assert found.converged
    assert found.message == "converged"
    np.testing.assert_allclose(found.x, [1.0, 1.0], atol=1e-7)
    assert found.objective == pytest.approx(0.0, abs=1e-12)
    assert found.violation == 0.0


def test_hock_schittkowski_71_has_its_printed_answer() -> None:
    found = Ipopt().minimise(hock_schittkowski_71(), HS71_START)
    assert found.converged
    assert found.objective == pytest.approx(HS71_MINIMUM, abs=1e-6)
    np.testing.assert_allclose(found.x, HS71_POINT, atol=1e-6)
    np.testing.assert_allclose(found.row_multipliers, HS71_MULTIPLIERS, atol=1e-5)
    assert found.violation < 1e-7


def test_a_linear_programme_ends_in_its_corner() -> None:
    found = Ipopt().minimise(corner_of_a_polygon(), np.ones(2))
    assert found.converged
    np.testing.assert_allclose(found.x, [2.0, 6.0], atol=1e-6)
    assert found.objective == pytest.approx(-36.0, abs=1e-6)
    np.testing.assert_allclose(found.row_multipliers, [1.5, 1.0], atol=1e-6)  # shadow prices


def test_multipliers_balance_the_gradient() -> None:
    """Karush, Kuhn and Tucker: gradient + Jacobian^T row multipliers + bound multipliers = 0."""
    programme = hock_schittkowski_71()
    found = Ipopt().minimise(programme, HS71_START)
    gradient = np.asarray(programme.oracle.gradient(found.x, [])[1]).ravel()
    jacobian = np.asarray(programme.oracle.jacobian(found.x, [])[1])
    rest = gradient + jacobian.T @ found.row_multipliers + found.variable_multipliers
    np.testing.assert_allclose(rest, 0.0, atol=1e-6)


def test_multipliers_near_the_answer_save_iterations() -> None:
    programme = hock_schittkowski_71()
    cold = Ipopt().minimise(programme, HS71_START)
    close = Ipopt(strategy="monotone", barrier_start=1e-7, push=1e-8)
    warm = close.minimise(
        programme, cold.x, multipliers=(cold.variable_multipliers, cold.row_multipliers)
    )
    assert warm.converged
    assert warm.iterations < cold.iterations / 2
    np.testing.assert_allclose(warm.x, cold.x, atol=1e-6)


def test_a_problem_without_a_point_is_told_in_a_sentence() -> None:
    found = Ipopt().minimise(line_past_a_circle(), np.array([1.0, 1.0]))
    assert not found.converged
    assert found.message == "no point satisfies all constraints near where it looked"
    assert found.violation > 0.5


def test_the_iteration_limit_is_told_in_a_sentence() -> None:
    found = Ipopt(max_iterations=3).minimise(rosenbrock_valley(), ROSENBROCK_START)
    assert not found.converged
    assert found.message == "ran out of iterations"
    assert found.iterations == 3


def test_a_status_without_a_sentence_is_told_in_words() -> None:
    solver = Ipopt(extra={"max_cpu_time": 1e-9})
    found = solver.minimise(rosenbrock_valley(200), np.tile(ROSENBROCK_START, 100))
    assert not found.converged
    assert found.message == "maximum cputime exceeded"


def test_more_equations_than_variables_is_told_in_a_sentence() -> None:
    x = ca.SX.sym("x")
    programme = single_block(x, x**2, [(x, 1.0, 1.0), (x**3, 8.0, 8.0)])
    found = Ipopt().minimise(programme, np.array([1.5]))
    assert not found.converged
    assert found.message == "there are more equations than free variables"


def test_the_monitor_sees_every_iteration() -> None:
    seen: list[tuple[int, float, float]] = []
    found = Ipopt().minimise(hock_schittkowski_71(), HS71_START, lambda *line: seen.append(line))
    assert [line[0] for line in seen] == list(range(found.iterations + 1))
    assert seen[-1][1] == pytest.approx(found.objective, abs=1e-6)
    assert seen[0][2] > 1e-2 > 1e-7 > seen[-1][2]  # the violation goes


@pytest.mark.parametrize("error", [KeyboardInterrupt(), BrokenPipeError("reader is gone")])
def test_what_the_monitor_raises_stops_the_solver_and_comes_through(error: BaseException) -> None:
    calls: list[int] = []

    def monitor(iteration: int, objective: float, violation: float) -> None:
        calls.append(iteration)
        if iteration == 2:
            raise error

    with pytest.raises(type(error)) as caught:
        Ipopt().minimise(rosenbrock_valley(), ROSENBROCK_START, monitor)
    assert caught.value is error
    assert calls == [0, 1, 2]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs POSIX timers")
def test_an_interrupt_from_the_keyboard_is_not_lost_in_the_solver() -> None:
    """It may arrive anywhere, in the factorisation too; the solver would run for a minute."""
    calls: list[int] = []
    previous = signal.signal(signal.SIGALRM, lambda *_: os.kill(os.getpid(), signal.SIGINT))

    def monitor(iteration: int, objective: float, violation: float) -> None:
        if not calls:
            signal.setitimer(signal.ITIMER_REAL, 0.05)
        calls.append(iteration)

    try:
        with pytest.raises(KeyboardInterrupt):
            Ipopt(max_iterations=5000).minimise(
                rosenbrock_valley(4000), np.tile(ROSENBROCK_START, 2000), monitor
            )
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)
    assert 1 <= len(calls) < 500
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_handler_that_the_program_has_set_is_asked() -> None:
    seen: list[int] = []
    previous = signal.signal(signal.SIGINT, lambda number, _: seen.append(number))
    try:
        found = Ipopt().minimise(
            rosenbrock_valley(),
            ROSENBROCK_START,
            lambda i, *_: os.kill(os.getpid(), signal.SIGINT) if i == 2 else None,
        )
    finally:
        signal.signal(signal.SIGINT, previous)
    assert found.converged  # it chose to go on
    assert seen == [signal.SIGINT]


def test_it_works_outside_the_main_thread() -> None:
    answers: list[bool] = []

    def work() -> None:
        answers.append(Ipopt().minimise(rosenbrock_valley(), ROSENBROCK_START).converged)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert answers == [True]


def test_the_same_start_gives_the_same_answer_to_the_last_bit() -> None:
    first, second = (Ipopt().minimise(hock_schittkowski_71(), HS71_START) for _ in range(2))
    assert first.x.tobytes() == second.x.tobytes()
    assert first.row_multipliers.tobytes() == second.row_multipliers.tobytes()
    assert first.iterations == second.iterations


def test_options_given_beyond_the_fields_reach_the_solver() -> None:
    found = Ipopt(extra={"max_iter": 2}).minimise(rosenbrock_valley(), ROSENBROCK_START)
    assert found.iterations == 2


def test_a_looser_tolerance_stops_earlier() -> None:
    loose = Ipopt(tolerance=0.1).minimise(rosenbrock_valley(), ROSENBROCK_START)
    tight = Ipopt(tolerance=1e-10).minimise(rosenbrock_valley(), ROSENBROCK_START)
    assert loose.converged and tight.converged
    assert loose.iterations < tight.iterations
    assert tight.objective < loose.objective
