"""A path of gaits: each begins at the one before, and E follows its price."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from ergowalk import follow
from ergowalk.errors import ProblemError
from ergowalk.problem import GaitProblem, preset
from ergowalk.solution import Solution
from ergowalk.solving import path
from ergowalk.solving.path import HALVINGS, Waypoint


@pytest.fixture(scope="module")
def walked(paper_gait_file: Path) -> tuple[Solution, Waypoint]:
    """One step of 1 % in the step length."""
    start = Solution.load(paper_gait_file)
    (waypoint,) = follow(start, "step_length_m", [1.01 * start.problem.step_length_m])
    return start, waypoint


def test_a_neighbour_is_an_accepted_gait_of_its_own_problem(
    walked: tuple[Solution, Waypoint],
) -> None:
    start, waypoint = walked
    assert waypoint.solution.problem.step_length_m == waypoint.value
    assert waypoint.value == 1.01 * start.problem.step_length_m
    assert waypoint.solution.acceptable
    assert waypoint.steps == 1


def test_a_neighbour_takes_one_mesh_and_few_iterations(
    walked: tuple[Solution, Waypoint],
) -> None:
    """It keeps the mesh of the start and takes its check over."""
    start, waypoint = walked
    (final,) = (m for m in start.mesh_history if m.get("final"))
    own, check = waypoint.solution.mesh_history
    assert own["elements"] == final["elements"]
    assert waypoint.solution.dataset.attrs["iterations"] == own["iterations"]
    assert own["iterations"] < start.dataset.attrs["iterations"] / 3
    assert check["carried_from"] == start.energy_per_metre
    share = check["energy_per_metre"] / own["energy_per_metre"]
    (finer,) = (m for m in start.mesh_history if m.get("finer"))
    assert share == pytest.approx(finer["energy_per_metre"] / final["energy_per_metre"], rel=1e-12)
    (line,) = (r for r in waypoint.solution.audit().lines if r.key == "mesh")
    assert f"as a check of a gait with {start.energy_per_metre:.4g} J/m lets expect" in line.note


def test_e_is_what_its_price_foretold(walked: tuple[Solution, Waypoint]) -> None:
    start, waypoint = walked
    found = waypoint.solution.energy_per_metre
    error = abs(waypoint.predicted - found)
    assert error < 0.15 * abs(found - start.energy_per_metre)


def test_a_number_that_is_not_there_is_refused(paper_gait_file: Path) -> None:
    start = Solution.load(paper_gait_file)
    with pytest.raises(ProblemError, match=r"name = 'step_lenght_m': no such number; use one of"):
        follow(start, "step_lenght_m", [0.77])


def test_a_value_that_the_problem_excludes_is_refused_before_anything_is_solved(
    paper_gait_file: Path,
) -> None:
    start = Solution.load(paper_gait_file)
    with pytest.raises(ProblemError, match="stride_time_s"):
        follow(start, "stride_time_s", [1.15, -1.0])


# --- a way that is too long for one step -------------------------------------------------------


@dataclass(frozen=True)
class Stub:
    """A solved problem as far as the follower sees it."""

    problem: GaitProblem
    acceptable: bool
    energy_per_metre: float = 50.0


def strides(longest: float, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """What is solved on the way from 0.76 m to 0.80 m if steps above ``longest`` fail."""
    tried: list[float] = []

    def corrector(problem: GaitProblem, smoothing: None, start: Stub, progress: None) -> Stub:
        tried.append(problem.step_length_m)
        step = problem.step_length_m - start.problem.step_length_m
        return Stub(problem, step <= longest)

    monkeypatch.setattr(path, "solve_collocation", corrector)
    monkeypatch.setattr(path, "price_of", lambda gait, name: 100.0)
    start = Stub(preset("berbyuk2002"), True)
    (waypoint,) = follow(start, "step_length_m", [0.80])  # type: ignore[arg-type]
    assert waypoint.steps == len(tried)
    assert waypoint.predicted == pytest.approx(54.0)
    assert waypoint.solution.acceptable == (tried[-1] == 0.80 and longest > 0.004)
    return tried


def test_a_step_that_fails_is_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    assert strides(0.021, monkeypatch) == pytest.approx([0.80, 0.78, 0.80])


def test_a_step_is_divided_as_often_as_it_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    expected = [0.80, 0.78, 0.77, 0.78, 0.80, 0.79, 0.80]
    assert strides(0.011, monkeypatch) == pytest.approx(expected)


def test_a_wall_on_the_way_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = strides(0.0, monkeypatch)
    assert len(tried) == 1 + HALVINGS
