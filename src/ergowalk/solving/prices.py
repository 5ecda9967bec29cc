"""What a bound costs: sensitivities of the optimum from its multipliers.

At an optimum the derivative of the least objective with respect to anything given is that of the
Lagrangian, the point and the multipliers held: no gait has to be found again. The objective is E
plus the small smoothing costs, per metre.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.corridors import ANGLES
from ergowalk.errors import ErgowalkError, ProblemError
from ergowalk.problem import GaitProblem
from ergowalk.problem.design import bounds_of, with_bound
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solution import Solution
from ergowalk.solving.design_prices import found_design
from ergowalk.solving.memory import recall
from ergowalk.solving.multipliers import with_fixed_multipliers
from ergowalk.solving.stages import OrderSearch, StageResult
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.design import reference_mass
from ergowalk.transcription.halves import in_phases
from ergowalk.transcription.walking import walking_problem
from ergowalk.values import Value

Array = NDArray[np.float64]

STEP = 1e-6
"""Relative change of a given number from which its derivative is formed."""


@dataclass(frozen=True)
class Price:
    """What one given number costs.

    ``name`` is its path in the problem file, ``slope`` the derivative of the least objective
    [J/m per unit of the number], ``elasticity`` its relative change per relative change.
    """

    name: str
    value: float
    slope: float
    elasticity: float


@dataclass(frozen=True)
class CorridorPrices:
    """What the edges of the angle corridors cost, over the stride of one leg.

    Attributes
    ----------
    fraction : (n,) array
        Middles of the elements, as fractions of the stride, ascending.
    width : (n,) array
        Lengths of the elements, as fractions of the stride.
    lower, upper : {joint: (n,) array}
        J/m saved if that edge moves outward by one degree during the element, per 1 % of the
        stride; never negative but for rounding.
    """

    fraction: Array
    width: Array
    lower: dict[str, Array]
    upper: dict[str, Array]

    def rows(self) -> dict[str, dict[str, Array]]:
        """The curves by joint and edge."""
        return {j: {"lower": self.lower[j], "upper": self.upper[j]} for j in self.lower}

    def total(self, joint: str) -> float:
        """J/m saved if both edges of a joint move outward by one degree everywhere."""
        both = self.lower[joint] + self.upper[joint]
        return float(np.sum(both * self.width) * 100)


@dataclass(frozen=True)
class Prices:
    """The price list of a gait: given numbers, dearest first, and corridor edges.

    The edges are those of both legs; of leg 1 where leg 2 has its own.
    """

    energy_per_metre: float
    numbers: tuple[Price, ...]
    corridors: CorridorPrices
    corridors_leg_2: CorridorPrices | None = None


def prices(solution: Solution) -> Prices:
    """What every given number and every corridor edge costs, from the stored multipliers.

    Raises
    ------
    GaitFileError
        If the file keeps none (a gait of another method, or of an older version).
    """
    search, result = recall(solution)
    optimum, found = _Optimum(search, result), []
    for name, value in given_numbers(solution.problem):
        slope = optimum.slope(name, value)
        if slope is not None:
            found.append(Price(name, value, slope, slope * value / solution.energy_per_metre))
    found.sort(key=lambda price: -abs(price.elasticity))
    return Prices(solution.energy_per_metre, tuple(found), *corridor_prices(search, result))


def price_of(solution: Solution, name: str) -> float:
    """Derivative of the least objective [J/m] with respect to the number at a path.

    Raises
    ------
    GaitFileError
        As :func:`prices`.
    ProblemError
        If the problem has no such number, or does not allow it to be changed alone.
    """
    value = given_number(solution.problem, name)
    slope = _Optimum(*recall(solution)).slope(name, value)
    if slope is None:
        raise ProblemError("cannot be changed alone", "change another", field="name", value=name)
    return slope


def given_numbers(problem: GaitProblem) -> Iterator[tuple[str, float]]:
    """(path, value) of every number of the problem that a gait depends on.

    Of a number that is free these are its bounds, ``design.PATH.low`` and ``design.PATH.high``.
    """
    for name in ("step_length_m", "stride_time_s"):
        yield name, getattr(problem, name)
    yield "corridors.width_sd", problem.corridors.width_sd
    tables = ["limits", "body"]
    tables += [] if problem.objective.is_eq10 else ["objective"]
    for table in (*tables, "devices"):
        for name, value in _numbers(getattr(problem, table), table):
            if name not in problem.design.paths:
                yield name, value
    yield from bounds_of(problem)


def given_number(problem: GaitProblem, name: str) -> float:
    """The number of the problem at a path.

    Raises
    ------
    ProblemError
        If it has none there.
    """
    numbers = dict(given_numbers(problem))
    if name not in numbers:
        raise ProblemError(
            "no such number", f"use one of {', '.join(numbers)}", field="name", value=name
        )
    return numbers[name]


def _numbers(table: Value, path: str) -> Iterator[tuple[str, float]]:
    for name in type(table).model_fields:
        value = getattr(table, name)
        if isinstance(value, Value):
            yield from _numbers(value, f"{path}.{name}")
        elif isinstance(value, tuple) and all(isinstance(x, float) for x in value):
            yield from ((f"{path}.{name}.{leg}", x) for leg, x in enumerate(value, start=1))
        elif isinstance(value, float | int) and not isinstance(value, bool) and value != 0:
            yield f"{path}.{name}", float(value)


class _Optimum:
    """The Lagrangian at an optimum as a function of everything given."""

    def __init__(self, search: OrderSearch, result: StageResult) -> None:
        self.search, self.result = search, result
        self.minimum = with_fixed_multipliers(result)
        self.least = self._lagrangian(search.problem)

    def slope(self, name: str, value: float) -> float | None:
        """Derivative of the least objective [J/m] with respect to one number of the problem.

        None where the problem does not allow the number to be changed alone.
        """
        if name.startswith("design."):
            path, _, end = name.removeprefix("design.").rpartition(".")
            found = {f.path: f for f in found_design(self.search, self.result, self.minimum)}
            return found[path].low_price if end == "low" else found[path].high_price
        for step in (STEP * abs(value), -STEP * abs(value)):
            try:
                problem = changed(self.search.problem, name, value + step)
            except ErgowalkError:
                continue
            return (self._lagrangian(problem) - self.least) / step
        return None

    def _lagrangian(self, problem: GaitProblem) -> float:
        """Objective plus multipliers times distances from the active bounds [J/m].

        The point and the multipliers are those of the optimum, everything given is the problem's.
        """
        walker, minimum = self.search.walker, self.minimum
        phased = walking_problem(problem, self.search.orders, walker.smoothing)
        programme = Collocation(phased, self.result.collocation.mesh, self.result.points).programme
        total, rows = programme.evaluate(minimum.x)
        total += _pressed(minimum.row_multipliers, rows, *programme.row_bounds)
        bounds = programme.lower, programme.upper
        total += _pressed(minimum.variable_multipliers, minimum.x, *bounds)
        mass = reference_mass(problem)
        distance = len(self.search.halves) * problem.step_length_m
        energy: float = energy_per_metre(total * mass, distance)
        return energy


def changed(problem: GaitProblem, name: str, value: float) -> GaitProblem:
    """The problem with the number at a path replaced."""
    first, *rest = name.split(".")
    if first == "design":
        return with_bound(problem, name, value)
    inner = _replaced(getattr(problem, first), rest, value) if rest else value
    replaced: GaitProblem = problem.replace(**{first: inner})
    return replaced


def _replaced(table: Value, path: list[str], value: float) -> Value:
    first, *rest = path
    before, inner = getattr(table, first), value
    if isinstance(before, tuple):  # one leg of a pair
        pair = [value if str(leg) == rest[0] else x for leg, x in enumerate(before, start=1)]
        return _with(table, first, tuple(pair))
    return _with(table, first, _replaced(before, rest, value) if rest else inner)


def _with(table: Value, name: str, value: object) -> Value:
    replaced: Value = table.replace(**{name: value})
    return replaced


def _pressed(multipliers: Array, values: Array, lower: Array, upper: Array) -> float:
    """Multipliers times the distance from the bound that each presses on: above 0 the upper."""
    bound = np.where(multipliers > 0, upper, lower)
    finite = np.isfinite(bound) & (multipliers != 0)
    return float(multipliers[finite] @ (values - bound)[finite])


def corridor_prices(search: OrderSearch, result: StageResult) -> tuple[CorridorPrices, ...]:
    """Price of every corridor edge, element by element, over the stride of a leg.

    Where the legs mirror each other leg 2 in [0, T/2] is leg 1 half a stride later; else leg 1 and
    leg 2 have their own.
    """
    collocation, rows = result.collocation, result.minimum.row_multipliers
    stride = search.problem.stride_time_s
    unit = energy_per_metre(search.walker.mass, search.distance)
    parts: tuple[list[_Element], ...] = tuple([] for _ in search.halves)
    first = 0
    for kernel, mesh, (half, walker, _, curves) in zip(
        collocation.kernels,
        collocation.mesh,
        in_phases(search.halves, result.trajectory),
        strict=True,
    ):
        n_e, n_g = len(mesh) - 1, len(kernel.labels)
        own = rows[first : first + n_e * n_g].reshape(n_e, n_g)
        first += n_e * n_g
        places = np.where(np.isnan(kernel.places), 0.5, kernel.places)
        starts, widths = curves.start + curves.duration * mesh[:-1], curves.duration * np.diff(mesh)
        for role, since in enumerate((0.0, walker.steps.other)):
            leg = (role + search.halves.index(half)) % len(parts)
            prices = {}
            fraction = (starts[:, None] + widths[:, None] * places + since) / stride
            for joint, corridor in walker.corridors[role].items():
                label = f"corridor {joint} {role + 1} (6)"
                mine = np.array([name == label for name in kernel.labels])
                width = np.degrees(corridor.width * corridor.sd(fraction))
                price = np.where(mine, own / width, 0.0)  # J/kg per degree
                prices[joint] = [np.maximum(sign * price, 0.0).sum(axis=1) for sign in (-1, 1)]
            for k in range(n_e):
                at = ((starts[k] + widths[k] / 2 + since) / stride) % 1.0
                edges = {j: (low[k], high[k]) for j, (low, high) in prices.items()}
                parts[leg].append((at, widths[k] / stride, edges))
    return tuple(_over_the_stride(part, unit) for part in parts)


_Element = tuple[float, float, dict[str, tuple[float, float]]]
"""Middle and length over the stride, and prices of both edges by joint [J/kg per degree]."""


def _over_the_stride(parts: list[_Element], unit: float) -> CorridorPrices:
    parts = sorted(parts, key=lambda part: part[0])
    width = np.array([part[1] for part in parts])
    factor = unit / (100 * width)
    lower, upper = (
        {j: factor * np.array([part[2][j][edge] for part in parts]) for j in ANGLES}
        for edge in (0, 1)
    )
    return CorridorPrices(np.array([part[0] for part in parts]), width, lower, upper)
