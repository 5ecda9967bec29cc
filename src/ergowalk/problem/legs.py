"""Legs that differ: tables that hold for one leg, and how far the two steps may differ."""

from __future__ import annotations

from typing import Any, Literal, Self, TypeVar

from pydantic import Field, model_validator

from ergowalk.errors import ProblemError
from ergowalk.values import FiniteFloat, Value, invalid

Same = Literal["same"]
Asymmetry = FiniteFloat | tuple[FiniteFloat, FiniteFloat]
V = TypeVar("V", bound=Value)

LEG_TABLES = ("leg_1", "leg_2")
"""Names of the tables of one leg."""

MOST_ASYMMETRY = 0.5
"""Bound on an asymmetry: at 0.5 one step is three times the other."""


def of_leg(table: V, leg: int) -> V:
    """What a table with tables ``leg_1`` and ``leg_2`` says of one leg (0 is leg 1).

    What the table of the leg leaves out, or calls "same", is what the table itself says.
    """
    own = getattr(table, LEG_TABLES[leg])
    common: V = table if not has_leg_tables(table) else table.replace(leg_1=None, leg_2=None)
    return common if own is None else _merged(common, own)


def _merged(table: V, own: Value) -> V:
    changes: dict[str, Any] = {}
    for name in type(own).model_fields:
        value = getattr(own, name)
        if value is None or (isinstance(value, str) and value == "same"):
            continue
        under = getattr(table, name, None)
        partial = isinstance(value, Value) and type(value) is not type(under)
        changes[name] = _merged(under, value) if partial and under is not None else value
    merged: V = table.replace(**changes)
    return merged


def has_leg_tables(table: Value) -> bool:
    """Whether a table says anything of one leg alone."""
    return any(getattr(table, name) is not None for name in LEG_TABLES)


def exchanged(table: V) -> V:
    """The table with the legs exchanged."""
    if not has_leg_tables(table):
        return table
    first, second = (getattr(table, name) for name in LEG_TABLES)
    return table.model_copy(update={"leg_1": second, "leg_2": first})


class Stride(Value):
    """Whether one leg mirrors the other, and how far the two steps may differ.

    Step i ends as leg i meets the ground: its length L_i from the other foot to that one, its time
    T_i since the other foot met it; L_1 + L_2 = 2 L and T_1 + T_2 = T.
    """

    _error = ProblemError

    legs: Literal["auto", "mirrored", "each"] = Field(
        default="auto",
        description="'mirrored': half a stride is solved, the other leg does the same later; "
        "'each': both halves are solved; 'auto': each where the legs differ",
    )
    step_length_asymmetry: Asymmetry = Field(
        default=(-0.1, 0.1),
        description="(L_1 - L_2)/(L_1 + L_2) where both halves are solved: a number, or bounds",
    )
    step_time_asymmetry: Asymmetry = Field(
        default=(-0.1, 0.1),
        description="(T_1 - T_2)/(T_1 + T_2) where both halves are solved: a number, or bounds",
    )

    def bounds(self, name: str) -> tuple[float, float]:
        """Lower and upper bound of an asymmetry, "length" or "time"."""
        value = getattr(self, f"step_{name}_asymmetry")
        return value if isinstance(value, tuple) else (value, value)

    def exchanged(self) -> Stride:
        """The same with the legs exchanged."""
        found: Stride = self.replace(
            **{
                f"step_{n}_asymmetry": (-self.bounds(n)[1], -self.bounds(n)[0])
                for n in ("length", "time")
            }
        )
        return found

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        for name in ("length", "time"):
            low, high = self.bounds(name)
            if not -MOST_ASYMMETRY <= low <= high <= MOST_ASYMMETRY:
                raise invalid(
                    f"step_{name}_asymmetry",
                    getattr(self, f"step_{name}_asymmetry"),
                    f"must lie between -{MOST_ASYMMETRY:g} and {MOST_ASYMMETRY:g}, lower bound "
                    "first",
                    "give a number, or a pair of them",
                )
        return self
