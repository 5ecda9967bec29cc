"""An objective and named measures of violation: what an exterior penalty needs to know."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import InputError
from ergowalk.nlp import NonlinearProgramme

Array = NDArray[np.float64]

BOUNDS = "variable bounds"
"""Name of the block of a programme's bounds on its variables."""


@dataclass(frozen=True)
class BlockedFunction:
    """Minimise Q(x) subject to G_l(x) = 0, where G_l >= 0 measures the violation of block l.

    Attributes
    ----------
    names : L strings
    evaluate : (n,) array -> (float, (L,) array)
        Objective Q and measures G, in the order of ``names``. The array of measures may be
        one and the same each time.
    tolerances : (L,) array
        Values up to which the measures count as zero, each in the unit of its measure.
    """

    names: tuple[str, ...]
    evaluate: Callable[[Array], tuple[float, Array]]
    tolerances: Array

    def __post_init__(self) -> None:
        if len(set(self.names)) != len(self.names):
            raise InputError(
                "must differ", "give each block its own name", field="names", value=self.names
            )
        tolerances = np.asarray(self.tolerances, dtype=float)
        usable = np.all(np.isfinite(tolerances) & (tolerances >= 0.0))
        if tolerances.shape != (len(self.names),) or not usable:
            raise InputError(
                f"must be {len(self.names)} finite numbers that are not negative",
                "give the tolerance of each block",
                field="tolerances",
                value=self.tolerances,
            )


def by_name(
    values: float | Mapping[str, float], names: tuple[str, ...], field: str, above: float
) -> Array:
    """One number for each block, from one for all or from a mapping that names every block.

    Raises
    ------
    InputError
        If a block is missing or unknown, or a number is not finite or not above ``above``.
    """
    if isinstance(values, Mapping):
        odd = sorted(set(values) ^ set(names))
        if odd:
            raise InputError(
                f"must name each of {', '.join(names)} and nothing else",
                f"look at {', '.join(odd)}",
                field=field,
                value=sorted(values),
            )
        numbers = np.array([values[name] for name in names], dtype=float)
    else:
        numbers = np.full(len(names), values, dtype=float)
    if not np.all(np.isfinite(numbers) & (numbers > above)):
        raise InputError(
            f"must be finite and above {above:g}",
            "give such numbers",
            field=field,
            value=numbers.tolist(),
        )
    return numbers


def blocked(
    programme: NonlinearProgramme,
    tolerances: float | Mapping[str, float] = 1e-6,
    power: int = 1,
) -> BlockedFunction:
    """The programme's rows, grouped by label, and its bounds on variables as penalty blocks.

    G_l = sum over the rows of block l of (lower - g)_+^power + (g - upper)_+^power, so that an
    equality counts on both sides. Blocks come in the order of their first rows, the bounds on
    variables (``"variable bounds"``) last, if there are any.

    Raises
    ------
    InputError
        If the power is neither 1 nor 2, or tolerances are not positive or misname a block.
    """
    if power not in (1, 2):
        raise InputError("must be 1 or 2", "choose one of them", field="power", value=power)
    labels = list(programme.labels)
    if np.any(np.isfinite(programme.lower) | np.isfinite(programme.upper)):
        labels += [BOUNDS] * programme.size
    names = tuple(dict.fromkeys(labels))
    measured = _Measures(programme, np.array([names.index(label) for label in labels], int), power)
    return BlockedFunction(names, measured, by_name(tolerances, names, "tolerances", 0.0))


class _Measures:
    """x -> (objective, measures); the programme's values come through CasADi's raw buffers."""

    def __init__(self, programme: NonlinearProgramme, block: NDArray[np.int64], power: int) -> None:
        lower, upper = programme.row_bounds
        rows, n = len(lower), programme.size
        bounded = len(block) > rows
        self.power = power
        self.sums = (block == np.arange(np.max(block, initial=-1) + 1)[:, None]).astype(float)
        self.lower = np.concatenate([lower, programme.lower]) if bounded else lower
        self.upper = np.concatenate([upper, programme.upper]) if bounded else upper
        self.x, self.cost, self.values = np.zeros(n), np.zeros(1), np.zeros(len(self.lower))
        buffer: Any
        buffer, self.trigger = programme.oracle.values.buffer()
        buffer.set_arg(0, self.x.data)
        buffer.set_res(0, self.cost.data)
        buffer.set_res(1, self.values[:rows].data)
        self.keep_alive, self.rows = buffer, rows

    def __call__(self, x: Array) -> tuple[float, Array]:
        self.x[:] = x
        self.trigger()
        if len(self.values) > self.rows:
            self.values[self.rows :] = x
        excess = np.maximum(np.maximum(self.lower - self.values, self.values - self.upper), 0.0)
        if self.power == 2:
            excess *= excess
        return float(self.cost[0]), self.sums @ excess
