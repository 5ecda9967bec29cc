"""The preferred walk: the minimum along a line of constant speed, found from slopes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from ergowalk.errors import SweepError
from ergowalk.problem import GaitProblem, preset
from ergowalk.study import Criterion, preferred
from ergowalk.study.preference import CLOSE_M, MOST_GAITS, Trial, _minimum_of_cubic

SPEED = 1.3


@dataclass(frozen=True)
class Stub:
    """A solved problem as far as the search sees it."""

    problem: GaitProblem
    acceptable: bool = True


def criterion(value: Callable[[float, float], float]) -> Criterion:
    """A cost J(L, T) with slopes by central differences, exact for what is tested here."""
    h = 1e-5

    def at(gait: Stub) -> tuple[float, float]:
        return gait.problem.step_length_m, gait.problem.stride_time_s

    def slope(gait: Stub, name: str) -> float:
        x, t = at(gait)
        if name == "step_length_m":
            return (value(x + h, t) - value(x - h, t)) / (2 * h)
        return (value(x, t + h) - value(x, t - h)) / (2 * h)

    return Criterion("J", lambda gait: value(*at(gait)), slope)  # type: ignore[arg-type]


def valley(best: float, steep: float = 200.0) -> Callable[[float, float], float]:
    """J along T = 2 L / v has its minimum at L = ``best``."""
    return lambda x, t: (
        40 + steep * (x - best) ** 2 + 3 * (2 * x / t - SPEED) + 60 * (x - best) ** 3
    )


def search(best: float, refused: Callable[[float], bool] = lambda x: False, **more: object):
    tried: list[tuple[float, float | None]] = []

    def solver(problem: GaitProblem, start: Stub | None) -> Stub:
        tried.append((problem.step_length_m, start and start.problem.step_length_m))
        assert 2 * problem.step_length_m / problem.stride_time_s == pytest.approx(SPEED)
        return Stub(problem, not refused(problem.step_length_m))

    found = preferred(
        preset("berbyuk2002"),
        SPEED,
        criterion=criterion(valley(best, **more)),  # type: ignore[arg-type]
        solver=solver,  # type: ignore[arg-type]
    )
    return found, tried


@pytest.mark.parametrize("best", [0.55, 0.70, 0.76, 0.765, 0.90])
def test_the_cheapest_step_is_found_wherever_it_is(best: float) -> None:
    found, tried = search(best)
    assert found.found
    assert found.step_length == pytest.approx(best, abs=CLOSE_M)
    assert found.bracket[0] - 1e-9 <= best <= found.bracket[1] + 1e-9 or found.step_length == best
    assert found.cadence == pytest.approx(60 * SPEED / found.step_length)
    assert len(tried) == len(found.trials) <= 9
    assert found.status.startswith("minimum: ")


def test_every_gait_begins_at_the_nearest_one() -> None:
    _, tried = search(0.60)
    lengths = [length for length, _ in tried]
    assert tried[0][1] is None
    for i, (length, start) in enumerate(tried[1:], 1):
        assert start == min(lengths[:i], key=lambda other: abs(other - length))


def test_a_gait_that_is_refused_halves_the_step() -> None:
    found, tried = search(0.74, refused=lambda x: x < 0.738)
    assert found.found
    assert found.step_length == pytest.approx(0.74, abs=CLOSE_M)
    assert "refused" in found.status
    assert len(tried) > len(found.trials)


def test_a_wall_before_the_minimum_is_said() -> None:
    found, _ = search(0.60, refused=lambda x: x < 0.70)
    assert not found.found
    assert found.status.startswith("no minimum: no acceptable gait where the cost still falls")
    assert found.step_length == min(t.step_length for t in found.trials)


def test_a_cost_that_only_falls_ends_after_some_gaits() -> None:
    def falling(x: float, t: float) -> float:
        return 50 - x

    def solver(problem: GaitProblem, start: Stub | None) -> Stub:
        return Stub(problem, problem.step_length_m < 2.6)

    found = preferred(
        preset("berbyuk2002"),
        SPEED,
        criterion=criterion(falling),
        solver=solver,  # type: ignore
    )
    assert not found.found
    assert len(found.trials) <= MOST_GAITS


def test_without_a_first_gait_there_is_no_search() -> None:
    with pytest.raises(SweepError, match=r"step_length_m = 0.76: there is no acceptable gait to"):
        search(0.7, refused=lambda x: True)


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_a_speed_that_is_none_is_refused(speed: float) -> None:
    with pytest.raises(SweepError, match="speed = .*: must be positive; give a speed in m/s"):
        preferred(preset("berbyuk2002"), speed)


def test_the_trial_is_the_minimum_of_the_cubic_through_both_ends() -> None:
    def cost(x: float) -> float:
        return 3 * x**3 + 5 * x**2 - 4 * x

    def trial(x: float) -> Trial:
        return Trial(x, cost(x), 9 * x**2 + 10 * x - 4, None)  # type: ignore[arg-type]

    share = _minimum_of_cubic(trial(0.0), trial(1.0))
    assert 9 * share**2 + 10 * share - 4 == pytest.approx(0.0, abs=1e-12)


def test_values_that_contradict_the_slopes_are_not_believed() -> None:
    low, high = Trial(0.7, 50.0, -10.0, None), Trial(0.8, 59.0, 10.0, None)  # type: ignore
    assert _minimum_of_cubic(low, high) == pytest.approx(0.5)
