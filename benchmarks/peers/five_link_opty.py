"""The five-link walker in opty: SymPy equations, compiled, midpoint rule, IPOPT by cyipopt.

opty gives IPOPT no second derivatives, and its midpoint rule is of second order: the optimum on
its mesh differs from the exact one by an error that falls with the square of the node spacing.
"""

from __future__ import annotations

from importlib.metadata import version
from math import factorial

import five_link as walker
import numpy as np
import peer
import sympy as sm
from opty import Problem

N = walker.LINKS
T = walker.STEP_TIME
DEGREE = 22


def build(variant: str, elements: int) -> peer.Solver:
    """The programme of one variant on equal elements, as a function of the starting guess."""
    t = sm.symbols("t")
    q, v, u = ([sm.Function(f"{name}{i}")(t) for i in range(N)] for name in "qvu")
    rates = [x.diff(t) for x in v]
    equations = sm.Matrix(
        [x.diff(t) - y for x, y in zip(q, v, strict=True)]
        + [row / walker.EFFORT_SCALE**0.5 for row in _equations(q, v, rates, u)]
    )
    nodes, h = elements + 1, T / elements
    moments = slice(2 * N * nodes, 3 * N * nodes)

    def effort(free: np.ndarray) -> float:
        x = free[moments].reshape(N, nodes)
        left, right = x[:, :-1], x[:, 1:]
        return h / 3 * np.sum(left**2 + left * right + right**2) / walker.EFFORT_SCALE

    def gradient(free: np.ndarray) -> np.ndarray:
        x = free[moments].reshape(N, nodes)
        left, right = x[:, :-1], x[:, 1:]
        slope = np.zeros_like(x)
        slope[:, :-1] += 2 * left + right
        slope[:, 1:] += 2 * right + left
        found = np.zeros_like(free)
        found[moments] = h / 3 * slope.ravel() / walker.EFFORT_SCALE
        return found

    problem = Problem(
        effort,
        gradient,
        equations,
        tuple(q + v),
        nodes,
        h,
        instance_constraints=_boundary(variant, q, v, t),
        time_symbol=t,
        integration_method="midpoint",
    )
    problem.add_option("print_level", 0)
    problem.add_option("sb", "yes")
    problem.add_option("tol", 1e-9)
    problem.add_option("max_iter", 3000)

    def solve(start: walker.Start) -> peer.Outcome:
        at = np.linspace(0.0, T, nodes)
        parts = (start.angles(at), start.rates(at), start.controls(at))
        problem.obj_value.clear()
        _, info = problem.solve(np.concatenate([part.T.ravel() for part in parts]))
        return peer.Outcome(
            float(info["obj_val"]) * walker.EFFORT_SCALE,
            info["status"] == 0,
            len(problem.obj_value),
            info["status_msg"].decode(),
        )

    return solve


def _equations(q: list, v: list, a: list, u: list) -> list[sm.Expr]:
    return walker.equations(q, v, a, u, sm.sin, sm.cos)


def _boundary(variant: str, q: list, v: list, t: sm.Symbol) -> tuple[sm.Expr, ...]:
    """Rows between the states at the start and at the end of the step."""
    (q0, v0), (q1, v1) = (
        ([x.subs(t, at) for x in q], [x.subs(t, at) for x in v]) for at in (0.0, T)
    )
    if variant == "posture":
        ends = zip((q0, v0, q1, v1), walker.START_STATE + walker.END_STATE, strict=True)
        return tuple(x - y for xs, ys in ends for x, y in zip(xs, map(float, ys), strict=True))
    forward, up = walker.foot(q1, _sin, _cos)
    return (
        *(q0[i] - q1[N - 1 - i] for i in range(N)),
        *walker.strike(q1, v1, v0, _cos),
        forward - walker.STEP_LENGTH,
        up,
    )


def _cos(x: sm.Expr) -> sm.Expr:
    """Cosine as a polynomial, exact to 1e-10 up to 2.5 rad.

    opty takes every function in a boundary row for a state, ``cos`` too.
    """
    return _series(x, 0)


def _sin(x: sm.Expr) -> sm.Expr:
    """Sine as a polynomial, exact to 1e-10 up to 2.5 rad."""
    return _series(x, 1)


def _series(x: sm.Expr, first: int) -> sm.Expr:
    """Taylor's polynomial of alternating signs; as a plain sum its derivatives stay short."""
    powers = enumerate(range(first, DEGREE, 2))
    return sm.Add(*(sm.Float((-1) ** k / factorial(n)) * x**n for k, n in powers))


if __name__ == "__main__":
    peer.main(
        f"opty {version('opty')}, cyipopt {version('cyipopt')}",
        "{n} elements, midpoint rule",
        build,
        fine=200,
    )
