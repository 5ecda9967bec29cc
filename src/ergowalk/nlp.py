"""Nonlinear programmes made of named blocks, with exact sparse derivatives.

A block is one small function of a few local variables, used many times: once per element of a
mesh, say. Its derivatives are formed once, symbolically, evaluated for all uses together, and
scattered into the sparse Jacobian and Hessian of the whole. Nothing here knows what the
variables mean.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IndexArray = NDArray[np.int64]


@dataclass(frozen=True)
class Chain:
    """First and second derivatives of the rows of a kernel.

    Attributes
    ----------
    jacobian : function
        () -> SX (n_g, n_v).
    hessian : function
        Multipliers, SX (n_g,) -> Hessian of their product with the rows, SX (n_v, n_v).
    """

    jacobian: Callable[[], ca.SX]
    hessian: Callable[[ca.SX], ca.SX]

    @classmethod
    def of(cls, rows: ca.SX, variables: ca.SX) -> Chain:
        """By differentiating the expressions."""
        return cls(
            lambda: ca.jacobian(rows, variables),
            lambda multipliers: ca.hessian(ca.dot(multipliers, rows), variables)[0],
        )


@dataclass(frozen=True)
class Kernel:
    """Symbolic heart of a block: cost and constraint rows of one use.

    Attributes
    ----------
    variables : SX (n_v,)
        Local variables.
    parameters : SX (n_p,)
        Constants that differ from use to use; may be empty.
    cost : SX scalar
        Contribution to the objective.
    rows : SX (n_g,)
        Constraint expressions.
    expansion : function, optional
        Costly given functions of the variables, at all uses: (n_v, n), (n_p, n) -> (n_e, n).
        Its results are appended to the parameters, so nothing is differentiated through them: the
        expressions hold a Taylor polynomial around the present point instead, whose value and
        first two derivatives are those of the function.
    chain : Chain, optional
        Derivatives of the rows in a cheaper form than differentiating the expressions.
    """

    name: str
    variables: ca.SX
    parameters: ca.SX
    cost: ca.SX
    rows: ca.SX
    expansion: Callable[[Any, Any], Any] | None = None
    chain: Chain | None = None

    @property
    def identifier(self) -> str:
        """The name in letters that CasADi takes for a function."""
        return re.sub(r"[^0-9A-Za-z]+", "_", f"kernel {self.name}").strip("_")

    def all_parameters(self, variables: Any, parameters: Any) -> Any:
        """Parameters of all uses with the results of the expansion, as MX or DM."""
        if self.expansion is None:
            return parameters
        return ca.vertcat(parameters, self.expansion(variables, parameters))

    @cached_property
    def values(self) -> ca.Function:
        """(v, p) -> (cost, rows)."""
        inputs = [self.variables, self.parameters]
        return ca.Function(f"{self.identifier}_values", inputs, [self.cost, self.rows])

    @cached_property
    def gradient(self) -> ca.Function:
        """(v, p) -> dense gradient of the cost."""
        gradient = ca.densify(ca.gradient(self.cost, self.variables))
        return ca.Function(
            f"{self.identifier}_gradient", [self.variables, self.parameters], [gradient]
        )

    @cached_property
    def jacobian(self) -> ca.Function:
        """(v, p) -> sparse Jacobian of the rows."""
        chain = self.chain or Chain.of(self.rows, self.variables)
        jacobian = chain.jacobian()
        return ca.Function(
            f"{self.identifier}_jacobian", [self.variables, self.parameters], [jacobian]
        )

    @cached_property
    def hessian(self) -> ca.Function:
        """(v, p, weight, multipliers) -> upper triangle of the Hessian of the Lagrangian."""
        weight, multipliers = ca.SX.sym("w"), ca.SX.sym("l", self.rows.numel())
        chain = self.chain or Chain.of(self.rows, self.variables)
        hessian = ca.hessian(weight * self.cost, self.variables)[0] + chain.hessian(multipliers)
        hessian = ca.triu(hessian)
        inputs = [self.variables, self.parameters, weight, multipliers]
        return ca.Function(f"{self.identifier}_hessian", inputs, [hessian])


@dataclass(frozen=True)
class Block:
    """A kernel used ``n`` times.

    Attributes
    ----------
    kernel : Kernel
    indices : (n_v, n) integers
        Which variables of the programme are the local ones of each use.
    parameters : (n_p, n) array
    lower, upper : (n_g,) arrays
        Bounds of the rows, the same for each use.
    labels : n_g strings
        The constraint that each row belongs to.
    """

    kernel: Kernel
    indices: IndexArray
    parameters: Array
    lower: Array
    upper: Array
    labels: tuple[str, ...]

    @property
    def uses(self) -> int:
        """How often the kernel is used."""
        return int(self.indices.shape[1])


@dataclass(frozen=True)
class Oracle:
    """CasADi functions of the whole programme in the form that CasADi's solvers take."""

    values: ca.Function
    gradient: ca.Function
    jacobian: ca.Function
    hessian: ca.Function


@dataclass(frozen=True)
class NonlinearProgramme:
    """Minimise the sum of all block costs subject to bounds on variables and rows.

    Attributes
    ----------
    lower, upper : (n,) arrays
        Bounds of the variables; equal bounds fix a variable.
    blocks : sequence of Block
    """

    lower: Array
    upper: Array
    blocks: Sequence[Block]

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.lower)

    @cached_property
    def row_bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of all rows, in block order."""
        lower = [np.tile(b.lower, b.uses) for b in self.blocks]
        upper = [np.tile(b.upper, b.uses) for b in self.blocks]
        return np.concatenate(lower), np.concatenate(upper)

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """The constraint that each row belongs to."""
        return tuple(label for b in self.blocks for _ in range(b.uses) for label in b.labels)

    @cached_property
    def oracle(self) -> Oracle:
        """Exact values and derivatives as CasADi functions of (x, p); p is empty."""
        x, p = ca.MX.sym("x", self.size), ca.MX.sym("p", 0)
        local = [_gather(x, b.indices) for b in self.blocks]
        given = [
            b.kernel.all_parameters(v, b.parameters)
            for b, v in zip(self.blocks, local, strict=True)
        ]
        pairs = list(zip(local, given, strict=True))
        cost, rows = self._values(pairs)
        gradient = self._gradient(pairs)
        jacobian = self._jacobian(pairs)
        weight, multipliers = ca.MX.sym("w"), ca.MX.sym("l", len(self.labels))
        hessian = self._hessian(pairs, weight, multipliers)
        return Oracle(
            ca.Function("nlp", [x, p], [cost, rows], ["x", "p"], ["f", "g"]),
            ca.Function("nlp_grad_f", [x, p], [cost, gradient], ["x", "p"], ["f", "grad_f_x"]),
            ca.Function("nlp_jac_g", [x, p], [rows, jacobian], ["x", "p"], ["g", "jac_g_x"]),
            ca.Function(
                "nlp_hess_l",
                [x, p, weight, multipliers],
                [hessian],
                ["x", "p", "lam_f", "lam_g"],
                ["triu_hess_gamma_x_x"],
            ),
        )

    def evaluate(self, x: Array) -> tuple[float, Array]:
        """Objective and rows at x; cheap where no derivative is asked for."""
        cost, rows = 0.0, []
        for block in self.blocks:
            v = x[block.indices]
            p = block.kernel.all_parameters(v, block.parameters)
            c, g = _mapped(block.kernel.values, block.uses)(v, p)
            cost += float(ca.sum2(c))
            rows.append(np.asarray(g).ravel(order="F"))
        return cost, np.concatenate(rows)

    def violations(self, x: Array, rows: Array | None = None) -> dict[str, float]:
        """Largest violation of each named constraint at x, in the rows' own scale."""
        values = self.evaluate(x)[1] if rows is None else rows
        lower, upper = self.row_bounds
        excess = np.maximum(np.maximum(lower - values, values - upper), 0.0)
        worst: dict[str, float] = {}
        for label, value in zip(self.labels, excess, strict=True):
            worst[label] = max(worst.get(label, 0.0), float(value))
        return worst

    def _values(self, local: list[tuple[ca.MX, Any]]) -> tuple[ca.MX, ca.MX]:
        cost: ca.MX = ca.MX(0)
        rows = []
        for block, (v, p) in zip(self.blocks, local, strict=True):
            c, g = _mapped(block.kernel.values, block.uses)(v, p)
            cost = cost + ca.sum2(c)
            rows.append(ca.vec(g))
        return cost, ca.vertcat(*rows)

    def _gradient(self, local: list[tuple[ca.MX, Any]]) -> ca.MX:
        pieces = [
            ca.vec(_mapped(b.kernel.gradient, b.uses)(v, p))
            for b, (v, p) in zip(self.blocks, local, strict=True)
        ]
        where = np.concatenate([b.indices.ravel(order="F") for b in self.blocks])
        # the solver reads as many numbers as there are variables, zeros that are known included
        return ca.densify(_scatter(where, self.size) @ ca.vertcat(*pieces))

    def _jacobian(self, local: list[tuple[ca.MX, Any]]) -> ca.MX:
        values, row, column = [], [], []
        first = 0
        for block, (v, p) in zip(self.blocks, local, strict=True):
            function = block.kernel.jacobian
            pattern = function.sparsity_out(0)
            r, c = (np.array(a, dtype=np.int64) for a in pattern.get_triplet())
            n_g = len(block.labels)
            entries = _mapped(function, block.uses)(v, p).nz[:]
            values.append(ca.vec(entries))  # nonzeros of a single row come as a row
            row.append((r[:, None] + first + n_g * np.arange(block.uses)).ravel(order="F"))
            column.append(block.indices[c].ravel(order="F"))
            first += n_g * block.uses
        return _assemble(values, row, column, (first, self.size))

    def _hessian(self, local: list[tuple[ca.MX, Any]], weight: ca.MX, multipliers: ca.MX) -> ca.MX:
        values, row, column = [], [], []
        first = 0
        for block, (v, p) in zip(self.blocks, local, strict=True):
            function = block.kernel.hessian
            pattern = function.sparsity_out(0)
            r, c = (np.array(a, dtype=np.int64) for a in pattern.get_triplet())
            n_g, uses = len(block.labels), block.uses
            own = ca.reshape(multipliers[first : first + n_g * uses], n_g, uses)
            weights = ca.repmat(weight, 1, uses)
            result = _mapped(function, uses)(v, p, weights, own)
            i, j = block.indices[r].ravel(order="F"), block.indices[c].ravel(order="F")
            # two local variables that are one variable: both triangles fall on the diagonal
            twice = (i == j) & np.tile(r != c, uses)
            entries = ca.vec(result.nz[:])
            values.append(ca.DM(np.where(twice, 2.0, 1.0)) * entries if twice.any() else entries)
            row.append(np.minimum(i, j))
            column.append(np.maximum(i, j))
            first += n_g * uses
        return _assemble(values, row, column, (self.size, self.size))


def _mapped(function: ca.Function, uses: int) -> ca.Function:
    return function if uses == 1 else function.map(uses)


def _gather(x: ca.MX, indices: IndexArray) -> ca.MX:
    n_v, uses = indices.shape
    return ca.reshape(x[indices.ravel(order="F").tolist()], n_v, uses)


def _scatter(where: IndexArray, size: int) -> ca.DM:
    """0/1 matrix that adds entry k of a vector to place ``where[k]``."""
    columns = np.arange(len(where))
    pattern = ca.Sparsity.triplet(size, len(where), where.tolist(), columns.tolist())
    return ca.DM(pattern, np.ones(len(where)))


def _assemble(
    values: list[ca.MX], row: list[IndexArray], column: list[IndexArray], shape: tuple[int, int]
) -> ca.MX:
    """Sparse matrix from triplets; entries that fall on the same place are added."""
    rows, columns = np.concatenate(row), np.concatenate(column)
    key = columns * shape[0] + rows  # column-major order, CasADi's own
    unique, where = np.unique(key, return_inverse=True)
    pattern = ca.Sparsity.triplet(
        shape[0], shape[1], (unique % shape[0]).tolist(), (unique // shape[0]).tolist()
    )
    return ca.MX(pattern, _scatter(where, len(unique)) @ ca.vertcat(*values))
