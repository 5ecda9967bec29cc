"""Collocation converges with the order that theory gives to Gauss points."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from numpy.typing import NDArray

from ergowalk.transcription.phases import Coordinate, Instant, PhasedProblem, Terms

from .toys import Answer, chain, dense, instants, phase, solved

Array = NDArray[np.float64]

DURATION = 2.0


def known(t: Array) -> tuple[Array, Array, Array]:
    """A motion with rate and acceleration."""
    return (
        0.8 * np.sin(1.7 * t) + 0.3 * t,
        1.36 * np.cos(1.7 * t) + 0.3,
        -2.312 * np.sin(1.7 * t),
    )


def forced_pendulum() -> PhasedProblem:
    """x'' + 4 sin x + 0.5 x' = f(t), with f such that :func:`known` is the answer."""

    def inside(instant: Instant) -> Terms:
        terms, x, t = Terms(), instant.coordinates["x"], instant.time
        place = 0.8 * ca.sin(1.7 * t) + 0.3 * t
        rate = 1.36 * ca.cos(1.7 * t) + 0.3
        force = -2.312 * ca.sin(1.7 * t) + 4 * ca.sin(place) + 0.5 * rate
        terms.equal("motion", x.acceleration + 4 * ca.sin(x.value) + 0.5 * x.rate - force)
        return terms

    coordinates = [Coordinate("x", rate_scale=2.0, acceleration_scale=3.0)]
    return chain(
        phase("swing", inside, coordinates=coordinates),
        times={"start": (0.0, 0.0), "end": (DURATION, DURATION)},
        fixed={("start", "x", "value"): 0.0, ("start", "x", "rate"): 1.66},
    )


@pytest.fixture(scope="module", params=[2, 3])
def halvings(request: pytest.FixtureRequest) -> tuple[int, list[Answer]]:
    """Gauss points, and answers on meshes each twice as fine as the one before."""
    m: int = request.param
    problem = forced_pendulum()
    return m, [solved(problem, n, m) for n in (4, 8, 16)]


def orders(errors: list[float]) -> Array:
    """Exponents of the element size, halving by halving."""
    return np.asarray(np.log2(np.array(errors[:-1]) / np.array(errors[1:])))


def errors_inside(answers: list[Answer], kind: str, exact: int) -> list[float]:
    return [
        float(np.abs(dense(a.curves, kind, "x") - known(instants(a.curves))[exact]).max())
        for a in answers
    ]


def test_mesh_points_converge_with_twice_the_number_of_gauss_points(
    halvings: tuple[int, list[Answer]],
) -> None:
    """Superconvergence: order 2 m where elements meet."""
    m, answers = halvings
    ends = [known(np.array([DURATION])) for _ in answers]
    for kind, exact in (("values", 0), ("rates", 1)):
        errors = [
            float(abs(getattr(a.curves.phases[0], kind)[-1, 0] - end[exact][0]))
            for a, end in zip(answers, ends, strict=True)
        ]
        assert orders(errors).min() > 2 * m - 0.3, (kind, errors)


@pytest.mark.parametrize(("kind", "exact", "more"), [("acceleration", 2, 0), ("rate", 1, 1)])
def test_curves_inside_elements_converge_with_their_degree(
    halvings: tuple[int, list[Answer]], kind: str, exact: int, more: int
) -> None:
    """The acceleration is a polynomial of degree m - 1: order m; its integral one more."""
    m, answers = halvings
    errors = errors_inside(answers, kind, exact)
    assert orders(errors) == pytest.approx(m + more, abs=0.35), errors


def test_positions_inside_elements_converge_two_orders_faster_than_accelerations(
    halvings: tuple[int, list[Answer]],
) -> None:
    m, answers = halvings
    errors = errors_inside(answers, "value", 0)
    assert orders(errors).min() > m + 2 - 0.35, errors
    assert errors[-1] < 1e-4


def test_curves_join_in_value_and_rate_where_elements_meet(
    halvings: tuple[int, list[Answer]],
) -> None:
    _, answers = halvings
    for answer in answers:
        for kind, tolerance in (("value", 1e-10), ("rate", 1e-9)):
            curve = dense(answer.curves, kind, "x")
            np.testing.assert_allclose(curve[1:, 0], curve[:-1, -1], atol=tolerance)


def test_collocation_holds_at_gauss_points_to_rounding(
    halvings: tuple[int, list[Answer]],
) -> None:
    _, answers = halvings
    for answer in answers:
        worst = answer.collocation.programme.violations(answer.minimum.x)
        assert set(worst) == {"continuity", "motion"}
        assert max(worst.values()) < 1e-10
