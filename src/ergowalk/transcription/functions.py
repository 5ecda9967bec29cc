"""Phase functions turned into CasADi functions of an instant, with their own derivatives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from ergowalk.transcription.phases import Instant, PhaseModel, State, Terms

_ONCE = {"cse": True}
"""Expressions that occur twice are computed once."""


class CompiledFunction:
    """A phase function compiled once, then called at many instants.

    Its arguments are those of :class:`~ergowalk.transcription.phases.Instant`, one below the
    other; its outputs are the rows, then what absolute values are taken of. ``kind`` "mesh" hides
    the algebraic variables, which do not exist at mesh points.
    """

    def __init__(self, phase: PhaseModel, function: Callable[[Instant], Terms], kind: str) -> None:
        names = [c.name for c in phase.coordinates]
        controls = [u.name for u in phase.controls]
        algebraics = [z.name for z in phase.algebraics]
        given = [name for curves in phase.curves for name in curves.names]
        sizes = (1, *[len(names)] * 3, *[len(controls)] * 2, len(algebraics), len(given))
        symbols = [ca.SX.sym(f"s{i}", n) for i, n in enumerate((*sizes, len(phase.shared)))]
        t, value, rate, acceleration, control, slope, z, curves, shared = symbols
        terms = function(
            Instant(
                t,
                {n: State(value[i], rate[i], acceleration[i]) for i, n in enumerate(names)},
                {n: control[i] for i, n in enumerate(controls)},
                {} if kind == "mesh" else {n: z[i] for i, n in enumerate(algebraics)},
                {n: slope[i] for i, n in enumerate(controls)},
                {n: curves[i] for i, n in enumerate(given)},
                {x.name: shared[i] for i, x in enumerate(phase.shared)},
            )
        )
        self.labels = [row[0] for row in terms.rows]
        self.lower = np.array([row[2] for row in terms.rows])
        self.upper = np.array([row[3] for row in terms.rows])
        self.n_abs = len(terms.absolute)
        outputs = ca.vertcat(*(ca.SX(row[1]) for row in terms.rows), *map(ca.SX, terms.absolute))
        arguments, integrand = ca.vertcat(*symbols), ca.SX(terms.integrand)
        everything = ca.vertcat(outputs, integrand)
        self.sees_curves = bool(given) and bool(ca.depends_on(everything, curves))
        self.function = ca.Function(kind, [arguments], [outputs, integrand])
        self._arguments, self._outputs = arguments, outputs

    @cached_property
    def jacobian(self) -> ca.Function:
        """Arguments -> derivatives of the outputs."""
        jacobian = ca.jacobian(self._outputs, self._arguments)
        return ca.Function("jacobian", [self._arguments], [jacobian], _ONCE)

    @cached_property
    def hessian(self) -> ca.Function:
        """(arguments, multipliers) -> Hessian and gradient of multipliers times outputs."""
        multipliers = ca.SX.sym("multipliers", self._outputs.numel())
        derivatives = ca.hessian(ca.dot(multipliers, self._outputs), self._arguments)
        return ca.Function("hessian", [self._arguments, multipliers], derivatives, _ONCE)

    def at(self, arguments: Any) -> Call:
        """The function at symbolic arguments."""
        outputs, integrand = self.function(arguments)
        return Call(self, arguments, outputs, integrand)


@dataclass(frozen=True)
class Call:
    """A compiled function called at one place of an element."""

    function: CompiledFunction
    arguments: Any
    outputs: Any
    integrand: Any

    @property
    def absolute(self) -> Any:
        """What absolute values are taken of, (n_abs,)."""
        return self.outputs[len(self.function.labels) :, :]

    def jacobian(self, variables: Any) -> Any:
        """Derivatives of the outputs with respect to the variables behind the arguments."""
        return self.function.jacobian(self.arguments) @ ca.jacobian(self.arguments, variables)

    def hessian(self, multipliers: Any, variables: Any) -> Any:
        """Second derivatives of multipliers times outputs with respect to the variables."""
        hessian, gradient = self.function.hessian(self.arguments, multipliers)
        inner = ca.jacobian(self.arguments, variables)
        symbols = ca.SX.sym("gradient", self.arguments.numel())
        bent = ca.hessian(ca.dot(symbols, self.arguments), variables)[0]
        return inner.T @ (hessian @ inner) + ca.substitute(bent, symbols, gradient)
