"""Direct collocation of a phased problem: one kernel per phase, one use per element."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.nlp import Block, Kernel, NonlinearProgramme
from ergowalk.transcription.layout import Layout, Mesh, PhaseIndices, lay_out
from ergowalk.transcription.phases import (
    Instant,
    Link,
    PhasedProblem,
    PhaseModel,
    State,
    Terms,
)
from ergowalk.transcription.scheme import GaussScheme

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PhaseKernel:
    """The kernel of a phase with the bounds and labels of its rows."""

    kernel: Kernel
    lower: Array
    upper: Array
    labels: tuple[str, ...]
    absolute: ca.Function
    n_abs: int


@dataclass(frozen=True)
class Samples:
    """Curves of one phase at given instants: dictionaries of arrays by name."""

    value: Mapping[str, Array]
    rate: Mapping[str, Array]
    acceleration: Mapping[str, Array]
    control: Mapping[str, Array]
    algebraic: Mapping[str, Array]


Guess = Callable[[int, Array], Samples]
"""(phase number, fractions of the phase) -> curves."""


class Collocation:
    """A phased problem on a mesh: builds the programme, packs guesses, unpacks points.

    Parameters
    ----------
    problem : PhasedProblem
    mesh : one array of element boundaries (0 ... 1) per phase
    m : int
        Gauss points per element.
    kernels : dict, optional
        Kernels built before, by (phase name, m); missing ones are added. They depend on the
        phase functions alone, so a finer mesh reuses them.
    """

    def __init__(
        self,
        problem: PhasedProblem,
        mesh: Mesh,
        m: int,
        kernels: dict[tuple[str, int], PhaseKernel] | None = None,
    ) -> None:
        self.problem, self.mesh, self.scheme = problem, mesh, GaussScheme(m)
        cache = {} if kernels is None else kernels
        for phase in problem.phases:
            if (phase.name, m) not in cache:
                cache[phase.name, m] = phase_kernel(phase, problem, self.scheme)
        self.kernels = tuple(cache[phase.name, m] for phase in problem.phases)
        n_abs = tuple(kernel.n_abs for kernel in self.kernels)
        self.layout: Layout = lay_out(problem, mesh, m, n_abs)

    @property
    def elements(self) -> int:
        """Number of elements of all phases."""
        return sum(len(fractions) - 1 for fractions in self.mesh)

    @cached_property
    def programme(self) -> NonlinearProgramme:
        """The nonlinear programme."""
        blocks = [
            Block(
                pk.kernel,
                _element_indices(indices),
                np.stack([fractions[:-1], np.diff(fractions)]),
                pk.lower,
                pk.upper,
                pk.labels,
            )
            for pk, indices, fractions in zip(
                self.kernels, self.layout.phases, self.mesh, strict=True
            )
        ]
        blocks += [_link_block(link, self.problem, self.layout) for link in self.problem.links]
        if self.problem.time_rows:
            blocks.append(_time_block(self.problem, self.layout))
        return NonlinearProgramme(self.layout.lower, self.layout.upper, blocks)

    def pack(self, guess: Guess, times: Mapping[str, float]) -> Array:
        """Variables for a guess: curves sampled at mesh and Gauss points, slacks from powers."""
        layout, x = self.layout, np.zeros(self.layout.size)
        for name, index in layout.times.items():
            x[index] = times[name]
        for i, (phase, where) in enumerate(zip(self.problem.phases, layout.phases, strict=True)):
            fractions = self.mesh[i]
            at_mesh = guess(i, fractions)
            width = np.diff(fractions)
            inner = (fractions[:-1, None] + width[:, None] * self.scheme.points).ravel()
            at_gauss = guess(i, inner)
            shape = (len(width), self.scheme.m)
            for k, c in enumerate(phase.coordinates):
                x[where.values[:, k]] = at_mesh.value[c.name]
                x[where.rates[:, k]] = at_mesh.rate[c.name]
                x[where.accelerations[:, :, k]] = at_gauss.acceleration[c.name].reshape(shape)
            at_middle = guess(i, (fractions[:-1] + fractions[1:]) / 2).control
            for k, u in enumerate(phase.controls):
                values = at_mesh.control[u.name]
                x[where.controls[:, k]] = values
                x[where.bulges[:, k]] = at_middle[u.name] - (values[:-1] + values[1:]) / 2
            for k, z in enumerate(phase.algebraics):
                x[where.algebraics[:, :, k]] = at_gauss.algebraic[z.name].reshape(shape)
        for _, index in layout.times.items():
            x[index] = np.clip(x[index], layout.lower[index], layout.upper[index])
        x = np.clip(x / layout.scale, layout.lower, layout.upper)
        return self._with_slacks(x)

    def _with_slacks(self, x: Array) -> Array:
        for pk, where, fractions in zip(
            self.kernels, self.layout.phases, self.mesh, strict=True
        ):
            if not pk.n_abs:
                continue
            parameters = np.stack([fractions[:-1], np.diff(fractions)])
            local = x[_element_indices(where)]
            values = np.array(pk.absolute.map(local.shape[1])(local, parameters))
            shape = (self.scheme.m, pk.n_abs, local.shape[1])
            powers = values.reshape(shape).transpose(2, 0, 1)
            x[where.plus] = np.maximum(powers, 0.0)
            x[where.minus] = np.maximum(-powers, 0.0)
        return x

    def carry_multipliers(
        self, coarse: Collocation, variables: Array, rows: Array
    ) -> tuple[Array, Array]:
        """Multipliers of the same problem on another mesh with as many Gauss points.

        Each element takes those of the element that covers its middle. They are densities in
        time, so they scale with the element's length; the adjoints of continuity do not.
        """
        new_variables = np.zeros(self.layout.size)
        new_rows, first = [], 0
        for here, there, fine, old, pk in zip(
            self.layout.phases, coarse.layout.phases, self.mesh, coarse.mesh, self.kernels, strict=True
        ):
            middle = (fine[:-1] + fine[1:]) / 2
            source = np.clip(np.searchsorted(old, middle) - 1, 0, len(old) - 2)
            ratio = np.diff(fine) / np.diff(old)[source]
            count = len(pk.labels)
            block = rows[first : first + count * (len(old) - 1)].reshape(-1, count)[source]
            scale = np.where([n == "continuity" for n in pk.labels], 1.0, ratio[:, None])
            new_rows.append((block * scale).ravel())
            first += count * (len(old) - 1)
            for name in ("algebraics", "plus", "minus"):
                values = variables[getattr(there, name)][source] * ratio[:, None, None]
                new_variables[getattr(here, name)] = values
        new_rows.append(rows[first:])
        return new_variables, np.concatenate(new_rows)

    def unpack(self, x: Array) -> Trajectory:
        """The piecewise polynomial curves that the variables stand for."""
        physical = x * self.layout.scale
        times = {name: float(physical[i]) for name, i in self.layout.times.items()}
        pieces = []
        for phase, where, fractions in zip(
            self.problem.phases, self.layout.phases, self.mesh, strict=True
        ):
            start, end = (physical[i] for i in where.times)
            pieces.append(
                PhaseCurves(
                    phase,
                    self.scheme,
                    fractions,
                    float(start),
                    float(end - start),
                    physical[where.values],
                    physical[where.rates],
                    physical[where.controls],
                    physical[where.bulges],
                    physical[where.accelerations],
                    physical[where.algebraics],
                )
            )
        return Trajectory(times, tuple(pieces))


@dataclass(frozen=True)
class PhaseCurves:
    """Curves of one phase, element by element; arrays as in :class:`PhaseIndices`."""

    phase: PhaseModel
    scheme: GaussScheme
    fractions: Array
    start: float
    duration: float
    values: Array
    rates: Array
    controls: Array
    bulges: Array
    accelerations: Array
    algebraics: Array

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.fractions) - 1

    def in_element(self, k: int, s: Array) -> Samples:
        """Curves inside element ``k`` at local fractions ``s`` of the element (both ends count)."""
        h = self.duration * (self.fractions[k + 1] - self.fractions[k])
        a = self.accelerations[k]
        acceleration = self.scheme.value(s) @ a
        rate = self.rates[k] + h * self.scheme.first_integral(s) @ a
        value = self.values[k] + h * s[:, None] * self.rates[k]
        value = value + h**2 * self.scheme.second_integral(s) @ a
        control = self.controls[k] + s[:, None] * (self.controls[k + 1] - self.controls[k])
        control = control + (4 * s * (1 - s))[:, None] * self.bulges[k]
        algebraic = self.scheme.value(s) @ self.algebraics[k]
        names = [c.name for c in self.phase.coordinates]
        return Samples(
            _columns(names, value),
            _columns(names, rate),
            _columns(names, acceleration),
            _columns([u.name for u in self.phase.controls], control),
            _columns([z.name for z in self.phase.algebraics], algebraic),
        )

    def at(self, fraction: Array) -> Samples:
        """Curves at fractions of the phase."""
        k = np.clip(np.searchsorted(self.fractions, fraction, "right") - 1, 0, self.elements - 1)
        s = (fraction - self.fractions[k]) / np.diff(self.fractions)[k]
        parts = [self.in_element(int(e), np.array([u])) for e, u in zip(k, s, strict=True)]

        def join(kind: str) -> dict[str, Array]:
            first = getattr(parts[0], kind)
            return {n: np.concatenate([getattr(p, kind)[n] for p in parts]) for n in first}

        kinds = ("value", "rate", "acceleration", "control", "algebraic")
        return Samples(*(join(kind) for kind in kinds))


@dataclass(frozen=True)
class Trajectory:
    """All phases of a solved (or guessed) problem, and the boundary instants [s]."""

    times: Mapping[str, float]
    phases: tuple[PhaseCurves, ...]

    def as_guess(self) -> Guess:
        """These curves as a guess on another mesh of the same phases."""
        return lambda i, fractions: self.phases[i].at(fractions)


def phase_kernel(phase: PhaseModel, problem: PhasedProblem, scheme: GaussScheme) -> PhaseKernel:
    """The kernel of one element of a phase."""
    local = _Local(phase, scheme)
    inside = _Compiled(phase, phase.inside, "inside")
    at_ends = _Compiled(phase, phase.at_ends, "at_ends")
    path_at_mesh = _Compiled(phase, phase.path, "mesh")
    path = _Compiled(phase, phase.path, "path") if phase.path_everywhere else path_at_mesh
    rows = _Rows()
    _continuity(local, rows)
    cost: Any = 0.0
    absolutes: list[Any] = []
    slacks: list[Any] = []
    scale = phase.absolute_scale
    for j, (c, w) in enumerate(zip(scheme.points, scheme.weights, strict=True)):
        arguments = local.arguments(float(c))
        powers, integrand = inside.add(rows, arguments)
        if phase.path_everywhere or j == scheme.m // 2:
            path.add(rows, arguments)
        n_abs = powers.numel()
        plus, minus = ca.SX.sym(f"plus_{j}", n_abs), ca.SX.sym(f"minus_{j}", n_abs)
        rows.add(plus - minus - powers / scale, ["power slacks"] * n_abs, 0.0, 0.0)
        cost = cost + w * local.h * (scale * ca.sum1(plus + minus) + integrand)
        absolutes.append(powers / scale)
        slacks += [plus, minus]
    path_at_mesh.add(rows, local.arguments(0.0))
    for end in (0.0, 1.0):
        at_ends.add(rows, local.arguments(end))
    cost = cost + _control_rates(local, problem, rows)
    variables = ca.vertcat(local.variables, *slacks)
    name = phase.name.replace("+", "_")
    kernel = Kernel(name, variables, local.parameters, cost, ca.vertcat(*rows.expressions))
    absolute = ca.Function("absolute", [variables, local.parameters], [ca.vertcat(*absolutes)])
    lower, upper = np.concatenate(rows.lower), np.concatenate(rows.upper)
    n_abs = absolute.numel_out(0) // scheme.m
    return PhaseKernel(kernel, lower, upper, tuple(rows.labels), absolute, n_abs)


class _Rows:
    """Constraint rows as they come."""

    def __init__(self) -> None:
        self.expressions: list[Any] = []
        self.labels: list[str] = []
        self.lower: list[Array] = []
        self.upper: list[Array] = []

    def add(self, expression: Any, labels: Sequence[str], lower: Any, upper: Any) -> None:
        self.expressions.append(expression)
        self.labels += labels
        self.lower.append(np.broadcast_to(np.asarray(lower, dtype=float), len(labels)))
        self.upper.append(np.broadcast_to(np.asarray(upper, dtype=float), len(labels)))


class _Compiled:
    """A phase function turned once into a CasADi function, then called at many instants.

    ``kind`` "mesh" hides the algebraic variables, which do not exist at mesh points.
    """

    def __init__(self, phase: PhaseModel, function: Callable[[Instant], Terms], kind: str) -> None:
        names = [c.name for c in phase.coordinates]
        controls = [u.name for u in phase.controls]
        algebraics = [z.name for z in phase.algebraics]
        sizes = (1, *[len(names)] * 3, *[len(controls)] * 2, len(algebraics))
        symbols = [ca.SX.sym(f"s{i}", n) for i, n in enumerate(sizes)]
        t, value, rate, acceleration, control, slope, z = symbols
        terms = function(
            Instant(
                t,
                {n: State(value[i], rate[i], acceleration[i]) for i, n in enumerate(names)},
                {n: control[i] for i, n in enumerate(controls)},
                {} if kind == "mesh" else {n: z[i] for i, n in enumerate(algebraics)},
                {n: slope[i] for i, n in enumerate(controls)},
            )
        )
        self.labels = [row[0] for row in terms.rows]
        self.lower = np.array([row[2] for row in terms.rows])
        self.upper = np.array([row[3] for row in terms.rows])
        outputs = [
            ca.vertcat(*(ca.SX(row[1]) for row in terms.rows)),
            ca.vertcat(*(ca.SX(e) for e in terms.absolute)),
            ca.SX(terms.integrand),
        ]
        self.function = ca.Function(kind, symbols, outputs)

    def add(self, rows: _Rows, arguments: list[Any]) -> tuple[Any, Any]:
        """Add the rows at an instant; returns absolute-value arguments and integrand."""
        values, absolute, integrand = self.function(*arguments)
        if self.labels:
            rows.add(values, self.labels, self.lower, self.upper)
        return absolute, integrand


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
        self.variables = ca.vertcat(self.t0, self.t1, *raw_left, *raw_right, raw_bulge, *inner)
        self.duration = self.t1 - self.t0
        self.h = self.duration * self.parameters[1]

    def arguments(self, s: float) -> list[Any]:
        """Time, values, rates, accelerations, controls, slopes, algebraics at local fraction s."""
        scheme = self.scheme
        first, second = scheme.first_integral(s)[0], scheme.second_integral(s)[0]
        weight = ca.DM(scheme.value(s)[0])
        slopes = [self.slope(i, s) for i in range(len(self.phase.controls))]
        return [
            self.t0 + self.duration * (self.parameters[0] + self.parameters[1] * s),
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


def _continuity(local: _Local, rows: _Rows) -> None:
    """Value and rate at the right end are the exact integrals of the acceleration."""
    _, value, rate, *_ = local.arguments(1.0)
    scale = np.array([c.rate_scale for c in local.phase.coordinates])
    labels = ["continuity"] * len(scale)
    rows.add(local.right[0] - value, labels, 0.0, 0.0)
    rows.add((local.right[1] - rate) / scale, labels, 0.0, 0.0)


def _control_rates(local: _Local, problem: PhasedProblem, rows: _Rows) -> Any:
    """Bounds on, and cost of, the slopes of the controls in this element.

    A slope is linear, so it is largest at an end; the integral of its square is exact by
    Simpson's rule.
    """
    cost: Any = 0.0
    for i, u in enumerate(local.phase.controls):
        start, middle, end = (local.slope(i, s) for s in (0.0, 0.5, 1.0))
        if u.name in problem.control_rates:
            bound = problem.control_rates[u.name]
            rows.add(ca.vertcat(start, end) / bound, ["moment rate"] * 2, -1.0, 1.0)
        square = (start**2 + 4 * middle**2 + end**2) / 6
        cost = cost + problem.control_rate_cost.get(u.name, 0.0) * local.h * square
    return cost


def _element_indices(where: PhaseIndices) -> NDArray[np.int64]:
    """Local variables of every element, in the order of :class:`_Local`: (n_v, n_e)."""
    n_e = where.accelerations.shape[0]
    parts = [np.full((n_e, 1), where.times[0]), np.full((n_e, 1), where.times[1])]
    parts += [w[:-1] for w in (where.values, where.rates, where.controls)]
    parts += [w[1:] for w in (where.values, where.rates, where.controls)]
    parts.append(where.bulges)
    m = where.accelerations.shape[1]
    for j in range(m):
        parts += [where.accelerations[:, j], where.algebraics[:, j].reshape(n_e, -1)]
    for j in range(m):
        parts += [where.plus[:, j].reshape(n_e, -1), where.minus[:, j].reshape(n_e, -1)]
    return np.concatenate(parts, axis=1).T.astype(np.int64)


def _link_block(link: Link, problem: PhasedProblem, layout: Layout) -> Block:
    """Constraints on the values and rates at one boundary."""
    keys = sorted(k for k in layout.boundary if k[0] == link.boundary and k[2] != "control")
    time = ca.SX.sym("t")
    symbols = {k: ca.SX.sym("_".join(k[1:])) for k in keys}
    scaled = {k: layout.scale[layout.boundary[k]] * s for k, s in symbols.items()}
    names = {k[1] for k in keys}
    states = {
        n: State(scaled[link.boundary, n, "value"], scaled[link.boundary, n, "rate"])
        for n in names
    }
    terms: Terms = link.function(Instant(time, states, {}, {}))
    kernel = Kernel(
        link.name,
        ca.vertcat(time, *symbols.values()),
        ca.SX.sym("none", 0),
        ca.SX(0),
        ca.vertcat(*(row[1] for row in terms.rows)),
    )
    indices = [layout.times[link.boundary], *(layout.boundary[k] for k in keys)]
    return Block(
        kernel,
        np.array(indices, dtype=np.int64)[:, None],
        np.zeros((0, 1)),
        np.array([row[2] for row in terms.rows]),
        np.array([row[3] for row in terms.rows]),
        tuple(row[0] for row in terms.rows),
    )


def _time_block(problem: PhasedProblem, layout: Layout) -> Block:
    """Linear constraints between the boundary instants."""
    symbols = {name: ca.SX.sym(name) for name in layout.times}
    rows = [
        sum((f * symbols[name] for name, f in factors.items()), ca.SX(0))
        for _, factors, _, _ in problem.time_rows
    ]
    kernel = Kernel(
        "times", ca.vertcat(*symbols.values()), ca.SX.sym("none", 0), ca.SX(0), ca.vertcat(*rows)
    )
    return Block(
        kernel,
        np.array(list(layout.times.values()), dtype=np.int64)[:, None],
        np.zeros((0, 1)),
        np.array([row[2] for row in problem.time_rows]),
        np.array([row[3] for row in problem.time_rows]),
        tuple(row[0] for row in problem.time_rows),
    )


def _columns(names: list[str], values: Array) -> dict[str, Array]:
    return {name: values[:, i] for i, name in enumerate(names)}
