"""When contacts change: rhythm parameters of the legs, fixed or between bounds (3)."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, model_validator

from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM, PhaseOrder, Rhythm
from ergowalk.problem.legs import Same, has_leg_tables, of_leg
from ergowalk.values import FiniteFloat, Value, invalid

Instant = FiniteFloat | tuple[FiniteFloat, FiniteFloat]


class LegRhythm(Value):
    """Rhythm parameters of one leg; "same" as of both."""

    _error = ProblemError

    heel_end: Instant | Same = Field(default="same", description="end of rotation over the heel")
    heel_off: Instant | Same = Field(default="same", description="heel-off")
    toe_off: Instant | Same = Field(default="same", description="toe-off")


class RhythmBounds(Value):
    """Rhythm parameters of a leg as fractions of T after its heel contact.

    One number fixes, a pair bounds (3).
    """

    _error = ProblemError

    heel_end: Instant = Field(
        default=(0.02, 0.20), description="end of rotation over the heel, tau^h, fraction of T"
    )
    heel_off: Instant = Field(default=(0.05, 0.45), description="heel-off, tau^m, fraction of T")
    toe_off: Instant = Field(
        default=(0.52, 0.66), description="toe-off, tau^s, fraction of T (after 0.5)"
    )
    order: PhaseOrder | Literal["best"] = Field(
        default="best",
        description="'toe-off-first', 'flat-first' (other toe-off before or after foot-flat), "
        "or 'best' to try both",
    )
    leg_1: LegRhythm | None = Field(default=None, description="rhythm of leg 1 that differs")
    leg_2: LegRhythm | None = Field(default=None, description="rhythm of leg 2 that differs")

    def bounds(self, name: str) -> tuple[float, float]:
        """Lower and upper bound of a parameter; equal where it is fixed."""
        value: Instant = getattr(self, name)
        return value if isinstance(value, tuple) else (value, value)

    @property
    def fixed(self) -> bool:
        """Whether nothing is free."""
        return all(
            low == high for low, high in map(self.bounds, ("heel_end", "heel_off", "toe_off"))
        )

    def start(self) -> Rhythm:
        """The printed rhythm, moved inside the bounds and in order (3): where the search begins."""

        def inside(name: str) -> float:
            low, high = self.bounds(name)
            printed: float = getattr(PRINTED_RHYTHM, name)
            return min(max(printed, low), high)

        heel_off = inside("heel_off")
        if max(inside("heel_end"), inside("toe_off") - 0.5) >= heel_off:
            heel_off = self.bounds("heel_off")[1]

        def before_heel_off(name: str, shift: float = 0.0) -> float:
            instant = inside(name)
            if instant - shift < heel_off:
                return instant
            return (self.bounds(name)[0] + heel_off + shift) / 2

        return Rhythm(before_heel_off("heel_end"), heel_off, before_heel_off("toe_off", 0.5))

    def orders(self) -> tuple[PhaseOrder, ...]:
        """The phase orders to try: those that the bounds leave room for."""
        (h_low, h_high), (s_low, s_high) = self.bounds("heel_end"), self.bounds("toe_off")
        possible = {
            PhaseOrder.TOE_OFF_FIRST: s_low - 0.5 <= h_high,
            PhaseOrder.FLAT_FIRST: h_low < s_high - 0.5,
        }
        if self.order != "best":
            return (PhaseOrder(self.order),)
        return tuple(order for order, room in possible.items() if room)

    @model_validator(mode="after")
    def _legs_in_order(self) -> Self:
        if has_leg_tables(self):
            for leg in (0, 1):
                of_leg(self, leg)
        return self

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        for name, (first, last) in _RANGES.items():
            low, high = self.bounds(name)
            if not first < low <= high < last:
                raise invalid(
                    name,
                    getattr(self, name),
                    f"must lie between {first} and {last} (exclusive), lower bound first",
                    "give a fraction of the stride time, or a pair of them",
                )
        if self.bounds("heel_end")[0] >= self.bounds("heel_off")[1]:
            raise invalid(
                "heel_end",
                self.heel_end,
                f"foot-flat must come before heel-off at {self.heel_off} (3)",
                "lower heel_end or raise heel_off",
            )
        if self.bounds("toe_off")[0] - 0.5 >= self.bounds("heel_off")[1]:
            raise invalid(
                "toe_off",
                self.toe_off,
                "the other leg must leave the ground (toe_off - 0.5) before heel-off at "
                f"{self.heel_off} (3)",
                "lower toe_off or raise heel_off",
            )
        return self

    @model_validator(mode="after")
    def _order_possible(self) -> Self:
        h, s = self.bounds("heel_end"), self.bounds("toe_off")
        late_flat = self.order == PhaseOrder.TOE_OFF_FIRST and s[0] - 0.5 > h[1]
        early_flat = self.order == PhaseOrder.FLAT_FIRST and h[0] >= s[1] - 0.5
        if late_flat or early_flat:
            raise invalid(
                "order",
                str(self.order),
                f"contradicts heel_end {self.heel_end} and toe_off - 0.5",
                "choose the other order, or 'best'",
            )
        return self


_RANGES = {"heel_end": (0.0, 0.5), "heel_off": (0.0, 0.5), "toe_off": (0.5, 1.0)}
