"""Nonlinear programmes of blocks: values and derivatives are those of the whole function."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from ergowalk.nlp import Block, Kernel, NonlinearProgramme

Array = NDArray[np.float64]

LAW = settings(deadline=None, max_examples=25, derandomize=True, database=None)

SIZE = 6
INF = float("inf")


def curved_kernel() -> Kernel:
    """Three variables, two parameters; cost and both rows nonlinear, the first sparse."""
    v, p = ca.SX.sym("v", 3), ca.SX.sym("p", 2)
    cost = p[0] * ca.sin(v[0]) * v[1] ** 2 + ca.exp(0.3 * v[2])
    rows = ca.vertcat(v[0] * v[2] - p[1], ca.cos(v[1]) * v[2] + v[0] ** 3)
    return Kernel("curved", v, p, cost, rows)


def plain_kernel() -> Kernel:
    """Two variables, no parameters."""
    v = ca.SX.sym("v", 2)
    row = v[0] * v[1] + v[1] ** 3
    return Kernel("plain", v, ca.SX.sym("none", 0), (v[0] - 2 * v[1]) ** 4, row)


def programme() -> NonlinearProgramme:
    """Blocks used often, once, and without parameters; uses share variables, also with
    themselves."""
    curved = Block(
        curved_kernel(),
        np.array([[0, 1, 2, 5], [1, 2, 3, 5], [2, 3, 4, 0]]),  # the last use takes 5 twice
        np.array([[0.5, -1.0, 2.0, 0.7], [0.1, 0.2, 0.3, 0.4]]),
        np.array([0.0, -INF]),
        np.array([0.0, 1.0]),
        ("first", "second"),
    )
    plain = Block(
        plain_kernel(),
        np.array([[4, 3, 1], [0, 5, 1]]),
        np.zeros((0, 3)),
        np.array([-2.0]),
        np.array([2.0]),
        ("second",),
    )
    once = Block(
        plain_kernel(),
        np.array([[5], [2]]),
        np.zeros((0, 1)),
        np.array([0.0]),
        np.array([INF]),
        ("third",),
    )
    return NonlinearProgramme(np.full(SIZE, -3.0), np.full(SIZE, 3.0), [curved, plain, once])


WHOLE = programme()


def as_one_function() -> tuple[ca.SX, ca.SX, ca.SX]:
    """x, objective and rows of :data:`WHOLE`, put together use by use."""
    x = ca.SX.sym("x", SIZE)
    cost, rows = ca.SX(0), []
    for block in WHOLE.blocks:
        for use in range(block.uses):
            local = ca.vertcat(*(x[int(i)] for i in block.indices[:, use]))
            c, g = block.kernel.values(local, ca.DM(block.parameters[:, use]))
            cost, rows = cost + c, [*rows, g]
    return x, cost, ca.vertcat(*rows)


X, COST, ROWS = as_one_function()
ROW_COUNT = ROWS.numel()

points = arrays(np.float64, SIZE, elements=st.floats(-2, 2, allow_subnormal=False))
weights = arrays(np.float64, ROW_COUNT, elements=st.floats(-2, 2, allow_subnormal=False))


def dense(value: ca.DM) -> Array:
    return np.asarray(value.full(), dtype=float)


def finite_differences(function: Callable[[Array], Array], x: Array, step: float = 1e-5) -> Array:
    """Central differences: column k is the derivative with respect to x[k]."""
    columns = [
        (function(x + step * unit) - function(x - step * unit)) / (2 * step)
        for unit in np.eye(len(x))
    ]
    return np.stack(columns, axis=-1)


@LAW
@given(points)
def test_objective_and_rows_are_those_of_all_uses(x: Array) -> None:
    cost, rows = WHOLE.oracle.values(x, [])
    whole = ca.Function("whole", [X], [COST, ROWS])(x)
    assert float(cost) == pytest.approx(float(whole[0]), rel=1e-13, abs=1e-13)
    np.testing.assert_allclose(dense(rows), dense(whole[1]), rtol=1e-13, atol=1e-13)


@LAW
@given(points)
def test_evaluation_without_derivatives_gives_the_same_numbers(x: Array) -> None:
    cost, rows = WHOLE.evaluate(x)
    expected = WHOLE.oracle.values(x, [])
    assert cost == pytest.approx(float(expected[0]), rel=1e-14, abs=1e-14)
    np.testing.assert_allclose(rows, dense(expected[1]).ravel(), rtol=1e-14, atol=1e-14)


@LAW
@given(points)
def test_gradient_is_that_of_the_whole_function(x: Array) -> None:
    _, gradient = WHOLE.oracle.gradient(x, [])
    own = ca.Function("own", [X], [ca.gradient(COST, X)])(x)
    np.testing.assert_allclose(dense(gradient), dense(own), rtol=1e-12, atol=1e-12)
    differences = finite_differences(lambda y: dense(WHOLE.oracle.values(y, [])[0]).ravel(), x)
    np.testing.assert_allclose(dense(gradient).ravel(), differences[0], rtol=1e-6, atol=1e-6)


def test_the_gradient_has_an_entry_for_every_variable() -> None:
    """Also for one that no block knows, and for one whose only block costs nothing."""
    v = ca.SX.sym("v")
    free = Kernel("free", v, ca.SX.sym("none", 0), ca.SX(0), v)
    block = Block(free, np.array([[1]]), np.zeros((0, 1)), np.zeros(1), np.zeros(1), ("held",))
    bounds = np.full(SIZE + 2, -3.0), np.full(SIZE + 2, 3.0)
    oracle = NonlinearProgramme(*bounds, [*WHOLE.blocks, block]).oracle
    assert oracle.gradient.nnz_out(1) == SIZE + 2
    alone = NonlinearProgramme(*(b[:3] for b in bounds), [block]).oracle
    assert alone.gradient.nnz_out(1) == 3


@LAW
@given(points)
def test_jacobian_is_that_of_the_whole_function(x: Array) -> None:
    _, jacobian = WHOLE.oracle.jacobian(x, [])
    own = ca.Function("own", [X], [ca.jacobian(ROWS, X)])(x)
    np.testing.assert_allclose(dense(jacobian), dense(own), rtol=1e-12, atol=1e-12)
    differences = finite_differences(lambda y: dense(WHOLE.oracle.values(y, [])[1]).ravel(), x)
    np.testing.assert_allclose(dense(jacobian), differences, rtol=1e-6, atol=1e-6)


@LAW
@given(points, st.floats(-2, 2, allow_subnormal=False), weights)
def test_hessian_is_that_of_the_whole_lagrangian(x: Array, weight: float, own: Array) -> None:
    upper = dense(WHOLE.oracle.hessian(x, [], weight, own))
    lagrangian = weight * COST + ca.dot(ca.DM(own), ROWS)
    expected = dense(ca.Function("own", [X], [ca.hessian(lagrangian, X)[0]])(x))
    np.testing.assert_allclose(upper, np.triu(expected), rtol=1e-12, atol=1e-12)

    def gradient(y: Array) -> Array:
        cost = dense(WHOLE.oracle.gradient(y, [])[1]).ravel()
        return np.asarray(weight * cost + dense(WHOLE.oracle.jacobian(y, [])[1]).T @ own)

    differences = finite_differences(gradient, x)
    np.testing.assert_allclose(upper, np.triu(differences), rtol=1e-6, atol=1e-5)


def test_jacobian_holds_no_entry_that_is_always_zero() -> None:
    """Sparsity is what makes large meshes cheap."""
    pattern = WHOLE.oracle.jacobian.sparsity_out(1)
    assert pattern.nnz() == ca.jacobian(ROWS, X).nnz()


def test_a_variable_that_two_uses_share_gets_both_contributions() -> None:
    v = ca.SX.sym("v")
    kernel = Kernel("square", v, ca.SX.sym("none", 0), v**2, 3 * v)
    block = Block(
        kernel,
        np.zeros((1, 2), dtype=np.int64),
        np.zeros((0, 2)),
        np.zeros(1),
        np.zeros(1),
        ("row",),
    )
    shared = NonlinearProgramme(np.array([-1.0]), np.array([1.0]), [block, block])
    x, count = 0.7, 4
    cost, gradient = shared.oracle.gradient([x], [])
    assert float(cost) == pytest.approx(count * x**2)
    assert float(gradient) == pytest.approx(count * 2 * x)
    np.testing.assert_allclose(dense(shared.oracle.jacobian([x], [])[1]), [[3.0]] * count)
    assert float(shared.oracle.hessian([x], [], 1.0, np.ones(count))) == pytest.approx(count * 2)


def test_a_programme_without_rows_is_only_its_objective() -> None:
    v = ca.SX.sym("v", 2)
    kernel = Kernel("bowl", v, ca.SX.sym("none", 0), v[0] ** 2 + v[0] * v[1], ca.SX(0, 1))
    block = Block(
        kernel,
        np.array([[0], [1]]),
        np.zeros((0, 1)),
        np.zeros(0),
        np.zeros(0),
        (),
    )
    bowl = NonlinearProgramme(np.full(2, -INF), np.full(2, INF), [block])
    assert bowl.labels == ()
    assert bowl.violations(np.array([1.0, 2.0])) == {}
    np.testing.assert_allclose(dense(bowl.oracle.gradient([1.0, 2.0], [])[1]).ravel(), [4.0, 1.0])
    upper = dense(bowl.oracle.hessian([1.0, 2.0], [], 1.0, []))
    np.testing.assert_allclose(upper, [[2.0, 1.0], [0.0, 0.0]])


def test_rows_stand_in_the_order_of_blocks_and_uses() -> None:
    lower, upper = WHOLE.row_bounds
    assert lower.tolist() == [0.0, -INF] * 4 + [-2.0] * 3 + [0.0]
    assert upper.tolist() == [0.0, 1.0] * 4 + [2.0] * 3 + [INF]
    assert WHOLE.labels == ("first", "second") * 4 + ("second",) * 3 + ("third",)
    assert WHOLE.size == SIZE
    assert [block.uses for block in WHOLE.blocks] == [4, 3, 1]


def test_violations_are_the_worst_of_each_name() -> None:
    rows = np.zeros(ROW_COUNT)
    rows[[0, 2]] = 0.3, -0.5  # "first" must be zero
    rows[3] = 1.25  # "second" at most 1 in this block ...
    rows[8] = -2.5  # ... and at least -2 in that one
    rows[11] = 7.0  # "third" has no upper bound
    found = WHOLE.violations(np.zeros(SIZE), rows)
    assert found == pytest.approx({"first": 0.5, "second": 0.5, "third": 0.0})


def test_violations_are_of_the_rows_at_a_point_if_none_are_given() -> None:
    x = np.linspace(-1.0, 1.0, SIZE)
    rows = dense(WHOLE.oracle.values(x, [])[1]).ravel()
    found = WHOLE.violations(x)
    assert found == WHOLE.violations(x, rows)
    assert found["first"] == pytest.approx(np.abs(rows[[0, 2, 4, 6]]).max())
    assert found["first"] > 0


# --- given functions that are expanded instead of differentiated through -------------------------


def expanded_kernel() -> Kernel:
    """v0 exp(v1) with exp as a Taylor polynomial around the present v1, computed beside it."""
    v, p = ca.SX.sym("v", 2), ca.SX.sym("p", 1)
    at, value = ca.SX.sym("at"), ca.SX.sym("value")
    step = v[1] - at
    exp = value * (1 + step + step**2 / 2)  # e^x is its own derivative
    rows = ca.vertcat(p[0] * v[0] * exp, v[0] - v[1])

    def expansion(variables: ca.MX, parameters: ca.MX) -> ca.MX:
        return ca.vertcat(variables[1, :], ca.exp(variables[1, :]))

    return Kernel("expanded", v, ca.vertcat(p, at, value), v[0] ** 2 * exp, rows, expansion)


@LAW
@given(points, weights)
def test_an_expanded_function_has_its_exact_derivatives(x: Array, own: Array) -> None:
    block = Block(
        expanded_kernel(),
        np.array([[0, 2, 4], [1, 3, 1]]),
        np.array([[1.0, -2.0, 0.5]]),
        np.full(2, -INF),
        np.full(2, INF),
        ("one", "two"),
    )
    oracle = NonlinearProgramme(np.full(SIZE, -3.0), np.full(SIZE, 3.0), [block]).oracle
    cost: ca.SX = ca.SX(0)
    rows = []
    for (i, j), p in zip(block.indices.T.tolist(), block.parameters[0], strict=True):
        cost = cost + X[i] ** 2 * ca.exp(X[j])
        rows += [p * X[i] * ca.exp(X[j]), X[i] - X[j]]
    rows = ca.vertcat(*rows)
    lagrangian = 0.7 * cost + ca.dot(ca.DM(own[:6]), rows)
    derivatives = [cost, rows, ca.gradient(cost, X), ca.jacobian(rows, X)]
    derivatives.append(ca.triu(ca.hessian(lagrangian, X)[0]))
    expected = [dense(value) for value in ca.Function("own", [X], derivatives)(x)]
    value, found_rows = oracle.values(x, [])
    found = [value, found_rows, oracle.gradient(x, [])[1], oracle.jacobian(x, [])[1]]
    found.append(oracle.hessian(x, [], 0.7, own[:6]))
    for one, two in zip(found, expected, strict=True):
        np.testing.assert_allclose(dense(one), two, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("name", ["heel strike", "a+b", "1st", "toe__off", " (4) "])
def test_a_kernel_may_be_called_anything(name: str) -> None:
    x = ca.SX.sym("x")
    kernel = Kernel(name, x, ca.SX.sym("none", 0), x**2, 2 * x)
    cost, rows = kernel.values(3.0, [])
    assert (float(cost), float(rows)) == (9.0, 6.0)
    assert float(kernel.jacobian(3.0, [])) == 2.0
