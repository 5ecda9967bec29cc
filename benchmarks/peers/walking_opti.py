"""Problem A with the printed rhythm, posed by hand with CasADi's ``Opti``.

Equations of motion, contacts, corridors and limits are ergowalk's own functions of an instant, so
that the physics are the same; everything that turns them into a nonlinear programme is not. Angles,
rates and moments are states at the ends of elements and at three Gauss points, reactions are
unknowns at the Gauss points, |power| is the sum of two non-negative variables whose difference is
the power, bounds are asked at the collocation points. The start are the human mean angles, moments
of zero and the body's weight under the loaded feet, or the solution of a smooth problem that starts
there; IPOPT keeps its defaults but for a limit on its time.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

import ergowalk
from ergowalk.solving.start import StartingGait
from ergowalk.transcription.guess import human_guess, starting_rhythm, starting_times
from ergowalk.transcription.halves import halves_of
from ergowalk.transcription.phases import Instant, PhasedProblem, PhaseModel, State, Terms
from ergowalk.transcription.walker import Smoothing, Walker
from ergowalk.transcription.walking import walking_problem

DEGREE = 3
ELEMENTS = 87
"""About as many as ergowalk's reported gait has."""
FEWEST = 5
"""Elements of the shortest phase."""


@dataclass
class Nodes:
    """States of one phase at the ends of its elements, each column angles, rates, moments."""

    model: PhaseModel
    columns: list[Any]

    def states(self, column: Any) -> tuple[dict[str, State], dict[str, Any]]:
        """Coordinates and moments of one column by name."""
        return _by_name(self.model, column)

    def named(self, k: int) -> dict[tuple[str, str], Any]:
        """(name, kind) -> unknown at the end of an element."""
        coordinates, moments = self.states(self.columns[k])
        found = {(n, "value"): s.value for n, s in coordinates.items()}
        found |= {(n, "rate"): s.rate for n, s in coordinates.items()}
        return found | {(n, "control"): u for n, u in moments.items()}


def _by_name(model: PhaseModel, column: Any, slope: Any = None) -> tuple[dict, dict]:
    n = len(model.coordinates)
    coordinates = {
        x.name: State(column[i], column[n + i], 0.0 if slope is None else slope[n + i])
        for i, x in enumerate(model.coordinates)
    }
    return coordinates, {u.name: column[2 * n + i] for i, u in enumerate(model.controls)}


@dataclass(frozen=True)
class Rows:
    """One function of an instant, compiled: rows with bounds, absolute powers, integrand."""

    function: ca.Function
    lower: np.ndarray
    upper: np.ndarray

    def ask(self, opti: ca.Opti, *arguments: Any) -> tuple[Any, Any]:
        """Make the rows constraints; returns absolute powers and integrand."""
        rows, powers, integrand = self.function(*arguments)
        equal = np.flatnonzero(self.lower == self.upper)
        if len(equal):
            opti.subject_to(rows[list(equal)] == self.lower[equal])
        for i in np.flatnonzero(self.lower != self.upper):
            low, high = float(self.lower[i]), float(self.upper[i])
            if np.isfinite(low) and np.isfinite(high):
                opti.subject_to(opti.bounded(low, rows[int(i)], high))
            elif np.isfinite(low):
                opti.subject_to(rows[int(i)] >= low)
            else:
                opti.subject_to(rows[int(i)] <= high)
        return powers, integrand


def _compiled(model: PhaseModel, ask: Callable[[Instant], Terms], *, inner: bool) -> Rows:
    """A function of an instant as a CasADi function of time, state, slope, reactions, corridors."""
    size = 2 * len(model.coordinates) + len(model.controls)
    time, column, slope = ca.SX.sym("t"), ca.SX.sym("x", size), ca.SX.sym("s", size)
    algebraics = ca.SX.sym("z", len(model.algebraics))
    edges = ca.SX.sym("c", len(model.curves[0].names))
    coordinates, moments = _by_name(model, column, slope)
    named = {z.name: algebraics[i] for i, z in enumerate(model.algebraics)} if inner else {}
    curves = dict(zip(model.curves[0].names, ca.vertsplit(edges), strict=True))
    terms = ask(Instant(time, coordinates, moments, named, curves=curves))
    rows = [ca.SX(row[1]) for row in terms.rows]
    function = ca.Function(
        "rows",
        [time, column, slope, algebraics, edges],
        [ca.vertcat(*rows), ca.vertcat(*terms.absolute), ca.SX(terms.integrand)],
    )
    bounds = np.array([(row[2], row[3]) for row in terms.rows]).reshape(-1, 2)
    return Rows(function, bounds[:, 0], bounds[:, 1])


@dataclass(frozen=True)
class Posed:
    """A programme with what may be minimised in it.

    ``work`` is the half stride's absolute work per kg [J/kg], ``extra`` ergowalk's small costs that
    are not part of E, ``smooth`` the integral of squared moments and of squared rates of angles and
    moments.
    """

    opti: ca.Opti
    work: Any
    extra: Any
    smooth: Any


def pose(
    problem: ergowalk.GaitProblem, elements: int, gait: ergowalk.Solution | None = None
) -> Posed:
    """The programme, without an objective yet.

    It starts from the human means, or from a solved ``gait``.
    """
    (order,) = problem.rhythm.orders()
    smoothing = Smoothing()
    walker, posed = Walker(problem, smoothing), walking_problem(problem, (order,), smoothing)
    times = starting_times(problem, starting_rhythm(problem, order))
    guess = human_guess(walker, order, times)
    if gait is not None:
        guess = StartingGait(gait).guess(problem, halves_of(problem, (order,), smoothing))
    opti = ca.Opti()
    half = problem.stride_time_s / 2
    work, extra, smooth, phases = 0, 0, 0, []
    for i, model in enumerate(posed.phases):
        share = (times[model.end] - times[model.start]) / half
        count = max(FEWEST, round(elements * share))
        nodes, costs = _phase(opti, posed, i, count, times, guess, walker.gravity)
        phases.append(nodes)
        work, extra, smooth = work + costs[0], extra + costs[1], smooth + costs[2]
    _boundaries(opti, posed, phases, times)
    return Posed(opti, work, extra, smooth)


def _phase(
    opti: ca.Opti,
    posed: PhasedProblem,
    i: int,
    count: int,
    times: dict[str, float],
    guess: Callable,
    gravity: float,
) -> tuple[Nodes, tuple[Any, Any, Any]]:
    """One phase on equal elements: its nodes; its work [J/kg], small costs, smooth cost."""
    model = posed.phases[i]
    start, length = times[model.start], times[model.end] - times[model.start]
    h = length / count
    n, size = len(model.coordinates), 2 * len(model.coordinates) + len(model.controls)
    taus = ca.collocation_points(DEGREE, "legendre")
    slopes, ends, weights = ca.collocation_coeff(taus)
    inside = _compiled(model, model.inside, inner=True)
    path = _compiled(model, model.path, inner=model.path_everywhere)
    at_node = _compiled(model, model.path, inner=False)

    def first(fraction: float) -> np.ndarray:
        return _start(model, guess(i, np.array([fraction])))

    def curves(t: float) -> np.ndarray:
        table = model.curves[0].at(np.array([t]))
        return np.array([table[name][0] for name in model.curves[0].names])

    none, still = np.zeros(len(model.algebraics)), np.zeros(size)
    left = opti.variable(size)
    opti.set_initial(left, first(0.0))
    columns, work, extra, smooth = [left], 0, 0, 0
    for k in range(count):
        inner = opti.variable(size, DEGREE)
        at_node.ask(opti, start + k * h, left, still, none, curves(start + k * h))
        states = ca.horzcat(left, inner)
        rates = states @ slopes / h
        for j in range(DEGREE):
            fraction = (k + taus[j]) / count
            t = start + length * fraction
            opti.set_initial(inner[:, j], first(fraction))
            z = opti.variable(len(model.algebraics))
            _bounded(opti, z, model, guess(i, np.array([fraction])), gravity)
            opti.subject_to(rates[:n, j] == inner[n : 2 * n, j])
            point = (t, inner[:, j], rates[:, j], z, curves(t))
            powers, integrand = inside.ask(opti, *point)
            if model.path_everywhere or j == DEGREE // 2:
                path.ask(opti, *point)
            plus, minus = (opti.variable(powers.shape[0]) for _ in range(2))
            opti.subject_to(plus - minus == powers)
            opti.subject_to(plus >= 0)
            opti.subject_to(minus >= 0)
            work += h * weights[j] * ca.sum1(plus + minus)
            extra += h * weights[j] * integrand
            smooth += h * weights[j] * _smooth_cost(model, inner[:, j], rates[:, j])
            for m, u in enumerate(model.controls):
                rate = rates[2 * n + m, j]
                extra += h * weights[j] * model.control_rate_cost.get(u.name, 0.0) * rate**2
                if u.name in model.control_rates:
                    bound = model.control_rates[u.name]
                    opti.subject_to(opti.bounded(-bound, rate, bound))
        left = opti.variable(size)
        opti.set_initial(left, first((k + 1) / count))
        opti.subject_to(left == states @ ends)
        columns.append(left)
    at_node.ask(opti, start + length, left, still, none, curves(start + length))
    return Nodes(model, columns), (work, extra, smooth)


def _smooth_cost(model: PhaseModel, column: Any, rates: Any) -> Any:
    """Squared moments, their rates, and accelerations, each in units of a typical one."""
    n = len(model.coordinates)
    squares = ca.sumsqr(column[2 * n :]) + ca.sumsqr(rates[2 * n :] / 10)
    return squares + ca.sumsqr(rates[n : 2 * n] / 100)


def _start(model: PhaseModel, samples: Any) -> np.ndarray:
    """A column of the start: angles and rates, and moments where the start has them."""
    values = [samples.value[x.name][0] for x in model.coordinates]
    rates = [samples.rate[x.name][0] for x in model.coordinates]
    moments = [samples.control.get(u.name, [0.0])[0] for u in model.controls]
    return np.array([*values, *rates, *moments])


def _bounded(opti: ca.Opti, z: Any, model: PhaseModel, samples: Any, gravity: float) -> None:
    """Bounds and start of reactions per kg, and of the trailing foot on its toe tip."""
    for i, unknown in enumerate(model.algebraics):
        if np.isfinite(unknown.lower) or np.isfinite(unknown.upper):
            opti.subject_to(opti.bounded(unknown.lower, z[i], unknown.upper))
        if unknown.name in samples.algebraic:
            opti.set_initial(z[i], samples.algebraic[unknown.name][0])
        elif unknown.name.startswith("reaction_y"):
            loaded = sum(x.name.startswith("reaction_y") for x in model.algebraics)
            opti.set_initial(z[i], gravity / loaded)


def _boundaries(
    opti: ca.Opti, posed: PhasedProblem, phases: list[Nodes], times: dict[str, float]
) -> None:
    """Continuity from phase to phase, exchange of the legs, fixed values, toe-off and landing."""
    known: dict[str, dict[tuple[str, str], Any]] = {}
    for nodes in phases:
        for edge, k in ((nodes.model.start, 0), (nodes.model.end, -1)):
            here = known.setdefault(edge, {})
            for key, unknown in nodes.named(k).items():
                if key in here:
                    opti.subject_to(unknown == here[key])
                else:
                    here[key] = unknown
    first, last = known[phases[0].model.start], known[phases[-1].model.end]
    exchange = posed.joins[0].names
    for (name, kind), unknown in last.items():
        if (exchange.get(name), kind) in first:
            opti.subject_to(unknown == first[exchange[name], kind])
    for (edge, name, kind), number in posed.fixed.items():
        opti.subject_to(known[edge][name, kind] == number)
    for link in posed.links:
        here = known[link.boundary]
        names = {name for name, kind in here if kind == "value"}
        states = {n: State(here[n, "value"], here[n, "rate"]) for n in names}
        for _, row, _, _ in link.function(Instant(times[link.boundary], states, {}, {})).rows:
            opti.subject_to(row == 0)


def _minimised(opti: ca.Opti, objective: Any, limit: float) -> Callable[[Any], Any]:
    """Values at the minimum, or where IPOPT stopped."""
    opti.minimize(objective)
    opti.solver("ipopt", {"expand": True}, {"max_cpu_time": max(limit, 1.0)})
    try:
        return opti.solve().value
    except RuntimeError:  # not converged
        return opti.debug.value


def main() -> None:
    """Solve and print one line of JSON."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--elements", type=int, default=ELEMENTS)
    arguments.add_argument("--limit", type=float, default=300.0, help="CPU s for IPOPT")
    arguments.add_argument(
        "--smooth-first",
        action="store_true",
        help="start from least squared moments, their rates, and accelerations",
    )
    chosen = arguments.parse_args()
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    problem = ergowalk.preset("berbyuk2002-rhythm")
    began = _cpu()
    posed = pose(problem, chosen.elements)
    opti, built, iterations = posed.opti, _cpu(), 0
    if chosen.smooth_first:
        value = _minimised(opti, posed.smooth, chosen.limit / 2)  # the rest is for the other
        opti.set_initial(opti.x, value(opti.x))
        iterations = int(opti.stats()["iter_count"])
    left = chosen.limit - (_cpu() - built)
    value = _minimised(opti, posed.work + posed.extra, left)
    stats = opti.stats()
    answer = {
        "build_cpu_s": built - began,
        "solve_cpu_s": _cpu() - built,
        "energy_j_per_m": float(value(posed.work))
        * problem.body.total_mass
        / problem.step_length_m,
        "converged": bool(stats["success"]),
        "iterations": iterations + int(stats["iter_count"]),
        "message": str(stats["return_status"]),
        "unknowns": int(opti.nx),
        "elements": chosen.elements,
        "versions": f"CasADi {ca.__version__}",
    }
    sys.stdout.flush()
    os.dup2(kept, 1)
    print(json.dumps(answer))


def _cpu() -> float:
    """CPU time [s] of this process."""
    used = os.times()
    return used.user + used.system


if __name__ == "__main__":
    main()
