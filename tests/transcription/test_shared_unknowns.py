"""Unknowns of no instant, chains that are joined in the middle, time that starts anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.transcription.toys import TIGHT, at_rest, chain, dense, instants, phase, still

from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Trajectory
from ergowalk.transcription.edges import fourier
from ergowalk.transcription.phases import Instant, Join, Link, PhasedProblem, Terms, Unknown

W, DAMPING, STIFFNESS = 1.5, 0.3, 2.0
PERIOD = 2 * np.pi / W


def found(problem: PhasedProblem, elements: int, m: int, **shared: float) -> Trajectory:
    """The solved curves, from zero curves, the middle of the times and the given shared values."""
    mesh = tuple(np.linspace(0.0, 1.0, elements + 1) for _ in problem.phases)
    collocation = Collocation(problem, mesh, m)
    times = {n: (low + high) / 2 for n, (low, high) in problem.times.items()}
    x = collocation.pack(still(problem), times, shared)
    minimum = TIGHT.minimise(collocation.programme, x)
    assert minimum.converged, minimum.message
    return collocation.unpack(minimum.x)


def test_a_shared_unknown_is_found_with_the_motion() -> None:
    """x'' = -k x from rest at 1 to 0 in the time pi / 2: k = 1, whatever its scale."""
    stiffness = Unknown("k", 0.1, 3.0, scale=3.0)

    def inside(instant: Instant) -> Terms:
        terms, x = Terms(), instant.coordinates["x"]
        terms.equal("dynamics", x.acceleration + instant.shared["k"] * x.value)
        return terms

    problem = chain(
        replace(phase("swing", inside), shared=(stiffness,)),
        times={"start": (0.0, 0.0), "end": (np.pi / 2, np.pi / 2)},
        fixed=at_rest("start", 1.0) | {("end", "x", "value"): 0.0},
    )
    curves = found(replace(problem, shared=(stiffness,)), 6, 3, k=1.4)
    assert curves.shared["k"] == pytest.approx(1.0, abs=1e-6)
    assert dense(curves, "rate", "x")[-1, -1] == pytest.approx(-1.0, abs=1e-5)


def test_a_link_and_a_row_of_times_see_what_is_shared() -> None:
    """At constant speed 2 to where the shared place says, at the instant that it says."""
    place = Unknown("place", 0.5, 9.0, scale=0.1)

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("dynamics", instant.coordinates["x"].acceleration)
        return terms

    def arrival(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("arrival", instant.coordinates["x"].value - instant.shared["place"])
        return terms

    problem = chain(
        phase("run", inside),
        times={"start": (0.0, 0.0), "end": (0.1, 9.0)},
        fixed={("start", "x", "value"): 0.0, ("start", "x", "rate"): 2.0},
        links=[Link("arrival", "end", arrival)],
        time_rows=[("time for places", {"end": 1.0, "place": 1.0}, 6.0, 6.0)],
    )
    curves = found(replace(problem, shared=(place,)), 2, 3, place=1.0)
    assert curves.shared["place"] == pytest.approx(4.0, abs=1e-8)
    assert curves.times["end"] == pytest.approx(2.0, abs=1e-8)


@pytest.mark.parametrize("share", [0.5, 0.37])
def test_halves_in_times_of_their_own_make_one_period(share: float) -> None:
    """x'' + c x' + k x = cos w t, cut in two: the second half calls x otherwise, and its clock
    starts anew; the push is told how long the first half lasts."""
    first = share * PERIOD
    push = np.array([[0.0, 1.0, 0.0, 0.0]])  # cos of one turn a period

    def oscillator(name: str) -> object:
        def inside(instant: Instant) -> Terms:
            terms, x = Terms(), instant.coordinates[name]
            force = instant.curves["push"]
            terms.equal("dynamics", x.acceleration + DAMPING * x.rate + STIFFNESS * x.value - force)
            return terms

        return inside

    curves = fourier(("push",), push, PERIOD)
    here = phase("here", oscillator("x"), end="middle")  # type: ignore[arg-type]
    there = phase(
        "there",
        oscillator("y"),  # type: ignore[arg-type]
        coordinates=("y",),
        start="again",
        end="last",
    )
    here = replace(here, curves=(curves,))
    later = replace(curves, later="middle")
    there = replace(there, curves=(later,), shared=(Unknown("middle"),))
    rest = PERIOD - first
    problem = chain(
        here,
        there,
        times={
            "start": (0.0, 0.0),
            "middle": (0.2 * PERIOD, 0.8 * PERIOD),
            "again": (0.0, 0.0),
            "last": (rest, rest),
        },
        time_rows=[("period", {"middle": 1.0, "last": 1.0}, PERIOD, PERIOD)],
    )
    joins = (Join("middle", "again", {"x": "y"}), Join("last", "start", {"y": "x"}))
    answer = found(replace(problem, joins=joins), 8, 3)
    assert answer.times["middle"] == pytest.approx(first, abs=1e-9)
    steady = 1 / (STIFFNESS - W**2 + 1j * DAMPING * W)
    for i, (name, shift) in enumerate((("x", 0.0), ("y", first))):
        t = instants(answer, i) + shift
        exact = (steady * np.exp(1j * W * t)).real
        np.testing.assert_allclose(dense(answer, "value", name, i), exact, atol=2e-5)
