"""Direct collocation of a phased problem: one kernel per phase, one use per element."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from functools import cached_property

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.nlp import Block, Kernel, NonlinearProgramme
from ergowalk.transcription.curves import Guess, PhaseCurves, Trajectory
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.layout import Layout, Mesh, PhaseIndices, lay_out
from ergowalk.transcription.phases import Instant, Link, PhasedProblem, State, Terms
from ergowalk.transcription.scheme import GaussScheme

Array = NDArray[np.float64]


class Collocation:
    """A phased problem on a mesh: builds the programme, packs guesses, unpacks points.

    Parameters
    ----------
    problem : PhasedProblem
    mesh : one array of element boundaries (0 ... 1) per phase
    m : int
        Gauss points per element.
    store : KernelStore, optional
        Kernels built before; missing ones are added.
    """

    def __init__(
        self,
        problem: PhasedProblem,
        mesh: Mesh,
        m: int,
        store: KernelStore | None = None,
    ) -> None:
        self.problem, self.mesh, self.scheme = problem, mesh, GaussScheme(m)
        store = KernelStore() if store is None else store
        self.kernels = tuple(store.kernel(p, self.scheme) for p in problem.phases)
        n_abs = tuple(kernel.n_abs for kernel in self.kernels)
        self.layout: Layout = lay_out(problem, mesh, m, n_abs)

    @property
    def elements(self) -> int:
        """Number of elements of all phases."""
        return sum(len(fractions) - 1 for fractions in self.mesh)

    @cached_property
    def signature(self) -> str:
        """A digest of what the unknowns and rows of an element of each phase are.

        Where it is the same, a point and its multipliers on one mesh mean the same.
        """
        kinds = [
            (pk.kernel.name, pk.kernel.variables.numel(), pk.labels, pk.places.tolist())
            for pk in self.kernels
        ]
        return hashlib.sha256(repr(kinds).encode()).hexdigest()[:16]

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

    def pack(
        self, guess: Guess, times: Mapping[str, float], shared: Mapping[str, float] | None = None
    ) -> Array:
        """Variables for a guess: curves sampled at mesh and Gauss points, slacks from powers."""
        layout, x = self.layout, np.zeros(self.layout.size)
        for name, index in layout.times.items():
            x[index] = times[name]
        for name, index in layout.shared.items():
            x[index] = (shared or {})[name]
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
        for index in layout.times.values():
            x[index] = np.clip(x[index], layout.lower[index], layout.upper[index])
        x = np.clip(np.nan_to_num(x / layout.scale), layout.lower, layout.upper)
        return self._with_slacks(x)

    def _with_slacks(self, x: Array) -> Array:
        for pk, where, fractions in zip(self.kernels, self.layout.phases, self.mesh, strict=True):
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
        for name, index in self.layout.shared.items():
            if name in coarse.layout.shared:
                new_variables[index] = variables[coarse.layout.shared[name]]
        new_rows, first = [], 0
        for here, there, fine, old, pk in zip(
            self.layout.phases,
            coarse.layout.phases,
            self.mesh,
            coarse.mesh,
            self.kernels,
            strict=True,
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

    def repeat_multipliers(
        self, part: Collocation, variables: Array, rows: Array
    ) -> tuple[Array, Array]:
        """Multipliers of a chain of phases that stands in this problem several times, on one mesh.

        Zero for rows between phases, and for phases whose rows are not those of the part.
        """
        new_variables, new_rows = np.zeros(self.layout.size), []
        blocks, first = [], 0
        for mesh, pk in zip(part.mesh, part.kernels, strict=True):
            size = len(pk.labels) * (len(mesh) - 1)
            blocks.append(rows[first : first + size])
            first += size
        for i, (where, pk) in enumerate(zip(self.layout.phases, self.kernels, strict=True)):
            k = i % len(part.mesh)
            there, old = part.layout.phases[k], part.kernels[k]
            size = len(pk.labels) * (len(self.mesh[i]) - 1)
            if pk.labels != old.labels or len(self.mesh[i]) != len(part.mesh[k]):
                new_rows.append(np.zeros(size))
                continue
            new_rows.append(blocks[k])
            for name in ("algebraics", "plus", "minus"):
                new_variables[getattr(where, name)] = variables[getattr(there, name)]
        known = sum(map(len, new_rows))
        new_rows.append(np.zeros(len(self.programme.labels) - known))
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
        shared = {name: float(physical[i]) for name, i in self.layout.shared.items()}
        return Trajectory(times, tuple(pieces), shared)


def _element_indices(where: PhaseIndices) -> NDArray[np.int64]:
    """Local variables of every element, in the order of :class:`_Local`: (n_v, n_e)."""
    n_e = where.accelerations.shape[0]
    parts = [np.tile(np.array([*where.times, *where.shared], dtype=np.int64), (n_e, 1))]
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
    keys = sorted(
        k
        for k in layout.boundary
        if k[0] == link.boundary and (k[2] != "control" or k[1] in link.controls)
    )
    time = ca.SX.sym("t")
    symbols = {k: ca.SX.sym("_".join(k[1:])) for k in keys}
    scaled = {k: layout.scale[layout.boundary[k]] * s for k, s in symbols.items()}
    shared = {x.name: ca.SX.sym(x.name) for x in problem.shared}
    common = {x.name: x.scale * shared[x.name] for x in problem.shared}
    names = {k[1] for k in keys if k[2] != "control"}
    controls = {n: scaled[link.boundary, n, "control"] for n in link.controls}
    states = {
        n: State(scaled[link.boundary, n, "value"], scaled[link.boundary, n, "rate"]) for n in names
    }
    terms: Terms = link.function(Instant(time, states, controls, {}, shared=common))
    kernel = Kernel(
        link.name,
        ca.vertcat(time, *symbols.values(), *shared.values()),
        ca.SX.sym("none", 0),
        ca.SX(0),
        ca.vertcat(*(row[1] for row in terms.rows)),
    )
    indices = [layout.times[link.boundary], *(layout.boundary[k] for k in keys)]
    indices += layout.shared.values()
    return Block(
        kernel,
        np.array(indices, dtype=np.int64)[:, None],
        np.zeros((0, 1)),
        np.array([row[2] for row in terms.rows]),
        np.array([row[3] for row in terms.rows]),
        tuple(row[0] for row in terms.rows),
    )


def _time_block(problem: PhasedProblem, layout: Layout) -> Block:
    """Linear constraints between the boundary instants and what is shared."""
    places = {**layout.times, **layout.shared}
    symbols = {name: ca.SX.sym(name) for name in places}
    scaled = {name: layout.scale[i] * symbols[name] for name, i in places.items()}
    rows = [
        sum((f * scaled[name] for name, f in factors.items()), ca.SX(0))
        for _, factors, _, _ in problem.time_rows
    ]
    kernel = Kernel(
        "times", ca.vertcat(*symbols.values()), ca.SX.sym("none", 0), ca.SX(0), ca.vertcat(*rows)
    )
    return Block(
        kernel,
        np.array(list(places.values()), dtype=np.int64)[:, None],
        np.zeros((0, 1)),
        np.array([row[2] for row in problem.time_rows]),
        np.array([row[3] for row in problem.time_rows]),
        tuple(row[0] for row in problem.time_rows),
    )
