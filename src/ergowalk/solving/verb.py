"""solve(problem) -> Solution: by collocation, or by the paper's own method."""

from __future__ import annotations

from collections.abc import Iterable

from ergowalk.errors import ProblemError
from ergowalk.problem import GaitProblem
from ergowalk.solution import Solution
from ergowalk.solution.progress import Report
from ergowalk.solving.collocation import solve_collocation
from ergowalk.solving.spline import solve_spline
from ergowalk.solving.spline_options import SplineOptions
from ergowalk.solving.starts import solve_from_starts
from ergowalk.transcription.walker import Smoothing

METHODS = {"collocation": ("ipopt",), "spline": ("ipopt", "rosenbrock")}
"""Methods and their solvers."""


def solve(
    problem: GaitProblem,
    *,
    method: str = "collocation",
    solver: str = "ipopt",
    spline: SplineOptions | None = None,
    start: Solution | None = None,
    starts: int | None = None,
    seed: int = 0,
    workers: int | None = None,
    progress: Report | None = None,
    smoothing: Smoothing | None = None,
    recheck: bool = False,
) -> Solution:
    """Find the cheapest gait.

    The collocation searches on a coarse mesh from the human mean curves, first with the rhythm
    held, then free; with both phase orders possible both are tried and the cheaper kept. The
    reported gait is on a finer mesh, checked on one finer still, and audited. The paper's own
    method makes the free functions (11) smoothing splines, see :class:`SplineOptions`; it holds
    the rhythm at the problem's starting one.

    Parameters
    ----------
    problem : GaitProblem
    method : "collocation" or "spline"
    solver : "ipopt" or "rosenbrock"
        The latter, without derivatives, for the spline method alone.
    spline : SplineOptions, optional
        Choices of the spline method.
    start : Solution, optional
        A gait, by whatever method, from which a collocation begins instead of the human means.
        If that fails it begins from those after all, and the status says so.
    starts : int, optional
        Search so many times, from the human means and from disturbances of them that ``seed``
        determines, in ``workers`` processes, and return the best accepted gait with the
        catalogue of optima in its attribute ``starts``: see
        :func:`~ergowalk.solving.starts.solve_from_starts`.
    progress : callable, optional
        Called with a :class:`~ergowalk.solution.Progress` once an iteration.
    smoothing : Smoothing, optional
        Small costs of the collocation that single out one of many equal optima; not part of E.
    recheck : bool
        A gait found on the mesh of the ``start`` takes over what a finer mesh changed there, as
        long as the audit accepts it and E differs by less than
        :data:`~ergowalk.solving.check.NEIGHBOUR`; True solves the finer mesh anew instead.

    Returns
    -------
    Solution
        Also when the solver does not converge: then ``acceptable`` is False and ``status`` says
        why.

    Raises
    ------
    ProblemError
        For a method, a solver or options that do not exist or do not go together.
    """
    _check_method(method, solver, spline, start)
    _check_objective(problem, method)
    if starts is not None:
        _check_starts(method, start)
        return solve_from_starts(
            problem, starts, seed, workers=workers, progress=progress, smoothing=smoothing
        )
    if method == "spline":
        return solve_spline(problem, solver, spline or SplineOptions(), progress)
    return solve_collocation(problem, smoothing, start, progress, recheck=recheck)


def _check_method(
    method: str, solver: str, spline: SplineOptions | None, start: Solution | None
) -> None:
    """Refuse what does not go together."""
    if method not in METHODS:
        raise ProblemError(
            "no such method", f"use {_either(METHODS)}", field="method", value=method
        )
    if solver not in METHODS[method]:
        known = any(solver in solvers for solvers in METHODS.values())
        raise ProblemError(
            f"cannot solve method {method!r}" if known else "no such solver",
            f"use {_either(METHODS[method])}"
            + (", or method 'spline'" if known else f" for method {method!r}"),
            field="solver",
            value=solver,
        )
    if spline is not None and method != "spline":
        raise ProblemError(
            f"means nothing to method {method!r}",
            "leave knots, rho and what is asked to method 'spline'",
            field="spline",
        )
    if start is not None and method != "collocation":
        raise ProblemError(
            f"means nothing to method {method!r}, which begins with the human means",
            "start a collocation with it",
            field="start",
        )


def _check_objective(problem: GaitProblem, method: str) -> None:
    if method != "collocation" and not problem.objective.is_eq10:
        raise ProblemError(
            f"method {method!r} minimises (10) alone",
            "leave out the table, or use method 'collocation'",
            field="objective",
            value=problem.objective.sentence(),
        )
    if method != "collocation" and problem.design:
        raise ProblemError(
            f"method {method!r} holds body and devices",
            "leave out the table, or use method 'collocation'",
            field="design",
            value=problem.design.sentence(),
        )
    if method != "collocation" and any(problem.devices.everything()):
        raise ProblemError(
            f"method {method!r} knows no devices",
            "leave out the table, or use method 'collocation'",
            field="devices",
            value=problem.devices.sentence(),
        )

    if method != "collocation" and problem.full_stride:
        raise ProblemError(
            f"method {method!r} knows legs that mirror each other only",
            "give both legs the same parameters, bounds and devices, or use method 'collocation'",
            field="stride.legs",
            value=problem.stride.legs,
        )


def _check_starts(method: str, start: Solution | None) -> None:
    if method != "collocation" or start is not None:
        raise ProblemError(
            "go with method 'collocation' and without a start of your own",
            "leave out either",
            field="starts",
        )


def _either(names: Iterable[str]) -> str:
    return " or ".join(repr(name) for name in names)
