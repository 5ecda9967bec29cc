"""The kernel of one element of a phase: what is unknown in it, and what must hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.nlp import Kernel
from ergowalk.transcription.functions import Call, CompiledFunction
from ergowalk.transcription.phases import PhaseModel, TimeCurves
from ergowalk.transcription.rows import Rows
from ergowalk.transcription.scheme import GaussScheme

Array = NDArray[np.float64]

BETWEEN = (0.3, 0.7)
"""Further places, between Gauss points, where forces are checked: they turn sharply there when a
limit becomes active."""


PhaseFunctions = tuple[CompiledFunction, CompiledFunction, CompiledFunction, CompiledFunction]
"""Compiled inside, path, path at mesh points, at ends of one phase."""


@dataclass
class KernelStore:
    """Kernels and compiled functions built before, by phase name (and Gauss points).

    They depend on the phase functions alone: other meshes, other orders of the same phases and
    other numbers of Gauss points reuse them.
    """

    functions: dict[str, PhaseFunctions] = field(default_factory=dict)
    kernels: dict[tuple[str, int], PhaseKernel] = field(default_factory=dict)

    def kernel(self, phase: PhaseModel, scheme: GaussScheme) -> PhaseKernel:
        """The kernel of a phase, built if it is not there yet."""
        key = (phase.name, scheme.m)
        if key not in self.kernels:
            if phase.name not in self.functions:
                self.functions[phase.name] = compile_phase(phase)
            functions = self.functions[phase.name]
            self.kernels[key] = phase_kernel(phase, scheme, functions)
        return self.kernels[key]


@dataclass(frozen=True)
class PhaseKernel:
    """The kernel of a phase with the bounds, labels and places of its rows.

    ``places`` are the local fractions of the element at which the rows are asked; not a number
    for rows that belong to the element as a whole.
    """

    kernel: Kernel
    lower: Array
    upper: Array
    labels: tuple[str, ...]
    absolute: ca.Function
    n_abs: int
    places: Array


def phase_kernel(
    phase: PhaseModel,
    scheme: GaussScheme,
    functions: PhaseFunctions | None = None,
) -> PhaseKernel:
    """The kernel of one element of a phase; ``functions`` if they have been compiled before."""
    local = _Local(phase, scheme)
    inside, path, path_at_mesh, at_ends = functions or compile_phase(phase)
    rows = Rows()
    _continuity(local, rows)
    cost: Any = 0.0
    absolutes: list[Any] = []
    slacks: list[Any] = []
    scale = phase.absolute_scale
    for j, (c, w) in enumerate(zip(scheme.points, scheme.weights, strict=True)):
        call = local.call(inside, float(c))
        rows.add_call(call, float(c))
        if phase.path_everywhere or j == scheme.m // 2:
            rows.add_call(local.call(path, float(c)), float(c))
        plus, minus = (ca.SX.sym(f"{sign}_{j}", inside.n_abs) for sign in ("plus", "minus"))
        rows.add_slacks(call, plus - minus, scale)
        charge = phase.absolute_weights[0] * plus + phase.absolute_weights[1] * minus
        cost = cost + w * local.h * (scale * ca.sum1(charge) + call.integrand)
        absolutes.append(call.absolute / scale)
        slacks += [plus, minus]
    rows.add_call(local.call(path_at_mesh, 0.0), 0.0)
    for place in (0.0, *BETWEEN, 1.0):
        rows.add_call(local.call(at_ends, place), place)
    cost = cost + _control_rates(local, rows)
    if phase.cost_factor is not None:
        names = [x.name for x in phase.shared]
        cost = phase.cost_factor(dict(zip(names, ca.vertsplit(local.shared), strict=True))) * cost
    _control_bounds(local, rows)
    variables = ca.vertcat(local.variables, *slacks)
    kernel = Kernel(
        phase.name,
        variables,
        ca.vertcat(local.parameters, *local.all_given),
        cost,
        rows.expression,
        _expansion(variables, local) if local.all_given else None,
        rows.chain(variables),
    )
    absolute = ca.Function("absolute", [variables, local.parameters], [ca.vertcat(*absolutes)])
    return PhaseKernel(
        kernel, *rows.bounds, tuple(rows.labels), absolute, inside.n_abs, np.array(rows.places)
    )


def compile_phase(phase: PhaseModel) -> PhaseFunctions:
    """The functions of a phase (inside, path, path at mesh points, at ends), compiled."""
    at_mesh = CompiledFunction(phase, phase.path, "mesh")
    path = CompiledFunction(phase, phase.path, "path") if phase.path_everywhere else at_mesh
    inside = CompiledFunction(phase, phase.inside, "inside")
    return inside, path, at_mesh, CompiledFunction(phase, phase.at_ends, "at_ends")


@dataclass(frozen=True)
class _Called:
    """Rows that are a function of an instant, called at one place of the element.

    ``weight`` is what the outputs are multiplied with; ``first`` and ``count`` say which they are.
    """

    function: CompiledFunction
    arguments: Any
    first: int
    count: int
    weight: float


@dataclass(frozen=True)
class _Given:
    """Given functions at one place of an element: argument, values, both derivatives."""

    symbols: Any
    count: int

    def at(self, time: Any) -> Any:
        """Their Taylor polynomials, exact to second order at the present point."""
        step = time - self.symbols[0]
        value, first, second = ca.vertsplit(self.symbols[1:], self.count)
        return value + first * step + second * step**2 / 2


def _expansion(variables: Any, local: _Local) -> Callable[[Any, Any], Any]:
    """The given functions where every element uses them: argument, values, derivatives."""
    parts = []
    for i, curves in enumerate(local.phase.curves):
        places = list(local.given[i])
        if places:
            arguments = ca.vertcat(*(local.argument(curves, s) for s in places))
            instants = ca.Function("instants", [variables, local.parameters], [arguments])
            parts.append((curves, len(places), instants))

    def expansion(v: Any, p: Any) -> Any:
        uses, found = v.shape[1], []
        for curves, count, instants in parts:
            flat = ca.reshape(instants.map(uses)(v, p), 1, count * uses)
            rows = 1 + 3 * len(curves.names)
            values = ca.vertcat(flat, curves.evaluate(flat))
            found.append(ca.reshape(values, rows * count, uses))
        return ca.vertcat(*found)

    return expansion


class _Local:
    """Symbols of one element, and the curves that they define inside it."""

    def __init__(self, phase: PhaseModel, scheme: GaussScheme) -> None:
        self.phase, self.scheme = phase, scheme
        n_q, n_u, n_z = len(phase.coordinates), len(phase.controls), len(phase.algebraics)
        self.t0, self.t1 = ca.SX.sym("t0"), ca.SX.sym("t1")
        self.parameters = ca.SX.sym("part", 2)
        scales = [np.ones(n_q), np.array([c.rate_scale for c in phase.coordinates])]
        scales.append(np.array([u.scale for u in phase.controls]))
        raw_left = [ca.SX.sym(f"left_{i}", n) for i, n in enumerate((n_q, n_q, n_u))]
        raw_right = [ca.SX.sym(f"right_{i}", n) for i, n in enumerate((n_q, n_q, n_u))]
        raw_bulge = ca.SX.sym("bulge", n_u)
        self.bulge = scales[2] * raw_bulge
        raw_a = [ca.SX.sym(f"a_{j}", n_q) for j in range(scheme.m)]
        raw_z = [ca.SX.sym(f"z_{j}", n_z) for j in range(scheme.m)]
        self.left = [s * v for s, v in zip(scales, raw_left, strict=True)]
        self.right = [s * v for s, v in zip(scales, raw_right, strict=True)]
        a_scale = np.array([c.acceleration_scale for c in phase.coordinates])
        z_scale = np.array([z.scale for z in phase.algebraics])
        self.a = ca.horzcat(*(a_scale * v for v in raw_a))
        self.z = ca.horzcat(*(z_scale * v for v in raw_z))
        inner = [v for pair in zip(raw_a, raw_z, strict=True) for v in pair]
        raw_shared = ca.SX.sym("shared", len(phase.shared))
        self.shared = np.array([x.scale for x in phase.shared]) * raw_shared
        ends = (*raw_left, *raw_right, raw_bulge)
        self.variables = ca.vertcat(self.t0, self.t1, raw_shared, *ends, *inner)
        self.duration = self.t1 - self.t0
        self.h = self.duration * self.parameters[1]
        self.given: list[dict[float, _Given]] = [{} for _ in phase.curves]

    def time(self, s: float) -> Any:
        """Instant [s] of local fraction s."""
        return self.t0 + self.duration * (self.parameters[0] + self.parameters[1] * s)

    def argument(self, curves: TimeCurves, s: float) -> Any:
        """Where given functions of time are taken at local fraction s [s]."""
        if curves.later is None:
            return self.time(s)
        names = [x.name for x in self.phase.shared]
        return self.time(s) + self.shared[names.index(curves.later)]

    def curves(self, s: float) -> Any:
        """The given functions of time at local fraction s."""
        values = []
        for curves, given in zip(self.phase.curves, self.given, strict=True):
            count = len(curves.names)
            if s not in given:
                given[s] = _Given(ca.SX.sym(f"given_{len(given)}", 1 + 3 * count), count)
            values.append(given[s].at(self.argument(curves, s)))
        return ca.vertcat(*values)

    @property
    def all_given(self) -> list[Any]:
        """Symbols of all given functions in the order in which their values come."""
        return [entry.symbols for given in self.given for entry in given.values()]

    def call(self, function: CompiledFunction, s: float) -> Call:
        """A phase function at local fraction s."""
        count = sum(len(curves.names) for curves in self.phase.curves)
        curves = self.curves(s) if function.sees_curves else ca.SX(count, 1)
        return function.at(ca.vertcat(*self.arguments(s), curves, self.shared))

    def arguments(self, s: float) -> list[Any]:
        """Time, values, rates, accelerations, controls, slopes, algebraics at local fraction s."""
        scheme = self.scheme
        first, second = scheme.first_integral(s)[0], scheme.second_integral(s)[0]
        weight = ca.DM(scheme.value(s)[0])
        slopes = [self.slope(i, s) for i in range(len(self.phase.controls))]
        return [
            self.time(s),
            self.left[0] + self.h * s * self.left[1] + self.h**2 * (self.a @ ca.DM(second)),
            self.left[1] + self.h * (self.a @ ca.DM(first)),
            self.a @ weight,
            self.left[2] + s * (self.right[2] - self.left[2]) + 4 * s * (1 - s) * self.bulge,
            ca.vertcat(*slopes),
            self.z @ weight,
        ]

    def slope(self, i: int, s: float) -> Any:
        """Time derivative of control ``i`` at local fraction s: linear in the element."""
        chord = self.right[2][i] - self.left[2][i]
        return (chord + 4 * (1 - 2 * s) * self.bulge[i]) / self.h


def _continuity(local: _Local, rows: Rows) -> None:
    """Value and rate at the right end are the exact integrals of the acceleration."""
    _, value, rate, *_ = local.arguments(1.0)
    scale = np.array([c.rate_scale for c in local.phase.coordinates])
    labels = ["continuity"] * len(scale)
    rows.add(local.right[0] - value, labels, 0.0, 0.0)
    rows.add((local.right[1] - rate) / scale, labels, 0.0, 0.0)


def _control_bounds(local: _Local, rows: Rows) -> None:
    """Bounds of the controls inside the element.

    A parabola lies inside the hull of its ends and its middle Bernstein coefficient, so bounding
    the three bounds all of it.
    """
    for i, u in enumerate(local.phase.controls):
        if np.isfinite(u.lower) or np.isfinite(u.upper):
            middle = (local.left[2][i] + local.right[2][i]) / 2 + 2 * local.bulge[i]
            bounds = np.array([u.lower, u.upper]) / u.scale
            rows.add(middle / u.scale, ["control bounds"], bounds[0], bounds[1])


def _control_rates(local: _Local, rows: Rows) -> Any:
    """Bounds on, and cost of, the slopes of the controls in this element.

    A slope is linear, so it is largest at an end; the integral of its square is exact by
    Simpson's rule.
    """
    cost: Any = 0.0
    for i, u in enumerate(local.phase.controls):
        start, middle, end = (local.slope(i, s) for s in (0.0, 0.5, 1.0))
        if u.name in local.phase.control_rates:
            bound = local.phase.control_rates[u.name]
            rows.add(ca.vertcat(start, end) / bound, ["moment rate"] * 2, -1.0, 1.0)
        square = (start**2 + 4 * middle**2 + end**2) / 6
        cost = cost + local.phase.control_rate_cost.get(u.name, 0.0) * local.h * square
    return cost
