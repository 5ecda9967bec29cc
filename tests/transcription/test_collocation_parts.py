"""The parts of collocation: where unknowns stand, packing and unpacking, rows, multipliers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Guess, Samples
from ergowalk.transcription.edges import fourier
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.phases import (
    Coordinate,
    Instant,
    Link,
    PhasedProblem,
    PhaseModel,
    Terms,
    Unknown,
)

from .toys import at_rest, chain, nothing, phase, solved

Array = NDArray[np.float64]

LAW = settings(deadline=None, max_examples=30, derandomize=True, database=None)

TIMES = {"start": 0.0, "middle": 0.8, "end": 2.0}
MESH = (np.array([0.0, 0.2, 0.7, 1.0]), np.array([0.0, 0.4, 1.0]))


def two_phases() -> PhasedProblem:
    """Different unknowns in each phase, scales of all kinds, absolute values in the first."""

    def first(instant: Instant) -> Terms:
        terms, x, y = Terms(), instant.coordinates["x"], instant.coordinates["y"]
        u, z = instant.controls["u"], instant.algebraics["z"]
        terms.equal("first", x.acceleration - u, y.acceleration - z)
        terms.absolute = [u * x.rate, z * y.rate]
        return terms

    def second(instant: Instant) -> Terms:
        terms, x = Terms(), instant.coordinates["x"]
        terms.between("second", x.acceleration - instant.controls["v"], -1.0, 2.0)
        terms.integrand = x.value**2
        return terms

    x = Coordinate("x", rate_scale=3.0, acceleration_scale=30.0)
    y = Coordinate("y", rate_scale=2.0, acceleration_scale=5.0)
    u, v = Unknown("u", scale=7.0), Unknown("v")
    return chain(
        phase(
            "first",
            first,
            coordinates=[x, y],
            controls=[u],
            algebraics=[Unknown("z", scale=10.0)],
            end="middle",
            absolute_scale=4.0,
        ),
        phase("second", second, coordinates=[x], controls=[u, v], start="middle"),
        times={"start": (0.0, 0.0), "middle": (0.5, 1.5), "end": (1.0, 3.0)},
        exchange={"x": "x", "v": "u"},
    )


PROBLEM = two_phases()


def polynomials(coefficients: Mapping[str, Array], m: int) -> Guess:
    """Curves of time that the elements can hold, and that the exchange allows.

    Positions have degree m + 1 (x is the same at both ends: it stays constant), controls are
    straight, with three Gauss points or more parabolas; algebraics have degree m - 1.
    """
    place = {"x": Polynomial(coefficients["x"][:1]), "y": Polynomial(coefficients["y"][: m + 2])}
    push = Polynomial(coefficients["u"][: 2 if m == 2 else 3])
    slope = coefficients["v"][1]
    other = Polynomial([push(0.0) - slope * TIMES["end"], slope])  # v at the end is u at the start
    algebraic = {"z": Polynomial(coefficients["z"][:m])}

    def guess(i: int, fractions: Array) -> Samples:
        start, end = (("start", "middle"), ("middle", "end"))[i]
        t = TIMES[start] + (TIMES[end] - TIMES[start]) * fractions
        values, rates, accelerations = (
            {n: (p.deriv(k) if k else p)(t) for n, p in place.items()} for k in (0, 1, 2)
        )
        return Samples(
            values,
            rates,
            accelerations,
            {"u": push(t), "v": other(t)},
            {n: p(t) for n, p in algebraic.items()},
        )

    return guess


numbers = arrays(np.float64, 6, elements=st.floats(-3, 3, allow_subnormal=False))
tables = st.fixed_dictionaries(dict.fromkeys(("x", "y", "u", "v", "z"), numbers))
COLLOCATIONS = {m: Collocation(PROBLEM, MESH, m) for m in (2, 3, 4)}


# --- packing and unpacking ---------------------------------------------------------------------


@LAW
@given(tables, st.sampled_from([2, 3, 4]))
def test_unpacking_what_was_packed_gives_polynomials_back(
    coefficients: dict[str, Array], m: int
) -> None:
    guess = polynomials(coefficients, m)
    curves = COLLOCATIONS[m].unpack(COLLOCATIONS[m].pack(guess, TIMES))
    assert curves.times == TIMES
    fractions = np.linspace(0.0, 1.0, 23)
    for i, piece in enumerate(curves.phases):
        found, wanted = piece.at(fractions), guess(i, fractions)
        for kind in ("value", "rate", "acceleration", "control", "algebraic"):
            for name, curve in getattr(found, kind).items():
                np.testing.assert_allclose(curve, getattr(wanted, kind)[name], atol=1e-9)


@LAW
@given(tables, st.sampled_from([2, 3]))
def test_a_packed_guess_has_one_slack_of_each_power(coefficients: dict[str, Array], m: int) -> None:
    collocation = COLLOCATIONS[m]
    x = collocation.pack(polynomials(coefficients, m), TIMES)
    for where in collocation.layout.phases:
        assert np.all(x[where.plus] * x[where.minus] == 0.0)
    assert collocation.programme.violations(x)["power slacks"] < 1e-12


def test_a_guess_out_of_bounds_is_moved_inside() -> None:
    collocation = COLLOCATIONS[2]
    zero = dict.fromkeys(("x", "y", "u", "v", "z"), np.zeros(6))
    x = collocation.pack(polynomials(zero, 2), {"start": 0.3, "middle": 9.0, "end": 0.1})
    layout = collocation.layout
    assert np.all(x >= layout.lower) and np.all(x <= layout.upper)
    found = collocation.unpack(x).times
    assert found == {"start": 0.0, "middle": 1.5, "end": 1.0}


def test_curves_serve_as_a_guess_on_another_mesh() -> None:
    rng = np.random.default_rng(3)
    table = {name: rng.normal(size=6) for name in ("x", "y", "u", "v", "z")}
    curves = COLLOCATIONS[3].unpack(COLLOCATIONS[3].pack(polynomials(table, 3), TIMES))
    other = Collocation(PROBLEM, (np.linspace(0, 1, 6), np.linspace(0, 1, 4)), 3)
    again = other.unpack(other.pack(curves.as_guess(), curves.times))
    fractions = np.linspace(0.0, 1.0, 19)
    for kind, name in (("value", "y"), ("rate", "y"), ("control", "u")):
        for_mesh = [getattr(t.phases[0].at(fractions), kind)[name] for t in (curves, again)]
        np.testing.assert_allclose(for_mesh[1], for_mesh[0], atol=1e-9)


# --- where unknowns stand ----------------------------------------------------------------------


def test_every_unknown_has_its_own_place() -> None:
    layout = COLLOCATIONS[2].layout
    inner = [
        index
        for where in layout.phases
        for kind in (where.accelerations, where.algebraics, where.plus, where.minus)
        for index in kind.ravel()
    ]
    points = {
        int(index)
        for where in layout.phases
        for kind in (where.values, where.rates, where.controls)
        for index in kind.ravel()
    }
    assert len(set(inner)) == len(inner)
    assert not set(inner) & points
    assert not set(layout.times.values()) & (points | set(inner))
    assert max(*inner, *points) < layout.size


def test_unknowns_at_a_boundary_are_shared_by_both_phases() -> None:
    first, second = COLLOCATIONS[2].layout.phases
    assert first.values[-1, 0] == second.values[0, 0]  # x
    assert first.rates[-1, 0] == second.rates[0, 0]
    assert first.controls[-1, 0] == second.controls[0, 0]  # u
    assert first.times[1] == second.times[0]


def test_exchanged_unknowns_at_the_end_are_those_at_the_start() -> None:
    first, second = COLLOCATIONS[2].layout.phases
    assert second.values[-1, 0] == first.values[0, 0]  # x -> x
    assert second.rates[-1, 0] == first.rates[0, 0]
    assert second.controls[-1, 1] == first.controls[0, 0]  # v at the end is u at the start
    assert second.controls[-1, 0] not in first.controls  # u at the end is not exchanged


def test_an_unknown_count_grows_by_the_same_number_with_every_element() -> None:
    sizes = []
    for n in (2, 3, 7):
        mesh = (np.linspace(0, 1, n + 1), MESH[1])
        sizes.append(Collocation(PROBLEM, mesh, 3).layout.size)
    per_element = sizes[1] - sizes[0]
    assert sizes[2] - sizes[1] == 4 * per_element
    # two coordinates with rates and a control at the mesh point, its bulge in the element; two
    # accelerations, one algebraic and two pairs of slacks at three Gauss points
    assert per_element == 2 * 2 + 1 + 1 + 3 * (2 + 1 + 2 * 2)


def test_bounds_are_scaled_with_their_unknowns() -> None:
    model = phase(
        "bounded",
        nothing,
        coordinates=[Coordinate("x", lower=-0.5, upper=0.25)],
        controls=[Unknown("u", -14.0, 21.0, scale=7.0)],
        algebraics=[Unknown("z", 0.0, 30.0, scale=10.0)],
    )
    problem = chain(model, times={"start": (0.0, 0.0), "end": (1.0, 1.0)})
    layout = Collocation(problem, (np.linspace(0, 1, 3),), 2).layout
    where = layout.phases[0]
    for kind, low, high in ((where.values, -0.5, 0.25), (where.controls, -2, 3)):
        np.testing.assert_array_equal(layout.lower[kind], low)
        np.testing.assert_array_equal(layout.upper[kind], high)
    np.testing.assert_array_equal(layout.lower[where.algebraics], 0.0)
    np.testing.assert_array_equal(layout.upper[where.algebraics], 3.0)
    np.testing.assert_array_equal(layout.scale[where.controls], 7.0)


def test_fixed_values_are_bounds_that_meet() -> None:
    model = phase("still", nothing, controls=[Unknown("u", scale=7.0)])
    fixed = at_rest("start", 0.25) | {("end", "u", "control"): 3.5}
    problem = chain(model, times={"start": (0.0, 0.0), "end": (1.0, 1.0)}, fixed=fixed)
    layout = Collocation(problem, (np.linspace(0, 1, 3),), 2).layout
    for key, number in ((("start", "x", "value"), 0.25), (("end", "u", "control"), 0.5)):
        index = layout.boundary[key]
        assert layout.lower[index] == layout.upper[index] == number


def test_bounds_of_both_phases_hold_at_their_boundary() -> None:
    first = phase("first", nothing, controls=[Unknown("u", -1.0, 5.0)], end="middle")
    second = phase("second", nothing, controls=[Unknown("u", -3.0, 2.0)], start="middle")
    problem = chain(
        first, second, times={"start": (0.0, 0.0), "middle": (1.0, 1.0), "end": (2.0, 2.0)}
    )
    layout = Collocation(problem, (np.array([0.0, 1.0]),) * 2, 2).layout
    index = layout.boundary["middle", "u", "control"]
    assert (layout.lower[index], layout.upper[index]) == (-1.0, 2.0)


# --- rows --------------------------------------------------------------------------------------


def seen_by(everywhere: bool) -> tuple[list[tuple[str, ...]], PhaseModel]:
    """Which unknowns a path function is shown."""
    seen: list[tuple[str, ...]] = []

    def path(instant: Instant) -> Terms:
        seen.append(tuple(instant.algebraics))
        terms = Terms()
        terms.between("path", instant.coordinates["x"].value, -1.0, 1.0)
        return terms

    model = phase(
        "watched",
        nothing,
        algebraics=[Unknown("z")],
        path=path,
        path_everywhere=everywhere,
    )
    return seen, model


@pytest.mark.parametrize(("everywhere", "rows"), [(False, 2), (True, 4)])
def test_path_constraints_are_asked_at_mesh_points_and_inside(everywhere: bool, rows: int) -> None:
    """With three Gauss points: the mesh point and the middle one, or the mesh point and all."""
    seen, model = seen_by(everywhere)
    problem = chain(model, times={"start": (0.0, 0.0), "end": (1.0, 1.0)})
    collocation = Collocation(problem, (np.linspace(0, 1, 3),), 3)
    assert collocation.programme.labels.count("path") == 2 * rows
    assert () in seen  # at a mesh point there are no algebraics
    assert (("z",) in seen) == everywhere


def test_rows_carry_the_names_of_their_constraints() -> None:
    programme = COLLOCATIONS[2].programme
    counts = {name: programme.labels.count(name) for name in set(programme.labels)}
    elements, gauss = (3, 2), 2
    assert counts == {
        "continuity": elements[0] * 4 + elements[1] * 2,
        "first": elements[0] * gauss * 2,
        "second": elements[1] * gauss,
        "power slacks": elements[0] * gauss * 2,
    }
    lower, upper = programme.row_bounds
    second = [i for i, name in enumerate(programme.labels) if name == "second"]
    assert set(lower[second]) == {-1.0} and set(upper[second]) == {2.0}


def test_a_constraint_that_is_broken_is_named() -> None:
    collocation = COLLOCATIONS[2]
    zero = dict.fromkeys(("x", "y", "u", "v", "z"), np.zeros(6))
    x = collocation.pack(polynomials(zero, 2), TIMES)
    assert max(collocation.programme.violations(x).values()) == 0.0
    x[collocation.layout.phases[1].accelerations[0, 1, 0]] = 5.0 / 30.0  # x'' = 5 > 2
    worst = collocation.programme.violations(x)
    assert worst["second"] == pytest.approx(3.0)
    assert worst["continuity"] > 0
    assert worst["first"] == worst["power slacks"] == 0.0


def test_a_finer_mesh_uses_the_same_kernels() -> None:
    kernels = KernelStore()
    one = Collocation(PROBLEM, MESH, 2, kernels)
    two = Collocation(PROBLEM, (np.linspace(0, 1, 9), MESH[1]), 2, kernels)
    assert all(a is b for a, b in zip(one.kernels, two.kernels, strict=True))
    three = Collocation(PROBLEM, MESH, 3, kernels)
    assert all(a is not b for a, b in zip(one.kernels, three.kernels, strict=True))
    assert one.elements == 5 and two.elements == 10


def test_derivatives_of_the_programme_are_those_of_its_values() -> None:
    """Central differences of a whole programme, with links, rows of time and a shared unknown."""

    def link(instant: Instant) -> Terms:
        terms = Terms()
        x = instant.coordinates["x"]
        terms.equal("link", ca.sin(x.value) * x.rate - instant.time * instant.shared["s"])
        return terms

    def third(instant: Instant) -> Terms:
        terms, x = Terms(), instant.coordinates["x"]
        push = instant.curves["push"] * instant.shared["middle"]
        terms.equal("third", x.acceleration - push, x.rate * instant.shared["s"] ** 2)
        terms.integrand = x.value**2 * instant.shared["s"]
        return terms

    given = {"control_rates": {"u": 3.0}, "control_rate_cost": {"u": 0.2, "v": 0.1}}
    first, second = (replace(p, **given) for p in PROBLEM.phases)
    shared, middle = Unknown("s", 0.0, 2.0, scale=0.5), Unknown("middle")
    push = fourier(("push",), np.array([[0.3, 1.0, 0.0, 0.4]]), 2.0)
    problem = replace(
        PROBLEM,
        phases=(
            first,
            replace(
                second,
                inside=third,
                shared=(middle, shared),
                curves=(replace(push, names=("unused",)), replace(push, later="s")),
            ),
        ),
        links=(Link("link", "middle", link),),
        time_rows=(("order", {"end": 1.0, "middle": -2.0, "s": 0.7}, 0.0, 1.0),),
        shared=(shared,),
    )
    programme = Collocation(problem, MESH, 2).programme
    oracle, rng = programme.oracle, np.random.default_rng(11)
    x = rng.uniform(0.3, 1.2, programme.size)
    weights, d = rng.normal(size=len(programme.labels)), rng.normal(size=programme.size)
    step = 1e-6

    def along(y: Array) -> tuple[Array, Array]:
        """Cost and rows, gradient of the Lagrangian."""
        cost, rows = oracle.values(y, [])
        slope = np.asarray(oracle.gradient(y, [])[1]).ravel()
        jacobian = oracle.jacobian(y, [])[1]
        lagrangian = slope + np.asarray(jacobian.T @ ca.DM(weights)).ravel()
        return np.concatenate([[float(cost)], np.asarray(rows).ravel()]), lagrangian

    (high, high_slope), (low, low_slope) = along(x + step * d), along(x - step * d)
    gradient = np.asarray(oracle.gradient(x, [])[1]).ravel()
    jacobian = np.asarray(oracle.jacobian(x, [])[1] @ ca.DM(d)).ravel()
    expected = np.concatenate([[gradient @ d], jacobian])
    np.testing.assert_allclose((high - low) / (2 * step), expected, rtol=1e-6, atol=1e-6)
    upper = np.asarray(oracle.hessian(x, [], 1.0, weights))
    curvature = (upper + upper.T - np.diag(np.diag(upper))) @ d
    np.testing.assert_allclose(
        (high_slope - low_slope) / (2 * step), curvature, rtol=1e-5, atol=1e-5
    )


# --- multipliers -------------------------------------------------------------------------------


def oscillator() -> PhasedProblem:
    """A smooth optimum with a bound that is active: least |work| and effort of a driven mass."""

    def inside(instant: Instant) -> Terms:
        terms, x, u = Terms(), instant.coordinates["x"], instant.controls["u"]
        terms.equal("dynamics", x.acceleration + x.value - u)
        terms.absolute = [u * x.rate]
        terms.integrand = 0.1 * u**2
        return terms

    return chain(
        phase("drive", inside, controls=[Unknown("u", -1.1, 1.1)]),
        times={"start": (0.0, 0.0), "end": (2.0, 2.0)},
        fixed=at_rest("start", 0.0) | at_rest("end", 1.0),
        rate_cost={"u": 1e-3},
    )


def test_carried_multipliers_fit_the_finer_mesh() -> None:
    problem = oscillator()
    coarse = solved(problem, 6, 2)
    fine = Collocation(problem, (np.linspace(0, 1, 13),), 2)
    variables, rows = fine.carry_multipliers(
        coarse.collocation, coarse.minimum.variable_multipliers, coarse.minimum.row_multipliers
    )
    assert variables.shape == (fine.layout.size,)
    assert rows.shape == (len(fine.programme.labels),)
    assert np.all(np.isfinite(variables)) and np.all(np.isfinite(rows))
    exact = solved(problem, 12, 2).minimum
    wanted = [i for i, name in enumerate(fine.programme.labels) if name == "continuity"]
    size = np.abs(exact.row_multipliers[wanted]).max()
    assert np.abs(rows - exact.row_multipliers)[wanted].max() < 0.35 * size


def test_multipliers_carried_to_the_same_mesh_stay_what_they_are() -> None:
    answer = solved(oscillator(), 6, 2)
    variables, rows = answer.collocation.carry_multipliers(
        answer.collocation, answer.minimum.variable_multipliers, answer.minimum.row_multipliers
    )
    np.testing.assert_allclose(rows, answer.minimum.row_multipliers, atol=1e-15)
    where = answer.collocation.layout.phases[0]
    for kind in (where.plus, where.minus):
        np.testing.assert_allclose(
            variables[kind], answer.minimum.variable_multipliers[kind], atol=1e-15
        )


def test_terms_collect_rows_under_their_labels() -> None:
    terms = Terms()
    terms.equal("a", 1, 2)
    terms.between("b", 3, -1.0, 1.0)
    terms.nonnegative("c", 4)
    assert terms.rows == [
        ("a", 1, 0.0, 0.0),
        ("a", 2, 0.0, 0.0),
        ("b", 3, -1.0, 1.0),
        ("c", 4, 0.0, float("inf")),
    ]
