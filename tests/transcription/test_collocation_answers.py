"""Collocation finds the known answers of small optimal control problems."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from ergowalk.transcription.phases import Coordinate, Instant, InstantFunction, Link, Terms, Unknown

from .toys import at_rest, chain, dense, instants, phase, solved


def driven(instant: Instant) -> Terms:
    """x'' = u at the cost of u^2."""
    terms, x, u = Terms(), instant.coordinates["x"], instant.controls["u"]
    terms.equal("dynamics", x.acceleration - u)
    terms.integrand = u**2
    return terms


@pytest.mark.parametrize("m", [2, 3])
def test_the_cheapest_move_from_rest_to_rest_is_found_exactly(m: int) -> None:
    """Least effort: acceleration 6 d / T^2 (1 - 2 t/T), linear in time; effort 12 d^2 / T^3."""
    duration, distance = 2.0, 3.0
    problem = chain(
        phase("move", driven, controls=["u"]),
        times={"start": (0.0, 0.0), "end": (duration, duration)},
        fixed=at_rest("start", 0.0) | at_rest("end", distance),
    )
    answer = solved(problem, 4, m)
    t = instants(answer.curves)
    exact = 6 * distance / duration**2 * (1 - 2 * t / duration)
    np.testing.assert_allclose(dense(answer.curves, "acceleration", "x"), exact, atol=1e-8)
    np.testing.assert_allclose(dense(answer.curves, "control", "u"), exact, atol=1e-8)
    place = distance * (3 * (t / duration) ** 2 - 2 * (t / duration) ** 3)
    np.testing.assert_allclose(dense(answer.curves, "value", "x"), place, atol=1e-9)
    assert answer.minimum.objective == pytest.approx(12 * distance**2 / duration**3, abs=1e-8)


@pytest.mark.parametrize("m", [2, 3])
def test_a_wall_on_the_way_is_touched_as_bryson_denham_and_dreyfus_found(m: int) -> None:
    """x <= l = 1/9 between x = 0 with rates 1 and -1: effort 8 / (9 l), u zero along the wall."""
    wall = 1 / 9

    def path(instant: Instant) -> Terms:
        terms = Terms()
        terms.between("wall", instant.coordinates["x"].value, -1.0, wall)
        return terms

    edges = {("start", "x", "rate"): 1.0, ("end", "x", "rate"): -1.0}
    edges |= {("start", "x", "value"): 0.0, ("end", "x", "value"): 0.0}
    problem = chain(
        phase("bounce", driven, controls=["u"], path=path),
        times={"start": (0.0, 0.0), "end": (1.0, 1.0)},
        fixed=edges,
    )
    answer = solved(problem, 6, m)  # the wall is met at 1/3 and left at 2/3, both mesh points
    assert answer.minimum.objective == pytest.approx(8 / (9 * wall), abs=1e-6)
    t, u = instants(answer.curves), dense(answer.curves, "control", "u")
    near = np.minimum(t, 1 - t)
    exact = np.where(near < 1 / 3, -2 / (3 * wall) * (1 - near / (3 * wall)), 0.0)
    np.testing.assert_allclose(u, exact, atol=1e-5)
    assert dense(answer.curves, "value", "x").max() == pytest.approx(wall, abs=1e-8)


@pytest.mark.parametrize("m", [2, 3])
def test_lifting_costs_the_potential_energy_and_no_more(m: int) -> None:
    """x'' = u - g from rest to rest: the least absolute work of u is g times the height."""
    gravity, height = 9.81, 0.4

    def inside(instant: Instant) -> Terms:
        terms, x, u = Terms(), instant.coordinates["x"], instant.controls["u"]
        terms.equal("dynamics", x.acceleration - (u - gravity))
        terms.absolute = [u * x.rate]
        return terms

    problem = chain(
        phase("lift", inside, controls=[Unknown("u", scale=10.0)], absolute_scale=5.0),
        times={"start": (0.0, 0.0), "end": (1.0, 1.0)},
        fixed=at_rest("start", 0.0) | at_rest("end", height),
    )
    answer = solved(problem, 5, m)
    assert answer.minimum.objective == pytest.approx(gravity * height, abs=1e-7)
    power = dense(answer.curves, "control", "u") * dense(answer.curves, "rate", "x")
    assert power.min() > -1e-6


@pytest.mark.parametrize("m", [2, 3])
def test_running_up_and_braking_both_cost_the_kinetic_energy(m: int) -> None:
    """From rest to rate v and back to rest: work v^2 / 2 each way, positive and negative."""
    speed = 1.7

    def work(instant: Instant) -> Terms:
        terms, x, u = Terms(), instant.coordinates["x"], instant.controls["u"]
        terms.equal("dynamics", x.acceleration - u)
        terms.absolute = [u * x.rate]
        return terms

    problem = chain(
        phase("run", work, controls=["u"], end="top"),
        phase("brake", work, controls=["u"], start="top"),
        times={"start": (0.0, 0.0), "top": (1.0, 1.0), "end": (2.5, 2.5)},
        fixed={
            ("start", "x", "value"): 0.0,
            ("start", "x", "rate"): 0.0,
            ("top", "x", "rate"): speed,
            ("end", "x", "rate"): 0.0,
        },
    )
    answer = solved(problem, [3, 4], m)
    assert answer.minimum.objective == pytest.approx(speed**2, abs=1e-7)
    layout, x = answer.collocation.layout, answer.minimum.x
    run, brake = (
        (x[where.plus] - x[where.minus], x[where.plus] * x[where.minus]) for where in layout.phases
    )
    assert run[0].min() > -1e-6 and brake[0].max() < 1e-6
    assert max(run[1].max(), brake[1].max()) < 1e-6  # never both slacks at once


@pytest.mark.parametrize("m", [2, 3])
def test_the_fastest_move_under_unequal_bounds_is_bang_bang(m: int) -> None:
    """Push <= 2, brake <= 1, distance 3: top rate 2, switch at 1, arrival at 3."""

    def pushing(instant: Instant) -> Terms:
        terms = Terms()
        x = instant.coordinates["x"]
        terms.equal("dynamics", x.acceleration - instant.controls["push"])
        terms.integrand = 1.0
        return terms

    def braking(instant: Instant) -> Terms:
        terms = Terms()
        x = instant.coordinates["x"]
        terms.equal("dynamics", x.acceleration + instant.controls["brake"])
        terms.integrand = 1.0
        return terms

    problem = chain(
        phase("pushing", pushing, controls=[Unknown("push", -2.0, 2.0)], end="switch"),
        phase("braking", braking, controls=[Unknown("brake", -1.0, 1.0)], start="switch"),
        times={"start": (0.0, 0.0), "switch": (0.1, 9.0), "end": (0.2, 9.0)},
        fixed=at_rest("start", 0.0) | at_rest("end", 3.0),
        time_rows=[("order", {"end": 1.0, "switch": -1.0}, 0.1, np.inf)],
    )
    answer = solved(problem, 3, m, times={"switch": 1.5, "end": 4.0})
    assert answer.minimum.objective == pytest.approx(3.0, abs=1e-7)
    assert answer.curves.times["end"] == pytest.approx(3.0, abs=1e-7)
    assert answer.curves.times["switch"] == pytest.approx(1.0, abs=1e-6)
    assert dense(answer.curves, "rate", "x").max() == pytest.approx(2.0, abs=1e-6)
    np.testing.assert_allclose(dense(answer.curves, "control", "push", 0), 2.0, atol=1e-6)
    np.testing.assert_allclose(dense(answer.curves, "control", "brake", 1), 1.0, atol=1e-6)


@pytest.mark.parametrize("m", [2, 3])
def test_the_fastest_move_in_one_phase_switches_in_the_middle(m: int) -> None:
    """|acceleration| <= 1 as an algebraic unknown, distance 1: arrival at 2."""

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("dynamics", instant.coordinates["x"].acceleration - instant.algebraics["a"])
        terms.integrand = 1.0
        return terms

    problem = chain(
        phase("race", inside, algebraics=[Unknown("a", -1.0, 1.0)]),
        times={"start": (0.0, 0.0), "end": (0.5, 5.0)},
        fixed=at_rest("start", 0.0) | at_rest("end", 1.0),
    )
    answer = solved(problem, 6, m)
    assert answer.curves.times["end"] == pytest.approx(2.0, abs=1e-7)
    found = dense(answer.curves, "algebraic", "a")
    np.testing.assert_allclose(found[:3], 1.0, atol=1e-6)
    np.testing.assert_allclose(found[3:], -1.0, atol=1e-6)


@pytest.mark.parametrize("elements", [1, 6])
def test_mirrored_oscillators_exchange_their_states_after_half_a_period(elements: int) -> None:
    """x'' + c x' + k x = +- cos w t: over half a period the steady states change places."""
    damping, stiffness, w = 0.3, 2.0, 1.5

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        for name, sign in (("x_1", 1.0), ("x_2", -1.0)):
            x = instant.coordinates[name]
            push = instant.controls[f"push_{name[-1]}"]
            terms.integrand = terms.integrand + (push - 5.0) ** 2  # so there is no push but 5
            force = sign * ca.cos(w * instant.time) + push - 5.0
            terms.equal("dynamics", x.acceleration + damping * x.rate + stiffness * x.value - force)
        return terms

    half = np.pi / w
    swap = {"x_1": "x_2", "x_2": "x_1", "push_1": "push_2", "push_2": "push_1"}
    coordinates = [Coordinate(n, rate_scale=3.0, acceleration_scale=7.0) for n in ("x_1", "x_2")]
    m = 3 if elements > 1 else 9
    problem = chain(
        phase("swing", inside, coordinates=coordinates, controls=["push_1", "push_2"]),
        times={"start": (0.0, 0.0), "end": (half, half)},
        exchange=swap,
    )
    answer = solved(problem, elements, m)
    where = answer.collocation.layout.phases[0]
    for kind in (where.values, where.rates, where.controls):
        np.testing.assert_array_equal(kind[-1], kind[0][::-1])  # one unknown, not two made equal
    t = instants(answer.curves)
    steady = 1 / (stiffness - w**2 + 1j * damping * w)
    exact = (steady * np.exp(1j * w * t)).real
    tolerance = 3e-5 if elements > 1 else 1e-7
    np.testing.assert_allclose(dense(answer.curves, "value", "x_1"), exact, atol=tolerance)
    np.testing.assert_allclose(dense(answer.curves, "value", "x_2"), -exact, atol=tolerance)


@pytest.mark.parametrize("m", [2, 3])
def test_a_bound_on_the_rate_of_a_control_is_reached(m: int) -> None:
    """Largest integral of u from u(0) = 0 under |u'| <= 2: u = 2 t, integral T^2."""

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("dynamics", instant.coordinates["x"].acceleration)
        terms.integrand = -instant.controls["u"]
        return terms

    problem = chain(
        phase("ramp", inside, controls=[Unknown("u", scale=4.0)]),
        times={"start": (0.0, 0.0), "end": (1.5, 1.5)},
        fixed=at_rest("start", 0.0) | {("start", "u", "control"): 0.0},
        rates={"u": 2.0},
    )
    answer = solved(problem, 4, m)
    assert answer.minimum.objective == pytest.approx(-(1.5**2), abs=1e-7)
    np.testing.assert_allclose(
        dense(answer.curves, "control", "u"), 2 * instants(answer.curves), atol=1e-6
    )


@pytest.mark.parametrize("m", [2, 3])
def test_a_cost_on_the_rate_of_a_control_makes_it_straight(m: int) -> None:
    """Least integral of u'^2 between given ends: a straight line, on unequal elements too."""

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("dynamics", instant.coordinates["x"].acceleration)
        return terms

    problem = chain(
        phase("slow", inside, controls=["u"], end="middle"),
        phase("on", inside, controls=["u"], start="middle"),
        times={"start": (0.0, 0.0), "middle": (0.5, 0.5), "end": (2.0, 2.0)},
        fixed=at_rest("start", 0.0)
        | {("start", "u", "control"): 1.0, ("end", "u", "control"): 5.0},
        rate_cost={"u": 0.25},
    )
    answer = solved(problem, [2, 3], m)
    assert answer.minimum.objective == pytest.approx(0.25 * (4 / 2) ** 2 * 2, abs=1e-8)
    for i in (0, 1):
        line = 1 + 2 * instants(answer.curves, i)
        np.testing.assert_allclose(dense(answer.curves, "control", "u", i), line, atol=1e-6)


def test_a_reward_for_a_control_against_the_cost_of_its_rate_makes_a_parabola() -> None:
    """Least integral of c u'^2 - u with u = 0 at both ends: u = t (1 - t) / (4 c), -1 / (48 c)."""
    c = 0.05

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("dynamics", instant.coordinates["x"].acceleration)
        terms.integrand = -instant.controls["u"]
        return terms

    problem = chain(
        phase("arch", inside, controls=[Unknown("u", scale=2.0)]),
        times={"start": (0.0, 0.0), "end": (1.0, 1.0)},
        fixed=at_rest("start", 0.0)
        | {("start", "u", "control"): 0.0, ("end", "u", "control"): 0.0},
        rate_cost={"u": c},
    )
    answer = solved(problem, 3, 3)
    assert answer.minimum.objective == pytest.approx(-1 / (48 * c), abs=1e-8)
    t = instants(answer.curves)
    np.testing.assert_allclose(
        dense(answer.curves, "control", "u"), t * (1 - t) / (4 * c), atol=1e-7
    )


@pytest.mark.parametrize("m", [2, 3])
def test_rows_between_instants_hold(m: int) -> None:
    """The costly second phase is as short as its row allows."""

    def inside(price: float) -> InstantFunction:
        def terms_at(instant: Instant) -> Terms:
            terms = Terms()
            terms.equal("dynamics", instant.coordinates["x"].acceleration)
            terms.integrand = price
            return terms

        return terms_at

    problem = chain(
        phase("cheap", inside(0.0), end="middle"),
        phase("dear", inside(1.0), start="middle"),
        times={"start": (0.0, 0.0), "middle": (0.0, 1.0), "end": (1.0, 1.0)},
        fixed=at_rest("start", 0.0),
        time_rows=[("shortest", {"end": 1.0, "middle": -1.0}, 0.3, np.inf)],
    )
    answer = solved(problem, 2, m)
    assert answer.curves.times["middle"] == pytest.approx(0.7, abs=1e-8)
    assert answer.minimum.objective == pytest.approx(0.3, abs=1e-8)
    assert answer.collocation.programme.violations(answer.minimum.x)["shortest"] < 1e-8


@pytest.mark.parametrize("m", [2, 3])
def test_a_link_holds_at_its_boundary(m: int) -> None:
    """Least effort to reach the line x + x' = 1 at the end: u falls as the costates say."""

    def line(instant: Instant) -> Terms:
        terms, x = Terms(), instant.coordinates["x"]
        terms.equal("line", x.value + x.rate - 1.0)
        return terms

    problem = chain(
        phase("reach", driven, controls=["u"], coordinates=[Coordinate("x", rate_scale=3.0)]),
        times={"start": (0.0, 0.0), "end": (1.0, 1.0)},
        fixed=at_rest("start", 0.0),
        links=[Link("line", "end", line)],
    )
    answer = solved(problem, 3, m)
    # u = c (1 + 1 - t) by the transversality conditions; x + x' = c (5/6 + 3/2) = 1 at t = 1
    c = 3 / 7
    t = instants(answer.curves)
    np.testing.assert_allclose(dense(answer.curves, "control", "u"), c * (2 - t), atol=1e-8)


def test_algebraic_unknowns_keep_their_bounds_at_the_ends_of_elements() -> None:
    """Nearest to 3 t - 1 in the mean square, but between 0 and 1 up to the ends: z = t."""

    def inside(instant: Instant) -> Terms:
        terms = Terms()
        terms.equal("dynamics", instant.coordinates["x"].acceleration)
        terms.integrand = (instant.algebraics["z"] - 3 * instant.time + 1) ** 2
        return terms

    def at_ends(instant: Instant) -> Terms:
        terms = Terms()
        terms.between("bounds of z", instant.algebraics["z"], 0.0, 1.0)
        return terms

    problem = chain(
        phase("fit", inside, algebraics=[Unknown("z", scale=2.0)], at_ends=at_ends),
        times={"start": (0.0, 0.0), "end": (1.0, 1.0)},
        fixed=at_rest("start", 0.0),
    )
    answer = solved(problem, 1, 2)
    np.testing.assert_allclose(
        dense(answer.curves, "algebraic", "z"), instants(answer.curves), atol=1e-7
    )
