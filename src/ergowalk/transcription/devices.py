"""Devices of a half stride: their moments, the unknowns and equations that they bring along.

Legs appear by their roles: 1 leads, 2 trails. A massless foot in swing bears no moment, so there a
device at the ankle is held by the walker's own moment, or, where it stands in the place of that,
moves the foot: to its rest angle, or there with its own time constant.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.mechanics.devices import SENSE, joint_rotation
from ergowalk.mechanics.functions import cos, sin
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Rotation, leg_points
from ergowalk.problem import JOINTS, GaitProblem
from ergowalk.problem.devices import Device, EasedDevice
from ergowalk.transcription.phases import Coordinate, Instant, Terms, Unknown

RATE, ACCELERATION = 3.0, 30.0
"""Typical sizes (rad/s, rad/s2) by which rows are divided."""

STIFFENING = 25.0
"""Rate [1/s] at which the equations of a lock pull an error of its angle back.

They are asked of accelerations, where collocation is stable; a periodic motion that satisfies
x'' + 2 s x' + s^2 x = 0 stands still at x = 0.
"""

LOADED_JOINTS = {
    Contact.SWING: ("hip", "knee"),
    Contact.HEEL: ("hip", "knee", "ankle"),
    Contact.FLAT: ("hip", "knee", "ankle"),
    Contact.FOREFOOT: JOINTS,
    Contact.TOE: JOINTS,
}
"""Joints whose moment may differ from zero, or do work, in each contact."""


class Fittings:
    """The devices of both legs in the roles of a half stride."""

    def __init__(self, problem: GaitProblem) -> None:
        self.problem, self.mass = problem, problem.body.total_mass
        self.legs = (problem.body.leg(0), problem.body.leg(1))
        self.devices: dict[tuple[int, str], Device] = {
            (role, joint): device for role in (0, 1) for joint, device in problem.devices_of(role)
        }

    # --- what is where ----------------------------------------------------------------------

    def own(self, role: int, joint: str, contact: Contact) -> bool:
        """Whether the walker's own moment is an unknown of its own."""
        if joint not in LOADED_JOINTS[contact]:
            return False
        device = self.devices.get((role, joint))
        if device is None:
            return True
        if device.kind == "free":
            return not device.acts(contact)
        if device.kind == "locked":
            return device.own_moment and not device.acts(contact)
        return device.own_moment

    def acting(self, role: int, contact: Contact) -> Iterator[tuple[str, Device]]:
        """(joint, device) of those that act in a contact.

        In heel phase and swing the toes are in line with the sole, and flat on a flat foot: there
        a device at the metatarsal joint is at rest.
        """
        for joint in JOINTS:
            device = self.devices.get((role, joint))
            if device is None or not device.acts(contact):
                continue
            if joint != "metatarsal" or joint in LOADED_JOINTS[contact]:
                yield joint, device

    def holds_swing_foot(self, role: int, contact: Contact) -> Device | None:
        """The device that the own ankle moment must hold in swing, the foot being massless."""
        device = self._on_swing_foot(role, contact)
        return device if device is not None and device.own_moment else None

    def moves_swing_foot(self, role: int, contact: Contact) -> Device | None:
        """The device that moves the massless foot in swing, no own moment being there."""
        device = self._on_swing_foot(role, contact)
        return None if device is None or device.own_moment else device

    def _on_swing_foot(self, role: int, contact: Contact) -> Device | None:
        """The device at the ankle of a swinging foot, if it can bear a moment."""
        device = dict(self.acting(role, contact)).get("ankle")
        if contact is not Contact.SWING or device is None or device.kind in ("locked", "free"):
            return None
        law = (device.stiffness_nm_per_rad, device.below, device.damping_nms_per_rad)
        return None if all(map(_nought, law)) else device

    def coordinates(self, phase: Phase) -> Iterator[Coordinate]:
        """Deflection of the damper of each spring and damper in series [rad]."""
        for role, contact in enumerate(phase.legs):
            for joint, device in self.acting(role, contact):
                if device.kind == "series":
                    name = f"slip_{joint}_{role + 1}"
                    yield Coordinate(name, rate_scale=RATE, acceleration_scale=ACCELERATION)

    def algebraics(self, phase: Phase) -> Iterator[Unknown]:
        """Moments of locks, per kg."""
        for role, contact in enumerate(phase.legs):
            for joint, device in self.acting(role, contact):
                if device.kind == "locked" and joint in LOADED_JOINTS[contact]:
                    yield Unknown(f"lock_{joint}_{role + 1}")

    # --- moments ----------------------------------------------------------------------------

    def deflection(self, role: int, joint: str, motion: BodyMotion) -> Rotation:
        """Deflection of a device from rest [rad], its rate and acceleration."""
        device = self.devices[role, joint]
        angle = joint_rotation(self.legs[role], joint, motion.trunk, motion.legs[role])
        return angle.plus(-device.rest)

    def moment(
        self,
        role: int,
        joint: str,
        contact: Contact,
        motion: BodyMotion,
        slips: Mapping[str, Any],
        locks: Mapping[str, Any],
    ) -> Any:
        """Moment of the device on the distal segment per kg, 0.0 where none acts.

        ``slips`` are the deflections of dampers in series by coordinate, ``locks`` the moments of
        locks per kg.
        """
        device = dict(self.acting(role, contact)).get(joint)
        if device is None or device.kind == "free":
            return 0.0
        if device.kind == "locked":
            return locks.get(f"lock_{joint}_{role + 1}", 0.0)
        x = self.deflection(role, joint, motion)
        if device.kind == "series":
            against = device.stiffness_nm_per_rad * (x.angle - slips[f"slip_{joint}_{role + 1}"])
        else:
            against = device.law.moment(x.angle, x.rate)
        return -SENSE[joint] * against / self.mass

    def at(self, phase: Phase, instant: Instant, motion: BodyMotion) -> tuple[dict[str, Any], ...]:
        """Moments of the devices of both legs at an instant, by joint, per kg."""
        slips = {name: state.value for name, state in instant.coordinates.items()}
        return tuple(
            {
                joint: self.moment(role, joint, contact, motion, slips, instant.algebraics)
                for joint, _ in self.acting(role, contact)
            }
            for role, contact in enumerate(phase.legs)
        )

    # --- equations --------------------------------------------------------------------------

    def equations(self, terms: Terms, phase: Phase, instant: Instant, motion: BodyMotion) -> None:
        """What locks, dampers in series, and a foot that its device moves must satisfy."""
        for role, contact in enumerate(phase.legs):
            moving = self.moves_swing_foot(role, contact)
            for joint, device in self.acting(role, contact):
                if device.kind not in ("locked", "series") and device is not moving:
                    continue
                x = self._accelerated(role, joint, contact, motion)
                slip = None
                if device.kind == "series":
                    slip = instant.coordinates[f"slip_{joint}_{role + 1}"]
                    pace = device.stiffness_nm_per_rad / device.damping_nms_per_rad
                    miss = slip.rate - pace * (x.angle - slip.value)
                    change = slip.acceleration - pace * (x.rate - slip.rate)
                    drift = (change + STIFFENING * miss) / ACCELERATION
                    terms.equal("spring and damper in series", drift)
                if device.kind == "locked":
                    free = device.rest_angle_deg == "latched"
                    terms.equal("lock", _still(x, held=not free) / ACCELERATION)
                elif device is moving and joint == "ankle":
                    terms.equal("swing foot on its device", _relaxed(device, x, slip))

    def own_in_swing(
        self, role: int, contact: Contact, motion: BodyMotion, instant: Instant
    ) -> Rotation | None:
        """Own ankle moment per kg that holds the device on a swinging foot, and its rate."""
        device = self.holds_swing_foot(role, contact)
        if device is None:
            return None
        x = self._accelerated(role, "ankle", contact, motion)
        if device.kind == "series":
            slip = instant.coordinates[f"slip_ankle_{role + 1}"]
            k = device.stiffness_nm_per_rad
            value, rate = k * (x.angle - slip.value), k * (x.rate - slip.rate)
        else:
            value = device.law.moment(x.angle, x.rate)
            rate = device.law.moment_rate(x.angle, x.rate, x.acceleration)
        return Rotation(value / self.mass, rate / self.mass)

    def help(self, phase: Phase, instant: Instant, motion: BodyMotion) -> Any:
        """Price of the own moments that will have to do without in the end, squared per kg."""
        price: Any = 0.0
        for (role, joint), device in self.devices.items():
            if isinstance(device, EasedDevice):
                own = instant.controls.get(f"{joint}_{role + 1}", 0.0)
                if joint == "ankle":
                    held = self.own_in_swing(role, phase.legs[role], motion, instant)
                    own = own if held is None else held.angle
                price = price + device.help_price * own**2
        return price

    def closing(self, role: int, joint: str, motion: BodyMotion) -> list[Any]:
        """Zero where a latch closes: a lock at rest (at its angle), a spring without a moment."""
        device, x = self.devices[role, joint], self.deflection(role, joint, motion)
        if device.kind == "locked":
            return [x.rate] if device.rest_angle_deg == "latched" else [x.angle, x.rate]
        return [x.angle] if device.kind in ("spring", "parallel") else []

    def leaving_the_ground(self, role: int, motion: BodyMotion, instant: Instant) -> list[Any]:
        """Zero at toe-off where the device is to move the swinging foot from then on."""
        device = self.devices[role, "ankle"]
        x = self.deflection(role, "ankle", motion)
        if device.kind == "series":
            slip = instant.coordinates[f"slip_ankle_{role + 1}"]
            return [x.angle - slip.value, x.rate - slip.rate]
        law = device.law
        if _nought(law.damping):
            return [x.angle, x.rate]
        return [x.rate + law.spring(x.angle) / law.damping]

    def _accelerated(self, role: int, joint: str, contact: Contact, motion: BodyMotion) -> Rotation:
        """The deflection with the acceleration that a foot on its toe tip has."""
        if contact is Contact.TOE and joint in ("ankle", "metatarsal"):
            leg = on_toe_tip(self.legs[role], motion, role)
            legs = tuple(leg if i == role else motion.legs[i] for i in (0, 1))
            motion = BodyMotion(motion.hip, motion.trunk, (legs[0], legs[1]))
        return self.deflection(role, joint, motion)


def on_toe_tip(leg: Any, motion: BodyMotion, role: int) -> LegMotion:
    """A leg whose toe tip rests, with the accelerations of foot and toes that follow, (7)."""
    given = motion.legs[role]
    foot, toes = Rotation(given.foot.angle, given.foot.rate), given.toes
    hanging = LegMotion(given.thigh, given.shank, foot, Rotation(toes.angle, toes.rate))
    ankle = leg_points(leg, hanging, motion.hip).ankle
    c, l_m = leg.ankle_to_metatarsal, leg.toe_length
    a11, a12 = c * cos(foot.angle), l_m * cos(toes.angle)
    a21, a22 = c * sin(foot.angle), l_m * sin(toes.angle)
    right_x = -ankle.acceleration[0] + foot.rate**2 * a21 + toes.rate**2 * a22
    right_y = -ankle.acceleration[1] - foot.rate**2 * a11 - toes.rate**2 * a12
    determinant = a11 * a22 - a12 * a21
    return LegMotion(
        given.thigh,
        given.shank,
        Rotation(foot.angle, foot.rate, (right_x * a22 - a12 * right_y) / determinant),
        Rotation(toes.angle, toes.rate, (a11 * right_y - a21 * right_x) / determinant),
    )


def _nought(number: Any) -> bool:
    """Whether a number of a device is zero; one that is free never is."""
    return isinstance(number, int | float) and number == 0


def _still(x: Rotation, *, held: bool) -> Any:
    """Acceleration of a deflection that stands still, errors pulled back to rest."""
    damped = x.acceleration + 2 * STIFFENING * x.rate
    return damped + STIFFENING**2 * x.angle if held else damped


def _relaxed(device: Device, x: Rotation, slip: Any) -> Any:
    """Of a massless foot without a moment: it stays where its device is slack, or relaxes there."""
    if device.kind == "series":
        x = Rotation(x.angle - slip.value, x.rate - slip.rate, x.acceleration - slip.acceleration)
        return _still(x, held=True) / ACCELERATION
    law = device.law
    if _nought(law.damping):
        return _still(x, held=True) / ACCELERATION
    change = x.acceleration + law.slope(x.angle) * x.rate / law.damping
    miss = x.rate + law.spring(x.angle) / law.damping
    return (change + STIFFENING * miss) / ACCELERATION
