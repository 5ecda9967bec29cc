"""Classical problems of nonlinear programming with known answers."""

from __future__ import annotations

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
