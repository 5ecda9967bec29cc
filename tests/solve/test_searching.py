"""How legs are set apart, with searches that do as they are told."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem import GaitProblem, preset
from ergowalk.solving import searching
from ergowalk.solving.searching import from_mirrored
from ergowalk.transcription.curves import Trajectory
from ergowalk.transcription.halves import halves_of, times_twice
from ergowalk.transcription.walker import Smoothing

FLAT, TOES = PhaseOrder.FLAT_FIRST, PhaseOrder.TOE_OFF_FIRST
SHORTER = preset("berbyuk2002").replace(
    body=preset("berbyuk2002").body.replace(shank_length_m=(0.53, 0.51))
)
TIMES = {"heel_contact": 0.0, "heel_end": 0.1, "other_toe_off": 0.15, "heel_off": 0.25}
ROOMY = {**TIMES, "half_stride": 0.57}
AT_THE_LIMIT = {**ROOMY, "other_toe_off": 0.1 + 0.005 * 1.14}


@dataclass
class Story:
    """What every stage is to end in, and what was asked for."""

    fails: set[str] = field(default_factory=set)
    energies: dict[str, float] = field(default_factory=dict)
    times: dict[str, float] = field(default_factory=lambda: ROOMY)
    told: list[tuple[str, GaitProblem, tuple[PhaseOrder, ...]]] = field(default_factory=list)

    def result(self, words: str, times: dict[str, float]) -> Any:
        curves = Trajectory(times, (SimpleNamespace(at=None),) * (4 * len(times) // 5))  # type: ignore[arg-type]
        return SimpleNamespace(
            trajectory=curves,
            collocation=SimpleNamespace(mesh=(np.array([0.0, 1.0]),) * len(curves.phases)),
            minimum=SimpleNamespace(converged=words not in self.fails),
            energy_at_nodes=self.energies.get(words, 50.0),
        )

    def search(self, problem: GaitProblem, orders: Any, store: Any = None) -> Any:
        def stage(words: str, *_: Any, **__: Any) -> Any:
            self.told.append((words, problem, orders))
            return self.result(words, times_twice(self.times))

        halves = halves_of(problem, orders, Smoothing())
        return SimpleNamespace(
            problem=problem, orders=orders, order=orders[0], halves=halves, stage=stage
        )


def begun(story: Story, problem: GaitProblem, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The candidate of a story; mirrored legs walk flat-first, or toe-off-first a little dearer."""

    def mirrored(search: Any, equal: GaitProblem, _: Any) -> list[Any]:
        assert not equal.full_stride
        return [
            searching.Candidate(search(equal, (order,)), story.result(words, ROOMY))
            for order, words in ((FLAT, "flat"), (TOES, "toes"))
        ]

    monkeypatch.setattr(searching, "in_all_orders", mirrored)
    story.energies = {"flat": 48.0, "toes": 49.0} | story.energies
    return from_mirrored(story.search, problem, None)


def test_legs_are_set_apart_at_once_where_that_converges(monkeypatch: pytest.MonkeyPatch) -> None:
    story = Story()
    found = begun(story, SHORTER, monkeypatch)
    assert [words for words, _, _ in story.told] == ["legs apart"]
    assert found.search.problem == SHORTER
    assert found.search.orders == (FLAT, FLAT)


def test_else_by_quarters_and_the_last_is_the_problem_itself(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    story = Story(fails={"legs apart"})
    free = SHORTER.replace(design={"body.shank_length_m.2": (0.505, 0.512)})
    found = begun(story, free, monkeypatch)
    lengths = [problem.body.shank_length_m for _, problem, _ in story.told[1:]]
    steps = [(0.52 + 0.01 * share, 0.52 - 0.01 * share) for share in (0.25, 0.5, 0.75, 1.0)]
    np.testing.assert_allclose(lengths, steps, rtol=1e-12)
    assert found.search.problem == free  # to the last digit, its design too
    assert [bool(problem.design) for _, problem, _ in story.told[1:]] == [False] * 3 + [True]


def test_a_quarter_that_fails_ends_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    story = Story(fails={"legs apart", "legs apart by 0.5"})
    found = begun(story, SHORTER, monkeypatch)
    assert [words for words, _, _ in story.told][-1] == "legs apart by 0.5"
    assert not found.result.minimum.converged


@pytest.mark.parametrize(("energy", "orders"), [(49.0, (TOES, TOES)), (51.0, (FLAT, FLAT))])
def test_where_a_phase_is_at_its_limit_the_cheaper_order_is_kept(
    energy: float, orders: tuple[PhaseOrder, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    story = Story(times=AT_THE_LIMIT, energies={"legs apart": 50.0, "other order": energy})
    if orders == (TOES, TOES):  # each half changes once, and the second must gain again
        values = iter([49.0, 48.5])
        original = story.result

        def cheaper(words: str, times: dict[str, float]) -> Any:
            found = original(words, times)
            if words == "other order":
                found.energy_at_nodes = next(values)
            return found

        monkeypatch.setattr(story, "result", cheaper)
    found = begun(story, SHORTER, monkeypatch)
    tried = [asked for words, _, asked in story.told if words == "other order"]
    first = (TOES, FLAT)
    assert tried == [first, (TOES, TOES) if orders == (TOES, TOES) else (FLAT, TOES)]
    assert found.search.orders == orders


def test_a_free_number_of_a_device_of_one_leg_waits_until_there_is_that_device(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    path = "devices.leg_2.ankle.stiffness_nm_per_rad"
    problem = preset("below-knee-prosthesis").replace(design={path: (200.0, 400.0)})
    monkeypatch.setattr(searching, "eased", lambda whole, bare, result: (whole, bare))
    story = Story()
    whole, bare = begun(story, problem, monkeypatch).result
    assert whole.problem == problem
    assert bare.problem.full_stride
    assert not bare.problem.design
    assert not list(bare.problem.devices.everything())
