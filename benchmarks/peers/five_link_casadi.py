"""The five-link walker in plain CasADi: collocation by hand, IPOPT with exact derivatives."""

from __future__ import annotations

import casadi as ca
import five_link as walker
import numpy as np
import peer

DEGREE = 3
N = walker.LINKS


def build(variant: str, elements: int) -> peer.Solver:
    """The programme of one variant on equal elements, as a function of the starting guess.

    Unknowns are angles, rates at the ends of elements and at the Gauss points, and moments at the
    Gauss points; everything is one SX expression, whose derivatives CasADi takes.
    """
    points = np.array(ca.collocation_points(DEGREE, "legendre"))
    slopes, ends, weights = (
        np.array(matrix)
        for matrix in ca.collocation_coeff(ca.collocation_points(DEGREE, "legendre"))
    )
    h = walker.STEP_TIME / elements
    unknowns, rows, effort = [], [], ca.SX(0)
    left = first = ca.SX.sym("x_0", 2 * N)
    unknowns.append(left)
    for k in range(elements):
        inner = ca.SX.sym(f"x_{k}_c", 2 * N, DEGREE)
        moments = ca.SX.sym(f"u_{k}", N, DEGREE)
        unknowns += [ca.vec(inner), ca.vec(moments)]
        states = ca.horzcat(left, inner)
        rates = states @ slopes / h
        for j in range(DEGREE):
            q, v = inner[:N, j], inner[N:, j]
            rows.append(rates[:N, j] - v)
            u = ca.vertsplit(moments[:, j])
            rows += walker.equations(
                ca.vertsplit(q), ca.vertsplit(v), ca.vertsplit(rates[N:, j]), u, ca.sin, ca.cos
            )
            effort += h * weights[j] * ca.sumsqr(moments[:, j])
        left = ca.SX.sym(f"x_{k + 1}", 2 * N)
        unknowns.append(left)
        rows.append(left - states @ ends)
    rows += _boundary(variant, first, left)
    x = ca.vertcat(*unknowns)
    solver = ca.nlpsol(
        "five_link",
        "ipopt",
        {"x": x, "f": effort / walker.EFFORT_SCALE, "g": ca.vertcat(*rows)},
        {
            "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9, "max_iter": 500},
            "print_time": False,
        },
    )

    def solve(start: walker.Start) -> peer.Outcome:
        answer = solver(x0=_packed(start, elements, h, points), lbg=0, ubg=0)
        stats = solver.stats()
        return peer.Outcome(
            float(answer["f"]) * walker.EFFORT_SCALE,
            bool(stats["success"]),
            int(stats["iter_count"]),
            str(stats["return_status"]),
        )

    return solve


def _boundary(variant: str, first: ca.SX, last: ca.SX) -> list[ca.SX]:
    """Rows between the states (10,) at the start and at the end of the step."""
    if variant == "posture":
        return [
            first - np.concatenate(walker.START_STATE),
            last - np.concatenate(walker.END_STATE),
        ]
    q = ca.vertsplit(last[:N])
    forward, up = walker.foot(q, ca.sin, ca.cos)
    after, before = ca.vertsplit(first[N:]), ca.vertsplit(last[N:])
    exchanged = [first[i] - last[N - 1 - i] for i in range(N)]
    return [
        *exchanged,
        *walker.strike(q, before, after, ca.cos),
        forward - walker.STEP_LENGTH,
        up,
    ]


def _packed(start: walker.Start, elements: int, h: float, points: np.ndarray) -> np.ndarray:
    """The unknowns for a guess, in the order of :func:`build`."""

    def state(t: np.ndarray) -> np.ndarray:
        return np.hstack([start.angles(t), start.rates(t)])

    parts = [state(np.array([0.0]))[0]]
    for k in range(elements):
        t = h * (k + points)
        parts += [state(t).ravel(), start.controls(t).ravel(), state(np.array([h * (k + 1)]))[0]]
    return np.concatenate(parts)


if __name__ == "__main__":
    peer.main(
        f"CasADi {ca.__version__}",
        "{n} elements of " + f"{DEGREE} Gauss points",
        build,
        fine=20,
    )
