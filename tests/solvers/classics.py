"""Classical problems of nonlinear programming with known answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.nlp import Block, Kernel, NonlinearProgramme

Array = NDArray[np.float64]
INF = float("inf")


def single_block(
    v: ca.SX,
    cost: ca.SX,
    rows: list[tuple[ca.SX, float, float]],
    lower: float | Array = -INF,
    upper: float | Array = INF,
) -> NonlinearProgramme:
    """One kernel used once; rows are (expression, lower, upper)."""
    n = v.numel()
    expressions = ca.vertcat(*(row[0] for row in rows)) if rows else ca.SX(0, 1)
    kernel = Kernel("classic", v, ca.SX.sym("none", 0), cost, expressions)
    block = Block(
        kernel,
        np.arange(n)[:, None],
        np.zeros((0, 1)),
        np.array([row[1] for row in rows]),
        np.array([row[2] for row in rows]),
        tuple(f"row {i}" for i in range(len(rows))),
    )
    return NonlinearProgramme(
        np.broadcast_to(np.asarray(lower, dtype=float), n).copy(),
        np.broadcast_to(np.asarray(upper, dtype=float), n).copy(),
        [block],
    )


def rosenbrock_valley(n: int = 2) -> NonlinearProgramme:
    """Chained Rosenbrock function, each link a use of one kernel; minimum 0 at (1, ..., 1)."""
    v = ca.SX.sym("v", 2)
    cost = 100 * (v[1] - v[0] ** 2) ** 2 + (1 - v[0]) ** 2
    kernel = Kernel("valley", v, ca.SX.sym("none", 0), cost, ca.SX(0, 1))
    links = np.stack([np.arange(n - 1), np.arange(1, n)])
    block = Block(kernel, links, np.zeros((0, n - 1)), np.zeros(0), np.zeros(0), ())
    return NonlinearProgramme(np.full(n, -INF), np.full(n, INF), [block])


ROSENBROCK_START = np.array([-1.2, 1.0])


def hock_schittkowski_71() -> NonlinearProgramme:
    """HS071: W. Hock and K. Schittkowski, Test Examples for Nonlinear Programming Codes, 1981."""
    x = ca.SX.sym("x", 4)
    cost = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]
    rows = [
        (x[0] * x[1] * x[2] * x[3], 25.0, INF),
        (ca.sumsqr(x), 40.0, 40.0),
    ]
    return single_block(x, cost, rows, 1.0, 5.0)


HS71_START = np.array([1.0, 5.0, 5.0, 1.0])
HS71_MINIMUM = 17.0140173
HS71_POINT = np.array([1.0, 4.74299963, 3.82114998, 1.37940829])
HS71_MULTIPLIERS = np.array([-0.55229366, 0.16146857])
"""From the tutorial of IPOPT, which solves this problem, with the signs of its Lagrangian."""


def corner_of_a_polygon() -> NonlinearProgramme:
    """Maximise 3 x + 5 y, x <= 4, 2 y <= 12, 3 x + 2 y <= 18, x, y >= 0: 36 at (2, 6).

    Hillier and Lieberman's Wyndor Glass example.
    """
    x = ca.SX.sym("x", 2)
    rows = [(2 * x[1], -INF, 12.0), (3 * x[0] + 2 * x[1], -INF, 18.0)]
    return single_block(x, -(3 * x[0] + 5 * x[1]), rows, 0.0, np.array([4.0, INF]))


def line_past_a_circle() -> NonlinearProgramme:
    """No point is in the unit circle and on x + y = 4."""
    x = ca.SX.sym("x", 2)
    rows = [(ca.sumsqr(x), -INF, 1.0), (x[0] + x[1], 4.0, 4.0)]
    return single_block(x, x[0], rows)


@dataclass(frozen=True)
class Known:
    """A function or a programme with its usual start and its known answer."""

    name: str
    problem: Any
    start: Array
    minimum: float
    point: Array

    def __repr__(self) -> str:
        return self.name


def known(name: str, problem: Any, start: Sequence[float], minimum: float, *point: float) -> Known:
    return Known(name, problem, np.array(start, dtype=float), minimum, np.array(point))


def valleys(x: Array) -> float:
    """Extended Rosenbrock function: one valley for each pair of variables."""
    return float(np.sum(100 * (x[1::2] - x[::2] ** 2) ** 2 + (1 - x[::2]) ** 2))


def beale(x: Array) -> float:
    a, b = x
    return float((1.5 - a + a * b) ** 2 + (2.25 - a + a * b**2) ** 2 + (2.625 - a + a * b**3) ** 2)


def wood(x: Array) -> float:
    a, b, c, d = x
    one = 100 * (b - a * a) ** 2 + (1 - a) ** 2 + 90 * (d - c * c) ** 2 + (1 - c) ** 2
    return float(one + 10.1 * ((b - 1) ** 2 + (d - 1) ** 2) + 19.8 * (b - 1) * (d - 1))


def powell_singular(x: Array) -> float:
    """Its Hessian has rank two at the minimum."""
    a, b, c, d = x
    return float((a + 10 * b) ** 2 + 5 * (c - d) ** 2 + (b - 2 * c) ** 4 + 10 * (a - d) ** 4)


FUNCTIONS = (
    known("valley", valleys, (-1.2, 1), 0.0, 1, 1),
    known("valleys", valleys, (-1.2, 1, -1.2, 1), 0.0, 1, 1, 1, 1),
    known("beale", beale, (1, 1), 0.0, 3, 0.5),
    known("wood", wood, (-3, -1, -3, -1), 0.0, 1, 1, 1, 1),
    known("powell singular", powell_singular, (3, -1, 0, 1), 0.0, 0, 0, 0, 0),
)
"""J. J. More, B. S. Garbow and K. E. Hillstrom, Testing Unconstrained Optimization Software,
ACM Transactions on Mathematical Software 7 (1981), 17-41: problems 21, 5, 14 and 13."""


def hock_schittkowski_1() -> NonlinearProgramme:
    x = ca.SX.sym("x", 2)
    cost = 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2
    return single_block(x, cost, [], np.array([-INF, -1.5]))


def hock_schittkowski_6() -> NonlinearProgramme:
    x = ca.SX.sym("x", 2)
    return single_block(x, (1 - x[0]) ** 2, [(10 * (x[1] - x[0] ** 2), 0.0, 0.0)])


def hock_schittkowski_12() -> NonlinearProgramme:
    x = ca.SX.sym("x", 2)
    cost = 0.5 * x[0] ** 2 + x[1] ** 2 - x[0] * x[1] - 7 * x[0] - 7 * x[1]
    return single_block(x, cost, [(4 * x[0] ** 2 + x[1] ** 2, -INF, 25.0)])


def hock_schittkowski_21() -> NonlinearProgramme:
    x = ca.SX.sym("x", 2)
    cost = 0.01 * x[0] ** 2 + x[1] ** 2 - 100
    rows = [(10 * x[0] - x[1], 10.0, INF)]
    return single_block(x, cost, rows, np.array([2.0, -50.0]), np.array([50.0, 50.0]))


def hock_schittkowski_24() -> NonlinearProgramme:
    x, root = ca.SX.sym("x", 2), 3**0.5
    cost = ((x[0] - 3) ** 2 - 9) * x[1] ** 3 / (27 * root)
    rows = [(x[0] / root - x[1], 0.0, INF), (x[0] + root * x[1], 0.0, 6.0)]
    return single_block(x, cost, rows, 0.0)


def hock_schittkowski_35() -> NonlinearProgramme:
    x = ca.SX.sym("x", 3)
    squares = 2 * x[0] ** 2 + 2 * x[1] ** 2 + x[2] ** 2 + 2 * x[0] * x[1] + 2 * x[0] * x[2]
    cost = 9 - 8 * x[0] - 6 * x[1] - 4 * x[2] + squares
    return single_block(x, cost, [(x[0] + x[1] + 2 * x[2], -INF, 3.0)], 0.0)


def hock_schittkowski_43() -> NonlinearProgramme:
    """Rosen and Suzuki."""
    v = ca.SX.sym("x", 4)
    a, b, c, d = ca.vertsplit(v)
    cost = a**2 + b**2 + 2 * c**2 + d**2 - 5 * a - 5 * b - 21 * c + 7 * d
    rows = [
        (a**2 + b**2 + c**2 + d**2 + a - b + c - d, -INF, 8.0),
        (a**2 + 2 * b**2 + c**2 + 2 * d**2 - a - d, -INF, 10.0),
        (2 * a**2 + b**2 + c**2 + 2 * a - b - d, -INF, 5.0),
    ]
    return single_block(v, cost, rows)


def hock_schittkowski_76() -> NonlinearProgramme:
    v = ca.SX.sym("x", 4)
    a, b, c, d = ca.vertsplit(v)
    cost = a**2 + 0.5 * b**2 + c**2 + 0.5 * d**2 - a * c + c * d - a - 3 * b + c - d
    rows = [
        (a + 2 * b + c + d, -INF, 5.0),
        (3 * a + b + 2 * c - d, -INF, 4.0),
        (b + 4 * c, 1.5, INF),
    ]
    return single_block(v, cost, rows, 0.0)


PROGRAMMES = (
    known("HS1", hock_schittkowski_1, (-2, 1), 0.0, 1, 1),
    known("HS6", hock_schittkowski_6, (-1.2, 1), 0.0, 1, 1),
    known("HS12", hock_schittkowski_12, (0, 0), -30.0, 2, 3),
    known("HS21", hock_schittkowski_21, (-1, -1), -99.96, 2, 0),
    known("HS24", hock_schittkowski_24, (1, 0.5), -1.0, 3, 3**0.5),
    known("HS35", hock_schittkowski_35, (0.5, 0.5, 0.5), 1 / 9, 4 / 3, 7 / 9, 4 / 9),
    known("HS43", hock_schittkowski_43, (0, 0, 0, 0), -44.0, 0, 1, 2, -1),
    known("HS71", hock_schittkowski_71, HS71_START.tolist(), HS71_MINIMUM, *HS71_POINT),
    known("HS76", hock_schittkowski_76, (0.5,) * 4, -103 / 22, 3 / 11, 23 / 11, 0, 6 / 11),
)
"""W. Hock and K. Schittkowski, Test Examples for Nonlinear Programming Codes, 1981. The answer of
HS71 is IPOPT's; the others are exact."""
