"""solve(problem, method="spline"): the paper's transcription by either solver, same answer."""

from __future__ import annotations

import time

from ergowalk.gait.rhythm import Rhythm
from ergowalk.problem import GaitProblem
from ergowalk.solution import Solution
from ergowalk.solution.progress import Progress, Report
from ergowalk.solving.answer import dense_energy, describe, judged
from ergowalk.solving.spline_answer import SplineAnswer, dense_curves, with_measures
from ergowalk.solving.spline_ipopt import by_ipopt, ladder
from ergowalk.solving.spline_options import SplineOptions
from ergowalk.solving.spline_rosenbrock import POWER, by_rosenbrock
from ergowalk.transcription.guess import starting_rhythm
from ergowalk.transcription.spline.programme import SplineProgramme
from ergowalk.transcription.spline.rows import Asked


def solve_spline(
    problem: GaitProblem, solver: str, options: SplineOptions, progress: Report | None
) -> Solution:
    """The gait of least E whose free functions (11) are smoothing splines, rhythm held.

    Parameters
    ----------
    problem : GaitProblem
    solver : "rosenbrock" or "ipopt"
    options : SplineOptions
    progress : callable, optional

    Raises
    ------
    ProblemError
        If the options do not go together, or the problem is one that (12) cannot treat.
    """
    chosen = options.settled(solver)
    assert chosen.knots is not None
    began, wall = time.process_time(), time.monotonic()
    rhythm = held_rhythm(problem)

    def watch(stage: str, iteration: int, energy: float, violation: float) -> None:
        if progress is not None:
            progress(Progress(stage, iteration, energy, violation, time.monotonic() - wall))

    first = chosen.knots if solver == "rosenbrock" else ladder(chosen.knots)[0]
    programme = SplineProgramme(problem, rhythm, first, chosen.rho, chosen.extras)
    if solver == "rosenbrock":
        _ = programme.value(programme.initial())  # CasADi builds it now
    built = time.process_time() - began
    if solver == "rosenbrock":
        answer = by_rosenbrock(programme, chosen.max_evaluations, watch, built)
    else:
        answer = by_ipopt(programme, chosen.knots, Asked(str(chosen.asked)), watch, built)
    return finished(answer, solver, chosen)


def held_rhythm(problem: GaitProblem) -> Rhythm:
    """The problem's starting rhythm, in an order that its bounds allow."""
    start, orders = problem.rhythm.start(), problem.rhythm.orders()
    order = start.order if start.order in orders else orders[0]
    return starting_rhythm(problem, order)


def finished(answer: SplineAnswer, solver: str, options: SplineOptions) -> Solution:
    """Dense curves, attributes, trace, audit."""
    programme, problem = answer.programme, answer.programme.problem
    dataset, _ = dense_curves(programme, answer.unknowns)
    extra = {
        "solver": solver,
        "knots": len(programme.curves.grid) - 1,
        "rho": programme.rho,
        "asked": str(options.asked),
        "unknowns": programme.size,
        "energy_at_samples": programme.value(answer.unknowns)[0],
        "phase_order": str(programme.rhythm.order),
        "iterations": answer.iterations,
        "solve_time": answer.solve_time,
        "build_time": answer.build_time,
    }
    if solver == "rosenbrock":
        extra |= {"evaluations": answer.evaluations, "penalty_power": POWER}
    dataset = describe(
        dataset,
        problem,
        (programme.rhythm,),
        energy=dense_energy(dataset, problem.step_length_m),
        method="spline",
        status=_status(answer, options),
        history=answer.history,
        extra=extra,
    )
    return judged(with_measures(dataset, answer), answer.settled, problem.folder)


def _status(answer: SplineAnswer, options: SplineOptions) -> str:
    """How it ended, what E owes to the knots, what was asked, and what was held."""
    programme = answer.programme
    knots = len(programme.curves.grid) - 1
    said = f"{answer.said}, on {knots} knots"
    fewer = [e for e in answer.history if e["knots"] < knots and e["converged"]]
    if fewer:
        energies = (f"{e['energy_per_metre']:.2f} J/m on {e['knots']}" for e in fewer)
        said += f" (and {', '.join(energies)}: the knots keep it finite)"
    if options.asked == Asked.PAPER:
        said += "; asked were the measures of (19) alone"
    if not programme.problem.rhythm.fixed:
        said += "; the problem leaves the rhythm free, this method holds it"
    return said
