"""What the bounds of free numbers cost, from the multipliers of their unknowns."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass

from ergowalk.problem.design import FreeNumber, value_at
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solvers.ipopt import Minimum
from ergowalk.solving.stages import OrderSearch, StageResult

ACTIVE = 1e-5
"""Distance from a bound, as a share of the room between both, up to which it is active."""


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
        value = float(value_at(search.solved(result), free.path))
        slope = -minimum.variable_multipliers[index] / result.collocation.layout.scale[index]
        unit = energy_per_metre(search.walker.reference_mass, search.problem.step_length_m)
        low, high = _active(free, value, slope)
        price = float(unit * slope)
        yield Found(
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


def _active(free: FreeNumber, value: float, slope: float) -> tuple[bool, bool]:
    """Which bound presses; of two that leave no room, the one that the optimum would leave."""
    near = ACTIVE * (free.highest - free.lowest)
    return (
        slope > 0 and value - free.lowest <= near,
        slope < 0 and free.highest - value <= near,
    )
