"""The programme (18) without corners, for solvers with exact second derivatives.

The same unknowns, with what follows from them as further variables: all data, and value, rate and
acceleration of each free function at each instant, tied by linear rows. Absolute powers are sums
of two slacks. Rows hold at the Gauss points and at the knots, one limit from each side where the
phase changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ergowalk.corridors import ANGLES
from ergowalk.nlp import Block, Kernel, NonlinearProgramme
from ergowalk.problem import DoubleSupport
from ergowalk.problem.objective import energy_per_metre
from ergowalk.transcription.spline.curves import HIP, SWING_FOOT, TRUNK
from ergowalk.transcription.spline.programme import SplineProgramme
from ergowalk.transcription.spline.rows import (
    Asked,
    Row,
    instant_rows,
    moment_rows,
    six_moments,
)
from ergowalk.transcription.spline.sampling import Grid
from ergowalk.transcription.spline.semi_inverse import SHARED, Instant

Array = NDArray[np.float64]
IndexArray = NDArray[np.int64]

TURN, LINE = (1.0, 3.0, 30.0), (1.0, 1.5, 10.0)
"""Typical value, rate and acceleration of an angle [rad] and of an abscissa [m]."""

JUMP = 3e-3
"""How far a moment per kg may jump at a phase change [N m/kg]: a third of what the audit allows
a moment rate."""

SWING_FOOT_COST = 1e-7
"""Weight of the squared angular acceleration of a free swing foot, which nothing else sees, in
the integral of absolute power per kg [J/kg]."""


@dataclass(frozen=True)
class PhaseBlock:
    """One phase: its kernel, its instants and where its variables stand."""

    instant: Instant
    grid: Grid
    kernel: Kernel
    rows: tuple[Row, ...]
    absolute: ca.Function
    local: IndexArray
    slacks: IndexArray
    moments: IndexArray


class SmoothProgramme:
    """A :class:`SplineProgramme` as a :class:`~ergowalk.nlp.NonlinearProgramme`.

    Parameters
    ----------
    spline : SplineProgramme
    asked : Asked
        The constraints of the paper's programme, or all that the problem asks for. The latter
        need the ``extras`` of the spline programme, and knots enough.
    """

    def __init__(self, spline: SplineProgramme, asked: Asked = Asked.PAPER) -> None:
        self.spline, self.asked = spline, asked
        self.limits, self.mass = spline.problem.limits, spline.problem.body.total_mass
        self._scales: list[Array] = []
        self.data = self._new(np.ones(spline.curves.size))
        weight = self.mass * spline.problem.body.gravity_m_s2
        self.shared = self._new(np.array([weight, 1.0, weight]))
        self.phases = tuple(
            self._phase(instant, grid)
            for instant, grid in zip(spline.sampler.instants, self._grids(), strict=True)
        )
        self.scale = np.concatenate(self._scales)

    @cached_property
    def programme(self) -> NonlinearProgramme:
        """The programme; its objective is half the stride's absolute work per kg [J/kg]."""
        lower, upper = np.full(len(self.scale), -np.inf), np.full(len(self.scale), np.inf)
        blocks = [self._closure(), *self._sharing()]
        for part in self.phases:
            blocks += [*self._ties(part), self._phase_block(part)]
            lower[part.slacks] = 0.0
        if self.asked is Asked.EVERYTHING:
            blocks += self._rates()
        held = self._held()
        lower[held] = upper[held] = self.spline.start[held]
        return NonlinearProgramme(lower, upper, blocks)

    def energy(self, objective: float) -> float:
        """E [J/m] at the Gauss points from the objective."""
        return float(energy_per_metre(objective * self.mass, self.spline.problem.step_length_m))

    def pack(self, unknowns: ArrayLike) -> Array:
        """All variables for given C, slacks from the powers."""
        x, sampler = np.zeros(len(self.scale)), self.spline.sampler
        data = x[self.data] = self.spline.data(unknowns)
        shared = x[self.shared] = sampler.shared_values(data).full().ravel()
        for part in self.phases:
            n = len(part.grid.times)
            matrix, offset = sampler.locals(part.instant, part.grid.times)
            local = x[part.local] = (matrix @ data + offset).reshape(n, -1).T
            known, given = sampler.known(part.grid.times), np.tile(shared[:, None], (1, n))
            powers, moments = (y.full() for y in part.absolute.map(n)(local, known, given))
            x[part.slacks] = np.concatenate([np.maximum(powers, 0), np.maximum(-powers, 0)])
            x[part.moments] = moments[: len(part.moments)]
        return x / self.scale

    def unpack(self, x: Array) -> Array:
        """C of a point."""
        return self.spline.unknowns_of((x * self.scale)[self.data])

    # --- variables ------------------------------------------------------------------------

    def _new(self, scale: Array) -> IndexArray:
        first = sum(map(len, self._scales))
        self._scales.append(np.asarray(scale, dtype=float))
        return np.arange(first, first + len(scale))

    def _grids(self) -> list[Grid]:
        """Gauss points and knots of each phase in time order; knots have no weight."""
        sampler, samples, found = self.spline.sampler, self.spline.samples, []
        for grid, (phase, knots) in zip(sampler.gauss(samples), sampler.intervals(), strict=True):
            inside = grid.times.reshape(-1, samples)
            times = np.append(np.column_stack([knots[:-1], inside]).ravel(), knots[-1])
            own = np.column_stack([np.zeros(len(inside)), grid.weights.reshape(inside.shape)])
            weights = np.append(own.ravel(), 0.0)
            found.append(Grid(phase, times, weights))
        return found

    def _held(self) -> IndexArray:
        """Data that are neither unknown nor settled by a constraint."""
        settled = {place for place, _ in self._settlements[1]}
        free = settled | set(self.spline.places.tolist())
        return np.array(sorted(set(range(self.spline.curves.size)) - free), dtype=np.int64)

    def _phase(self, instant: Instant, grid: Grid) -> PhaseBlock:
        """Kernel and variables of a phase; the order of variables is v, shared, slacks, moments."""
        n, n_p = len(grid.times), len(instant.powers)
        scales = [LINE if f.name in (HIP, TRUNK) else TURN for f in instant.functions]
        scale = np.concatenate(scales)
        n_m = 6 if self.asked is Asked.EVERYTHING else 0
        local = self._new(np.tile(scale, n)).reshape(n, -1).T
        slacks = self._new(np.full(2 * n_p * n, 1.0)).reshape(n, -1).T
        moments = self._new(np.full(n_m * n, 1.0)).reshape(n, n_m).T
        v, s = ca.SX.sym("v", len(scale)), ca.SX.sym("s", len(SHARED))
        slack, lifted, weight = ca.SX.sym("e", 2 * n_p), ca.SX.sym("m", n_m), ca.SX.sym("w")
        powers = [power / self.mass for power in instant.powers]
        rows = [
            Row("power slacks", slack[j] - slack[n_p + j] - power, 0.0, 0.0)
            for j, power in enumerate(powers)
        ]
        rows += instant_rows(instant, self.asked, self.limits)
        if n_m:
            rows += moment_rows(lifted, instant, self.limits)
        expression = ca.vertcat(*(ca.SX(row.expression) for row in rows))
        cost = weight * ca.sum1(slack)
        for i, f in enumerate(instant.functions):
            if f.name == SWING_FOOT and SWING_FOOT in self.spline.extras:
                cost = cost + SWING_FOOT_COST * weight * (v[3 * i + 2] * TURN[2]) ** 2
        kernel = Kernel(
            instant.phase.name,
            ca.vertcat(v, s, slack, lifted),
            ca.vertcat(instant.known, weight),
            cost,
            _scaled(expression, instant, (v * scale, s * self._scales[1])),
        )
        inputs = [instant.variables, instant.known, instant.shared]
        outputs = [ca.vertcat(*(ca.SX(x) for x in y)) for y in (powers, six_moments(instant))]
        absolute = ca.Function("absolute", inputs, outputs)
        return PhaseBlock(instant, grid, kernel, tuple(rows), absolute, local, slacks, moments)

    # --- blocks ---------------------------------------------------------------------------

    @cached_property
    def _settlements(self) -> tuple[ca.SX, list[tuple[int, Any]]]:
        return self.spline.sampler.settlements()

    def _closure(self) -> Block:
        """Data that (2), (4), (5), (7) determine."""
        symbols, found = self._settlements
        expression = ca.cse(ca.vertcat(*(e for _, e in found)))
        rows = [Row("closure (2)-(7)", e, 0.0, 0.0) for e in ca.vertsplit(expression)]
        return _block("closure", symbols, rows, self.data[:, None])

    def _sharing(self) -> list[Block]:
        """What double support starts from (12); what this problem has no use for is zero."""
        linear = self.spline.problem.double_support is DoubleSupport.LINEAR
        from_end = [0, 1] if linear else [0]
        from_flat = [2] if self.spline.curves.phases[1].double_support else []
        blocks = [self._carried(self.phases[-1], from_end)]
        if from_flat:
            blocks.append(self._carried(self.phases[0], from_flat))
        symbol = ca.SX.sym("s")
        idle = [i for i in range(len(SHARED)) if i not in from_end + from_flat]
        if idle:
            row = [Row("sharing (12)", symbol, 0.0, 0.0)]
            blocks.append(_block("idle", symbol, row, self.shared[idle][None]))
        return blocks

    def _carried(self, part: PhaseBlock, which: list[int]) -> Block:
        """Shared quantities that the last instant of a phase determines."""
        instant, scale = part.instant, self._scales[1]
        v, s = ca.SX.sym("v", len(part.local)), ca.SX.sym("s", len(SHARED))
        expression = ca.vertcat(
            *((ca.SX(instant.carried[i]) - instant.shared[i]) / scale[i] for i in which)
        )
        physical = (v * np.concatenate(self._scales)[part.local[:, -1]], s * scale)
        expression = _scaled(expression, instant, physical)
        rows = [Row("sharing (12)", e, 0.0, 0.0) for e in ca.vertsplit(expression)]
        indices = np.concatenate([part.local[:, -1], self.shared])[:, None]
        known = self.spline.sampler.known(part.grid.times[-1:])
        return _block("carried", ca.vertcat(v, s), rows, indices, instant.known, known)

    def _ties(self, part: PhaseBlock) -> list[Block]:
        """Value, rate, acceleration of each function at each instant, from its data."""
        curves, blocks = self.spline.curves, []
        for i, f in enumerate(part.instant.functions):
            curve, own = curves.all[f.name], part.local[3 * i : 3 * i + 3]
            k, scale = curve.spline.parameters, self.scale[own[:, 0]]
            places = slice(curve.first, curve.first + k)
            later = part.grid.times + f.half_strides_later * curves.half
            factors = [curves.rows(f.name, later, d)[:, places].T / scale[d] for d in range(3)]
            offsets = [curves.offset(f.name, later, d)[None] / scale[d] for d in range(3)]
            data, local = ca.SX.sym("z", k), ca.SX.sym("v", 3)
            factor, offset = ca.SX.sym("m", 3 * k), ca.SX.sym("o", 3)
            expression = local - ca.reshape(factor, k, 3).T @ data - offset
            rows = [Row("splines (13)", e, 0.0, 0.0) for e in ca.vertsplit(expression)]
            all_data = np.tile(self.data[places][:, None], (1, len(later)))
            blocks.append(
                _block(
                    f"tie_{f.name}",
                    ca.vertcat(data, local),
                    rows,
                    np.concatenate([all_data, own]),
                    ca.vertcat(factor, offset),
                    np.concatenate([*factors, *offsets]),
                )
            )
        return blocks

    def _phase_block(self, part: PhaseBlock) -> Block:
        shared = np.tile(self.shared[:, None], (1, len(part.grid.times)))
        known = self.spline.sampler.known(part.grid.times)
        return Block(
            part.kernel,
            np.concatenate([part.local, shared, part.slacks, part.moments]),
            np.concatenate([known, part.grid.weights[None]]),
            np.array([row.lower for row in part.rows]),
            np.array([row.upper for row in part.rows]),
            tuple(row.label for row in part.rows),
        )

    def _rates(self) -> list[Block]:
        """Moment rates between neighbouring instants, and no jump where the phase changes or the
        legs exchange."""
        values, step, blocks = ca.SX.sym("m", 2), ca.SX.sym("h"), []
        change, phases = values[1] - values[0], self.phases
        steps = np.concatenate([np.diff(part.grid.times) for part in phases])
        for j in range(6):
            bound = self.limits.moment_rate_nm_per_kg_s.of(ANGLES[j % 3])
            if bound is None:
                continue
            own = [np.stack([part.moments[j, :-1], part.moments[j, 1:]]) for part in phases]
            row = [Row("moment rate", change / (step * bound), -1.0, 1.0)]
            blocks.append(_block("rate", values, row, np.hstack(own), step, steps[None]))
            ends = [(a.moments[j, -1], b.moments[j, 0]) for a, b in pairwise(phases)]
            ends.append((phases[-1].moments[(j + 3) % 6, -1], phases[0].moments[j, 0]))
            row = [Row("moment rate", change, -JUMP, JUMP)]
            blocks.append(_block("jump", values, row, np.array(ends).T))
        return blocks


def _block(
    name: str,
    variables: ca.SX,
    rows: list[Row],
    indices: IndexArray,
    parameters: ca.SX | None = None,
    values: Array | None = None,
) -> Block:
    """A block without cost."""
    symbols = ca.SX.sym("p", 0) if parameters is None else parameters
    given = np.zeros((0, indices.shape[1])) if values is None else values
    expression = ca.vertcat(*(row.expression for row in rows))
    return Block(
        Kernel(name, variables, symbols, ca.SX(0), expression),
        indices,
        given,
        np.array([row.lower for row in rows]),
        np.array([row.upper for row in rows]),
        tuple(row.label for row in rows),
    )


def _scaled(expression: ca.SX, instant: Instant, physical: tuple[ca.SX, ca.SX]) -> ca.SX:
    """An expression of an instant in terms of a solver's variables."""
    symbols = [instant.variables, instant.shared]
    return ca.cse(ca.substitute([expression], symbols, list(physical))[0])
