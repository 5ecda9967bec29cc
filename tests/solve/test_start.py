"""A collocation that begins with a solved gait."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from ergowalk.gait.rhythm import PhaseOrder, boundary_fractions, half_stride_phases
from ergowalk.problem import GaitProblem, preset
from ergowalk.solution import Solution
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving import collocation, solve, stages
from ergowalk.solving.stages import Effort, OrderSearch
from ergowalk.solving.start import StartingGait, within
from ergowalk.transcription import halves as halves_module
from ergowalk.transcription.curves import Guess
from ergowalk.transcription.halves import Half, Orders, halves_of
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.mesh import walking_mesh
from ergowalk.transcription.walker import Smoothing

FIXED = preset("berbyuk2002-rhythm")


@pytest.fixture(scope="module")
def gait(paper_gait_file: Path) -> Solution:
    return Solution.load(paper_gait_file)


def begun(problem: GaitProblem, gait: Solution) -> collocation.Candidate | None:
    """The coarse stage from a gait."""

    def search(
        problem: GaitProblem, orders: Orders, store: KernelStore | None = None
    ) -> OrderSearch:
        return OrderSearch(problem, orders, Smoothing(), Effort(), None, store)

    return collocation._begin(search, problem, gait)


def halves(problem: GaitProblem, gait: Solution) -> tuple[Half, ...]:
    """The halves of a problem in the orders of a gait."""
    return halves_of(problem, (gait.rhythm.order,) * (1 + problem.full_stride), Smoothing())


def guessed(problem: GaitProblem, gait: Solution) -> Guess:
    """The curves of a gait for a problem."""
    return StartingGait(gait).guess(problem, halves(problem, gait))


@pytest.mark.parametrize(
    ("length", "time", "near"),
    [(1.0, 1.0, True), (1.019, 0.981, True), (1.021, 1.0, False), (1.0, 0.979, False)],
)
def test_a_gait_with_other_steps_is_continued_from_further_inside_the_bounds(
    gait: Solution, length: float, time: float, near: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = FIXED.replace(
        step_length_m=FIXED.step_length_m * length, stride_time_s=FIXED.stride_time_s * time
    )
    barriers: list[float] = []

    def stop(search: OrderSearch, before: object, begin: object, barrier: float) -> None:
        barriers.append(barrier)
        raise InterruptedError

    monkeypatch.setattr(OrderSearch, "continued", stop)
    with pytest.raises(InterruptedError):
        begun(problem, gait)
    assert barriers == [collocation.NEAR if near else collocation.FAR]
    assert collocation.NEAR < collocation.FAR


def test_the_side_inside_the_phase_is_taken_where_an_instant_stands_twice() -> None:
    time = np.array([0.0, 0.1, 0.2, 0.2, 0.3, 0.4, 0.4, 0.5])
    assert time[within(time, 0.2, 0.4, 1e-9)].tolist() == [0.2, 0.3, 0.4]
    assert within(time, 0.2, 0.4, 1e-9) == slice(3, 6)
    assert within(time, 0.0, 0.2, 1e-9) == slice(0, 3)
    assert within(time, 0.4, 0.5, 1e-9) == slice(6, 8)


def test_the_curves_of_a_gait_are_those_of_its_record(gait: Solution) -> None:
    """At both ends of every phase, seen from inside, and per kg of body mass."""
    data, mass = gait.dataset, FIXED.body.total_mass
    time, contacts = data["time"].to_numpy(), data["contact_phase"].to_numpy()
    guess = guessed(FIXED, gait)
    fractions = boundary_fractions(gait.rhythm)
    for i, phase in enumerate(half_stride_phases(gait.rhythm.order)):
        samples = guess(i, np.array([0.0, 1.0]))
        ends = [fractions[name] * FIXED.stride_time_s for name in (phase.start, phase.end)]
        inside = np.all(contacts == [int(c) for c in phase.legs], axis=1)
        for k, end in enumerate(ends):
            (at,) = np.flatnonzero(inside & (np.abs(time - end) < 1e-9))
            here = data.isel(time=at)
            knee = here["joint_moment"].sel(leg=1, joint="knee") / mass
            force = here["ground_reaction_force"].sel(leg=1, axis="y") / mass
            turn = here["segment_angular_acceleration"].sel(leg=2, segment="thigh")
            assert samples.control["knee_1"][k] == pytest.approx(float(knee), abs=1e-9)
            assert samples.algebraic["reaction_y_1"][k] == pytest.approx(float(force), abs=1e-9)
            assert samples.acceleration["thigh_2"][k] == pytest.approx(float(turn), abs=1e-9)


def test_a_longer_stride_goes_through_the_same_angles_more_slowly(gait: Solution) -> None:
    slow = FIXED.replace(stride_time_s=2 * FIXED.stride_time_s)
    parts = np.linspace(0.1, 0.9, 5)
    own, late = (guessed(p, gait)(2, parts) for p in (FIXED, slow))
    np.testing.assert_allclose(late.value["shank_1"], own.value["shank_1"])
    np.testing.assert_allclose(late.rate["shank_1"], own.rate["shank_1"] / 2)
    np.testing.assert_allclose(late.acceleration["shank_1"], own.acceleration["shank_1"] / 4)


def test_instants_stay_inside_the_bounds_of_the_problem(gait: Solution) -> None:
    start = StartingGait(gait)
    times = start.times(FIXED, halves(FIXED, gait))
    assert times is not None
    assert times["heel_off"] == pytest.approx(0.23 * FIXED.stride_time_s, rel=1e-9)
    later = FIXED.replace(rhythm=FIXED.rhythm.replace(heel_off=[0.3, 0.35]))
    moved = start.times(later, halves(later, gait))
    assert moved is not None
    assert moved["heel_off"] == pytest.approx(0.3 * FIXED.stride_time_s, rel=1e-9)
    other = preset("berbyuk2002")
    other = other.replace(rhythm=other.rhythm.replace(order="flat-first"))
    assert start.orders(FIXED) == (PhaseOrder.TOE_OFF_FIRST,)
    assert start.orders(other) is None


def test_from_its_own_answer_the_search_is_shorter(gait: Solution) -> None:
    found = begun(FIXED, gait)
    assert found is not None
    searched = gait.dataset.attrs["iterations"] - sum(
        e["iterations"] for e in gait.mesh_history[1:]
    )
    assert found.result.minimum.iterations < searched
    assert found.result.energy_at_nodes == pytest.approx(gait.energy_per_metre, rel=0.15)


def test_a_start_that_cannot_be_used_is_said(
    gait: Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The gait has the other order of phases: the search begins with the human means."""
    monkeypatch.setattr(stages, "Ipopt", partial(Ipopt, max_iterations=3))
    monkeypatch.setattr(
        halves_module, "walking_mesh", lambda o, t, s, level: walking_mesh(o, t, s, level / 5)
    )
    other = preset("berbyuk2002")
    other = other.replace(rhythm=other.rhythm.replace(order="flat-first"))
    told: list[str] = []
    answer = solve(other, start=gait, progress=lambda line: told.append(line.stage))
    assert answer.status.endswith(
        "; the start could not be used, so the search began from the human means"
    )
    assert "fit to human means" in told[0]


def test_a_start_of_no_numbers_is_said(gait: Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stages, "Ipopt", partial(Ipopt, max_iterations=3))
    monkeypatch.setattr(
        halves_module, "walking_mesh", lambda o, t, s, level: walking_mesh(o, t, s, level / 5)
    )
    lost = Solution(gait.dataset.assign(trunk_angle=gait.dataset["trunk_angle"] * np.nan))
    answer = solve(FIXED, start=lost)
    assert "the start could not be used" in answer.status
    assert answer.energy_per_metre > 0
