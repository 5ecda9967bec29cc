"""The whole stride: two halves, the legs in exchanged roles, unequal steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ergowalk.problem import GaitProblem
from ergowalk.problem.legs import Stride
from ergowalk.solution import Solution
from ergowalk.solving.answer import dense_gait
from ergowalk.solving.memory import recall
from ergowalk.solving.stages import StageResult, Start
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Guess, Samples, Trajectory
from ergowalk.transcription.halves import Orders, halves_of
from ergowalk.transcription.steps import STEP_1
from ergowalk.transcription.walker import Smoothing
from ergowalk.transcription.walking import walking_problem

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mirrored:
    """A solved gait of mirrored legs, with the stage that it came from."""

    gait: Solution
    orders: Orders
    result: StageResult

    @property
    def problem(self) -> GaitProblem:
        """Its problem, whose legs mirror each other."""
        return self.gait.problem


@pytest.fixture(scope="module")
def mirrored(paper_gait_file: Path) -> Mirrored:
    gait = Solution.load(paper_gait_file)
    search, result = recall(gait)
    return Mirrored(gait, search.orders, result)


def each(problem: GaitProblem, **changes: object) -> GaitProblem:
    """The problem with both halves of its stride solved."""
    changed: GaitProblem = problem.replace(stride=Stride(legs="each"), **changes)
    return changed


def both_halves(problem: GaitProblem, mirrored: Mirrored) -> Collocation:
    """The programme of the whole stride on the mesh of the mirrored gait."""
    phased = walking_problem(problem, mirrored.orders * 2, Smoothing())
    return Collocation(phased, mirrored.result.collocation.mesh * 2, 3)


def packed(collocation: Collocation, problem: GaitProblem, mirrored: Mirrored) -> Array:
    start = Start.twice(mirrored.result.trajectory, problem)
    return collocation.pack(start.guess, start.times, start.shared)


def test_a_mirrored_gait_twice_is_a_gait_of_the_whole_stride(mirrored: Mirrored) -> None:
    """Every row holds as well as in the half stride, and the work is twice as much."""
    problem = each(mirrored.problem)
    collocation = both_halves(problem, mirrored)
    objective, rows = collocation.programme.evaluate(packed(collocation, problem, mirrored))
    half = mirrored.result.collocation
    x = half.pack(mirrored.result.trajectory.as_guess(), mirrored.result.trajectory.times)
    objective_of_half, rows_of_half = half.programme.evaluate(x)
    worst = max(half.programme.violations(x, rows_of_half).values())
    found = max(collocation.programme.violations(x, rows).values())
    assert objective == pytest.approx(2 * objective_of_half, rel=1e-9)
    assert found == pytest.approx(worst, rel=1e-6, abs=1e-9)


def test_half_as_many_instants_and_joined_states_are_unknown(mirrored: Mirrored) -> None:
    """The states at both heel contacts are those at the ends of the halves before."""
    collocation = both_halves(each(mirrored.problem), mirrored)
    where = collocation.layout.boundary
    for name, other in (("thigh_1", "thigh_2"), ("shank_2", "shank_1"), ("trunk", "trunk")):
        for kind in ("value", "rate"):
            assert where["half_stride", name, kind] == where["heel_contact 2", other, kind]
            assert where["half_stride 2", name, kind] == where["heel_contact", other, kind]
    assert where["half_stride", "trunk", "value"] != where["half_stride 2", "trunk", "value"]
    assert list(collocation.layout.shared) == [STEP_1]


def moved(curves: Guess, step: float) -> Guess:
    """Curves that are no gait, and not the same in both halves; at the ends they still join."""

    def guess(i: int, fractions: Array) -> Samples:
        samples = curves(i, fractions)

        def kind(values: Mapping[str, Array], size: float) -> dict[str, Array]:
            return {
                name: value + size * step * (1 + i) * bump * np.cos(3 * fractions + len(name))
                for name, value in values.items()
            }

        bump = np.sin(np.pi * fractions)

        return Samples(
            kind(samples.value, 1.0),
            kind(samples.rate, 1.0),
            kind(samples.acceleration, 10.0),
            kind(samples.control, 1.0),
            kind(samples.algebraic, 1.0),
        )

    return guess


def test_exchanging_the_legs_exchanges_the_halves(mirrored: Mirrored) -> None:
    """For legs that differ in everything, at a point that is no gait."""
    problem = each(
        mirrored.problem,
        body=mirrored.problem.body.replace(foot_mass_kg=(1.2, 1.5), shank_length_m=(0.53, 0.52)),
        limits={"leg_2": {"friction_coefficient": 0.4, "moment_nm_per_kg": {"knee": 1.0}}},
        rhythm={"leg_1": {"toe_off": (0.55, 0.6)}},
        corridors={"leg_2": {"width_sd": 1.4}},
        devices={
            "leg_1": {"hip": {"kind": "spring", "stiffness_nm_per_rad": 40.0}},
            "leg_2": {"knee": {"kind": "damper", "damping_nms_per_rad": 3.0}},
        },
    )
    times = mirrored.result.trajectory.times
    here = dict(times)
    late = {name: 1.04 * t for name, t in times.items()}
    count = len(mirrored.result.trajectory.phases)
    curves = moved(Start.twice(mirrored.result.trajectory, problem).guess, 0.01)

    def found(given: GaitProblem, first: int, step_1: float) -> tuple[float, dict[str, float]]:
        collocation = both_halves(given, mirrored)
        instants = (here, late) if first == 0 else (late, here)
        both = dict(instants[0]) | {name + " 2": t for name, t in instants[1].items()}
        x = collocation.pack(
            lambda i, s: curves((i + first * count) % (2 * count), s), both, {STEP_1: step_1}
        )
        objective, rows = collocation.programme.evaluate(x)
        return objective, collocation.programme.violations(x, rows)

    length = problem.step_length_m
    objective, worst = found(problem, 0, 1.02 * length)
    other_objective, other_worst = found(problem.exchanged(), 1, 0.98 * length)
    assert other_objective == pytest.approx(objective, rel=1e-9)
    assert other_worst.keys() == worst.keys()
    for label, value in worst.items():
        assert other_worst[label] == pytest.approx(value, rel=1e-7, abs=1e-9), label


def test_unequal_steps_put_the_feet_where_they_belong(mirrored: Mirrored) -> None:
    """The dense curves of two halves: step lengths, times and the print of each foot."""
    problem, trajectory = each(mirrored.problem), mirrored.result.trajectory
    halves = halves_of(problem, mirrored.orders * 2, Smoothing())
    later = {name + " 2": t for name, t in trajectory.times.items()}
    both = Trajectory(
        {**trajectory.times, **later},
        trajectory.phases * 2,
        {STEP_1: problem.step_length_m},
    )
    data = dense_gait(problem, halves, both)
    equal = problem.mirrored()
    same = dense_gait(equal, halves_of(equal, mirrored.orders, Smoothing()), trajectory)
    for name in ("joint_angle", "joint_moment", "ground_reaction_force", "corridor_lower"):
        np.testing.assert_allclose(data[name], same[name], atol=1e-9)
    np.testing.assert_allclose(data["hip_position"], same["hip_position"], atol=1e-12)


def test_the_duration_of_a_half_is_that_of_the_step_that_ends_it(mirrored: Mirrored) -> None:
    """(T_1 - T_2)/T between -0.02 and 0.06: the half that leg 2 ends is the shorter one."""
    asked = Stride(legs="each", step_time_asymmetry=(-0.02, 0.06), step_length_asymmetry=0.04)
    problem = mirrored.problem.replace(stride=asked)
    phased = walking_problem(problem, mirrored.orders * 2, Smoothing())
    half = problem.stride_time_s / 2
    assert phased.times["half_stride"] == pytest.approx((0.94 * half, 1.02 * half))
    assert phased.times["half_stride 2"] == pytest.approx((0.98 * half, 1.06 * half))
    (step,) = phased.shared
    length = problem.step_length_m
    assert (step.lower, step.upper) == pytest.approx((1.04 * length, 1.04 * length))
