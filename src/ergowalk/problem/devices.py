"""Devices at the joints: locks, free hinges, springs and dampers, as a user writes them down."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, Literal, Self

from pydantic import Field, model_validator

from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import Contact
from ergowalk.mechanics.devices import SENSE, Law
from ergowalk.problem.legs import LEG_TABLES
from ergowalk.values import FiniteFloat, NonNegativeFloat, Value, invalid

Kind = Literal["locked", "free", "spring", "damper", "parallel", "series"]
PhaseName = Literal["swing", "heel", "flat", "forefoot", "toe"]
Joint = Literal["hip", "knee", "ankle", "metatarsal"]

EVERY_PHASE: tuple[PhaseName, ...] = ("swing", "heel", "flat", "forefoot", "toe")

RADIAN = math.pi / 180
"""Radians of a degree."""

_NEEDS = {
    "locked": (False, False),
    "free": (False, False),
    "spring": (True, False),
    "damper": (False, True),
    "parallel": (True, True),
    "series": (True, True),
}
"""Whether each kind has a stiffness and a damping."""


class Device(Value):
    """A passive device between the two segments of a joint."""

    _error = ProblemError

    kind: Kind = Field(
        description="'locked', 'free' (no moment at all), 'spring', 'damper', or both 'parallel' "
        "(side by side) or in 'series'"
    )
    own_moment: bool = Field(
        default=True,
        strict=True,
        description="whether the walker's own moment acts beside the device (and alone where a "
        "latch is open); false: the device stands in its place",
    )
    stiffness_nm_per_rad: NonNegativeFloat = Field(
        default=0.0, description="stiffness of the spring, N m/rad"
    )
    stiffness_below_nm_per_rad: NonNegativeFloat | Literal["same"] = Field(
        default="same",
        description="stiffness below the rest angle, N m/rad, or 'same'",
    )
    damping_nms_per_rad: NonNegativeFloat = Field(default=0.0, description="damping, N m s/rad")
    rest_angle_deg: FiniteFloat | Literal["latched"] = Field(
        default=0.0,
        description="joint angle at which a spring is slack or a lock holds, degrees; 'latched': "
        "a lock holds whatever angle it closes at",
    )
    active: tuple[PhaseName, ...] = Field(
        default=EVERY_PHASE,
        description="contact phases of its leg in which the device acts; it has a latch if these "
        "are not all",
    )

    @property
    def latch(self) -> bool:
        """Whether it acts in some contact phases only."""
        return set(self.active) != set(EVERY_PHASE)

    def acts(self, contact: Contact) -> bool:
        """Whether it acts while its leg touches the ground so."""
        return contact.name.lower() in self.active

    @property
    def below(self) -> Any:
        """Stiffness below the rest angle [N m/rad]."""
        below = self.stiffness_below_nm_per_rad
        return self.stiffness_nm_per_rad if below == "same" else below

    @property
    def rest(self) -> Any:
        """Rest angle [rad]; zero where it is that at which the latch closes."""
        return 0.0 if self.rest_angle_deg == "latched" else self.rest_angle_deg * RADIAN

    @property
    def law(self) -> Law:
        """Its moments; none for a lock or a free hinge."""
        above = self.stiffness_nm_per_rad
        same = self.stiffness_below_nm_per_rad == "same"
        return Law(above, above if same else self.below, self.damping_nms_per_rad)

    def sentence(self) -> str:
        """The device in words."""
        words: list[str] = [self.kind]
        if self.stiffness_nm_per_rad or self.below:
            two = "" if self.stiffness_below_nm_per_rad == "same" else f" ({self.below:g} below)"
            words.append(f"{self.stiffness_nm_per_rad:g}{two} N m/rad")
        if self.damping_nms_per_rad:
            words.append(f"{self.damping_nms_per_rad:g} N m s/rad")
        if self.kind not in ("free", "damper"):
            rest = self.rest_angle_deg
            words.append("as latched" if rest == "latched" else f"at {rest:g} deg")
        if self.latch:
            words.append(f"in {', '.join(self.active)}")
        if self.own_moment and self.kind not in ("locked", "free"):
            words.append("beside the own moment")
        return " ".join(words)

    @model_validator(mode="after")
    def _goes_together(self) -> Self:
        stiff, damped = _NEEDS[self.kind]
        if not stiff and (self.stiffness_nm_per_rad or self.stiffness_below_nm_per_rad != "same"):
            raise self._odd("stiffness_nm_per_rad", self.stiffness_nm_per_rad, "stiffness")
        if not damped and self.damping_nms_per_rad:
            raise self._odd("damping_nms_per_rad", self.damping_nms_per_rad, "damping")
        if self.kind == "series":
            self._check_series()
        if self.rest_angle_deg == "latched" and not (self.kind == "locked" and self.latch):
            raise invalid(
                "rest_angle_deg",
                "latched",
                "only a lock with a latch holds the angle that it closes at",
                "give the rest angle in degrees",
            )
        if not self.active or len(set(self.active)) != len(self.active):
            raise invalid(
                "active",
                list(self.active),
                "must name one phase or more, each once",
                f"choose from {', '.join(EVERY_PHASE)}",
            )
        return self

    def _odd(self, field: str, value: float, what: str) -> Exception:
        return invalid(
            field,
            value,
            f"a device of kind '{self.kind}' has no {what}",
            "leave it out, or choose kind 'parallel' or 'series'",
        )

    def _check_series(self) -> None:
        if not (self.stiffness_nm_per_rad > 0 and self.damping_nms_per_rad > 0):
            raise invalid(
                "stiffness_nm_per_rad",
                self.stiffness_nm_per_rad,
                "a spring and a damper in series both need a value above zero",
                "give stiffness_nm_per_rad and damping_nms_per_rad, or another kind",
            )
        if self.stiffness_below_nm_per_rad != "same" or self.latch:
            raise invalid(
                "kind",
                "series",
                "in series the spring has one slope and no latch",
                "leave out stiffness_below_nm_per_rad and active",
            )


class EasedDevice(Device):
    """A device that the walker helps out, for a price: where the search for a gait begins."""

    help_price: float = Field(default=1.0, description="weight of the squared help per kg, s3/m2")

    @staticmethod
    def needed(device: Device) -> bool:
        """Whether a device leaves no room for a moment of the walker's own."""
        return not device.own_moment or device.kind in ("locked", "free")

    @classmethod
    def of(cls, device: Device, price: float, stiffness: float) -> Device:
        """The device beside an own moment that may not have one; others as they are.

        A lock becomes a spring of a stiffness [N m/rad] with a damper.
        """
        locked = device.kind == "locked"
        if not cls.needed(device):
            return device
        fields = {name: getattr(device, name) for name in Device.model_fields}
        if device.kind == "free" or (locked and device.rest_angle_deg == "latched"):
            fields |= {"kind": "parallel", "rest_angle_deg": 0.0}
        elif locked:
            stiff = {"stiffness_nm_per_rad": stiffness, "damping_nms_per_rad": stiffness / 50}
            fields |= {"kind": "parallel", **stiff, "active": EVERY_PHASE}
        return cls(**{**fields, "own_moment": True, "help_price": price})


class LegDevices(Value):
    """The devices of one leg, by joint; those of both legs unless given."""

    _error = ProblemError

    hip: Device | None = Field(default=None, description="device at the hip")
    knee: Device | None = Field(default=None, description="device at the knee")
    ankle: Device | None = Field(default=None, description="device at the ankle")
    metatarsal: Device | None = Field(default=None, description="device at the metatarsal joint")

    def items(self) -> Iterator[tuple[str, Device]]:
        """(joint, device) of every device."""
        for joint in SENSE:
            device: Device | None = getattr(self, joint)
            if device is not None:
                yield joint, device

    def sentence(self) -> str:
        """All devices in words; empty if there is none."""
        return "; ".join(f"{joint} {device.sentence()}" for joint, device in self.items())

    @model_validator(mode="after")
    def _toes_rest_in_line(self) -> Self:
        toes = self.metatarsal
        if toes is not None and toes.rest_angle_deg != 0.0:
            raise invalid(
                "metatarsal.rest_angle_deg",
                toes.rest_angle_deg,
                "must be 0: the toes are in line with the sole, of no moment, while the foot "
                "swings (7)",
                "leave it out",
            )
        return self


class Devices(LegDevices):
    """The devices of both legs, by joint, and of one leg; none unless given."""

    _error = ProblemError

    hip: Device | None = Field(default=None, description="device at the hips")
    knee: Device | None = Field(default=None, description="device at the knees")
    ankle: Device | None = Field(default=None, description="device at the ankles")
    metatarsal: Device | None = Field(default=None, description="device at the metatarsal joints")
    leg_1: LegDevices | None = Field(default=None, description="devices of leg 1 alone")
    leg_2: LegDevices | None = Field(default=None, description="devices of leg 2 alone")

    def of(self, leg: int) -> dict[str, Device]:
        """The devices of a leg by joint (0 is leg 1)."""
        own: LegDevices | None = getattr(self, LEG_TABLES[leg])
        return {**dict(self.items()), **({} if own is None else dict(own.items()))}

    def everything(self) -> Iterator[Device]:
        """Every device, of both legs and of one."""
        for table in (self, self.leg_1, self.leg_2):
            if table is not None:
                yield from (device for _, device in table.items())

    def changed(self, change: Callable[[Device], Device]) -> Devices:
        """All of them with a change."""

        def table(given: LegDevices) -> dict[str, Device]:
            return {joint: change(device) for joint, device in given.items()}

        changes: dict[str, Any] = table(self)
        for name in LEG_TABLES:
            own: LegDevices | None = getattr(self, name)
            if own is not None:
                changes[name] = own.replace(**table(own))
        found: Devices = self.replace(**changes)
        return found

    def sentence(self) -> str:
        """All devices in words; empty if there is none."""
        words = [super().sentence()]
        for leg, own in ((1, self.leg_1), (2, self.leg_2)):
            words.append("" if own is None else f"leg {leg}: {own.sentence()}")
        return "; ".join(w for w in words if w)
