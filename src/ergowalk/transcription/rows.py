"""The constraint rows of one element, and their derivatives by the chain rule.

Functions of an instant are differentiated with respect to their own few arguments; these are
polynomials of the element's variables, with sparse derivatives. Differentiating the composed
expressions instead sweeps through all functions once for every variable: two to four times the
work in every iteration.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.nlp import Chain
from ergowalk.transcription.functions import Call

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Block:
    """Rows that came together: a plain expression plus ``weight`` times outputs of a call."""

    plain: Any
    call: Call | None = None
    first: int = 0
    weight: float = 1.0

    @property
    def outputs(self) -> slice:
        """Which outputs of the call they are: as many as there are rows, from ``first`` on."""
        return slice(self.first, self.first + self.plain.numel())

    @property
    def expression(self) -> Any:
        if self.call is None:
            return self.plain
        return self.plain + self.weight * self.call.outputs[self.outputs, :]


class Rows:
    """Constraint rows as they come, with labels, bounds and places.

    A place is the local fraction of the element at which a phase function was called; not a
    number for rows that belong to the element as a whole.
    """

    def __init__(self) -> None:
        self.labels: list[str] = []
        self.places: list[float] = []
        self._blocks: list[_Block] = []
        self._lower: list[Array] = []
        self._upper: list[Array] = []

    @property
    def expression(self) -> Any:
        """All rows, SX (n_g,)."""
        return ca.vertcat(*(block.expression for block in self._blocks))

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of all rows, (n_g,) each."""
        return np.concatenate(self._lower), np.concatenate(self._upper)

    def add(self, expression: Any, labels: Sequence[str], lower: Any, upper: Any) -> None:
        """Rows of a plain expression."""
        self._append(_Block(expression), labels, lower, upper)

    def add_call(self, call: Call, place: float) -> None:
        """The rows of a phase function at a local fraction of the element."""
        f = call.function
        if f.labels:
            block = _Block(ca.SX(len(f.labels), 1), call)
            self._append(block, f.labels, f.lower, f.upper, place)

    def add_slacks(self, call: Call, difference: Any, scale: float) -> None:
        """``difference`` of two slacks equals what an absolute value is taken of, over scale."""
        if not call.function.n_abs:
            return
        block = _Block(difference, call, len(call.function.labels), -1.0 / scale)
        self._append(block, ["power slacks"] * call.function.n_abs, 0.0, 0.0)

    def _append(
        self,
        block: _Block,
        labels: Sequence[str],
        lower: Any,
        upper: Any,
        place: float = math.nan,
    ) -> None:
        self.places += [place] * len(labels)
        self._blocks.append(block)
        self.labels += labels
        self._lower.append(np.broadcast_to(np.asarray(lower, dtype=float), len(labels)))
        self._upper.append(np.broadcast_to(np.asarray(upper, dtype=float), len(labels)))

    def chain(self, variables: Any) -> Chain:
        """First and second derivatives of all rows, formed when they are asked for."""
        calls = list({id(b.call): b.call for b in self._blocks if b.call is not None}.values())

        def jacobian() -> Any:
            jacobians = {id(call): call.jacobian(variables) for call in calls}
            parts = []
            for block in self._blocks:
                part = ca.jacobian(block.plain, variables)
                if block.call is not None:
                    part = part + block.weight * jacobians[id(block.call)][block.outputs, :]
                parts.append(part)
            return ca.vertcat(*parts)

        def hessian(multipliers: Any) -> Any:
            first, plain = 0, ca.SX(0)
            weights = {id(call): ca.SX(call.outputs.numel(), 1) for call in calls}
            for block in self._blocks:
                own = multipliers[first : first + block.plain.numel()]
                first += block.plain.numel()
                plain = plain + ca.dot(own, block.plain)
                if block.call is not None:
                    weights[id(block.call)][block.outputs] = block.weight * own
            total = ca.hessian(plain, variables)[0]
            for call in calls:
                total = total + call.hessian(weights[id(call)], variables)
            return total

        return Chain(jacobian, hessian)
