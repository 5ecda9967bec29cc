"""The language in which a problem is put to the collocation: phases and functions of an instant.

Coordinates have rates and accelerations (second-order dynamics); controls are continuous and
parabolas within an element (straight lines where an element has two Gauss points); algebraic
variables live at the Gauss points. A phase tells what must hold inside, at mesh points, and at the
ends of elements. Unknowns that
belong to no instant are shared by all phases. Nothing here knows about walking.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

INF = float("inf")


@dataclass(frozen=True)
class Unknown:
    """A named unknown: bounds in its own unit, and the scale that the solver divides by."""

    name: str
    lower: float = -INF
    upper: float = INF
    scale: float = 1.0


@dataclass(frozen=True)
class Coordinate:
    """A second-order coordinate with bounds on its value and scales of rate and acceleration."""

    name: str
    lower: float = -INF
    upper: float = INF
    rate_scale: float = 1.0
    acceleration_scale: float = 1.0


@dataclass(frozen=True)
class State:
    """Value, rate and acceleration of a coordinate at an instant, as symbols."""

    value: Any
    rate: Any
    acceleration: Any = 0.0


@dataclass(frozen=True)
class Instant:
    """What a phase function sees: symbols at one instant."""

    time: Any
    coordinates: Mapping[str, State]
    controls: Mapping[str, Any]
    algebraics: Mapping[str, Any]
    control_slopes: Mapping[str, Any] = field(default_factory=dict)
    curves: Mapping[str, Any] = field(default_factory=dict)
    shared: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class TimeCurves:
    """Given functions of time alone that phase functions use, a corridor's edges say.

    Attributes
    ----------
    names
        One per function; a phase function finds them in ``Instant.curves``.
    evaluate
        Row of instants (1, n) -> their values, then first, then second time derivatives, as a
        matrix (3 len(names), n), of CasADi MX or of numbers.
    later
        A shared unknown of the phase [s] that is added to the instant first, if any.
    """

    names: tuple[str, ...]
    evaluate: Callable[[Any], Any]
    later: str | None = None

    def at(self, times: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Their values at instants (n,), by name."""
        table = np.asarray(self.evaluate(np.asarray(times, dtype=float)[None, :]))
        return dict(zip(self.names, table, strict=False))


@dataclass
class Terms:
    """What a phase function gives back.

    ``rows`` are constraints (label, expression, lower, upper); ``absolute`` are expressions whose
    absolute value is integrated into the objective, exactly, through two slacks each (or their
    two parts with the weights of the phase);
    ``integrand`` is integrated as it is.
    """

    rows: list[tuple[str, Any, float, float]] = field(default_factory=list)
    absolute: list[Any] = field(default_factory=list)
    integrand: Any = 0.0

    def equal(self, label: str, *expressions: Any) -> None:
        """Each expression is zero."""
        self.rows += [(label, e, 0.0, 0.0) for e in expressions]

    def between(self, label: str, expression: Any, lower: float, upper: float) -> None:
        """lower <= expression <= upper."""
        self.rows.append((label, expression, lower, upper))

    def nonnegative(self, label: str, *expressions: Any) -> None:
        """Each expression is at least zero."""
        self.rows += [(label, e, 0.0, INF) for e in expressions]


InstantFunction = Callable[[Instant], Terms]


@dataclass(frozen=True)
class PhaseModel:
    """One phase: its unknowns and its functions.

    Attributes
    ----------
    inside
        Equations, inequalities, costs at a Gauss point (accelerations and algebraics are there).
    path
        Path constraints of coordinates and rates; asked at every mesh point and at the middle
        Gauss point of every element. With ``path_everywhere`` they may also use algebraics, and
        are asked at all Gauss points (at mesh points ``algebraics`` is then empty).
    at_ends
        Inequalities at both ends of each element and between its Gauss points, from which
        algebraics are extrapolated: without them a force leaks between the points.
    curves
        Given functions of time that the functions of this phase see in ``Instant.curves``.
    shared
        Shared unknowns of the problem, and boundary instants of other phases, that the functions
        of this phase see in ``Instant.shared``.
    absolute_weights
        What the positive and the negative part of ``Terms.absolute`` are charged with; their sum
        is positive.
    control_rates
        Bound on |control'| by name, where there is one.
    control_rate_cost
        Weight of the integral of squared control rates, by name.
    cost_factor
        What all costs are multiplied with, a function of what is shared, if anything.
    """

    name: str
    start: str
    end: str
    coordinates: tuple[Coordinate, ...]
    controls: tuple[Unknown, ...]
    algebraics: tuple[Unknown, ...]
    absolute_scale: float
    inside: InstantFunction
    path: InstantFunction
    at_ends: InstantFunction
    path_everywhere: bool = False
    curves: tuple[TimeCurves, ...] = ()
    shared: tuple[Unknown, ...] = ()
    absolute_weights: tuple[float, float] = (1.0, 1.0)
    control_rates: Mapping[str, float] = field(default_factory=dict)
    control_rate_cost: Mapping[str, float] = field(default_factory=dict)
    cost_factor: Callable[[Mapping[str, Any]], Any] | None = None


@dataclass(frozen=True)
class Link:
    """Constraints on the coordinates and rates at one phase boundary, and on named controls."""

    name: str
    boundary: str
    function: InstantFunction
    controls: tuple[str, ...] = ()


@dataclass(frozen=True)
class Join:
    """Two boundaries at which unknowns are one and the same.

    ``names`` maps what they are called at the boundary ``end``, where a phase ends, to what they
    are called at ``start``, where one starts. The instants may differ: time may start anew.
    """

    end: str
    start: str
    names: Mapping[str, str]


TimeRow = tuple[str, Mapping[str, float], float, float]
"""(label, {boundary or shared unknown: factor}, lower, upper)."""


@dataclass(frozen=True)
class PhasedProblem:
    """Chains of phases with free boundary times, joined at their ends.

    Attributes
    ----------
    phases
        In time order; each starts where the one before ends, or at a boundary of a join.
    times
        Bounds (lower, upper) of each boundary instant; equal bounds fix it.
    time_rows
        Linear constraints between boundary instants and shared unknowns.
    joins
        Boundaries whose unknowns are one and the same, a periodic motion's first and last, say.
    fixed
        (boundary, name, "value" | "rate" | "control") -> number.
    shared
        Unknowns that belong to no instant.
    """

    phases: tuple[PhaseModel, ...]
    times: Mapping[str, tuple[float, float]]
    time_rows: tuple[TimeRow, ...]
    joins: tuple[Join, ...]
    fixed: Mapping[tuple[str, str, str], float]
    links: tuple[Link, ...]
    shared: tuple[Unknown, ...] = ()
