"""What the bounds of free numbers cost, from the multipliers of their unknowns."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass

from ergowalk.problem.design import FreeNumber, value_at
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solvers.ipopt import Minimum
from ergowalk.solving.stages import OrderSearch, StageResult

NEAR = 1e-3
"""Distance from a bound, as a share of the scale of the unknown, beyond which it is not active.

Nearer than that it is active if its multiplier exceeds that distance: an interior-point method ends
where their product is the last barrier, far below the square of either.
"""


@dataclass(frozen=True)
class Found:
    """A free number at the optimum.

    ``value`` lies between ``low`` and ``high``; ``low_price`` and ``high_price`` are derivatives of
    the least objective [J/m per unit] with respect to these, 0 where a bound is not active.
    """

    path: str
    value: float
    low: float
    high: float
    low_price: float
    high_price: float


def found_design(search: OrderSearch, result: StageResult, minimum: Minimum) -> Iterator[Found]:
    """Every free number of a stage; ``minimum`` has the multipliers of fixed variables too."""
    for free in search.problem.design.free:
        index = result.collocation.layout.shared[free.path]
        yield found_number(
            free,
            float(value_at(search.solved(result), free.path)),
            float(minimum.variable_multipliers[index]),
            float(result.collocation.layout.scale[index]),
            float(energy_per_metre(search.walker.reference_mass, search.distance)),
        )


def found_number(
    free: FreeNumber, value: float, multiplier: float, scale: float, unit: float
) -> Found:
    """A free number and its prices, from the multiplier of its unknown, ``value / scale``.

    ``unit`` is what a unit of the programme's objective is in J/m.
    """
    low, high = _active(free, value, -multiplier, scale)
    price = -unit * multiplier / scale
    return Found(
        free.path,
        value,
        free.lowest,
        free.highest,
        price if low else 0.0,
        price if high else 0.0,
    )


def as_json(design: Iterator[Found]) -> str:
    """As text for the attribute ``design`` of a gait file."""
    return json.dumps([asdict(found) for found in design])


def _active(free: FreeNumber, value: float, slope: float, scale: float) -> tuple[bool, bool]:
    """Which bound presses; of two that leave no room, the one that the optimum would leave."""
    low, high = (value - free.lowest) / scale, (free.highest - value) / scale
    return slope > 0 and low <= min(NEAR, slope), slope < 0 and high <= min(NEAR, -slope)
