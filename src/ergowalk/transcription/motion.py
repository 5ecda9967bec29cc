"""From the unknowns of the collocation back to the whole walker, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.loads import Sharing
from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.mechanics.dynamics import LegMoments
from ergowalk.mechanics.foot import reaction_from_moments, toe_chain
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Rotation, link
from ergowalk.quantities import JOINTS
from ergowalk.transcription.curves import Samples
from ergowalk.transcription.phases import Instant, State
from ergowalk.transcription.walker import Walker

Array = NDArray[np.float64]


def body_motion(walker: Walker, phase: Phase, samples: Samples) -> BodyMotion:
    """The whole walker at the sampled instants, with exact rates and accelerations.

    A trailing foot on its toe tip follows from its ankle in closed form, not from the values at
    the Gauss points: the toe tip rests exactly.
    """
    zero = np.zeros_like(next(iter(samples.value.values())))
    states = {
        name: State(samples.value[name], samples.rate[name], samples.acceleration[name])
        for name in samples.value
    }
    motion = walker.motion(phase, Instant(zero, states, {}, {}))
    motion = _with_arrays(motion, zero)
    if phase.legs[1] is not Contact.TOE:
        return motion
    leg = motion.legs[1]
    ankle = (
        motion.hip
        + link(walker.legs[1].thigh_length, leg.thigh)
        + link(walker.legs[1].shank_length, leg.shank)
    )
    foot, toes = toe_chain(walker.legs[1], ankle, (walker.prints[1].toe_tip, 0.0))
    return BodyMotion(
        motion.hip, motion.trunk, (motion.legs[0], LegMotion(leg.thigh, leg.shank, foot, toes))
    )


def load_sharing(walker: Walker, phase: Phase, samples: Samples, motion: BodyMotion) -> Sharing:
    """What the trailing foot carries [N]: from its ankle and metatarsal moments.

    The moments are continuous, and parabolas within an element: the force is continuous too.
    """
    zero = np.zeros_like(motion.trunk.angle)
    if phase.legs[1] is not Contact.TOE:
        return Sharing(zero, zero, zero)
    pressure = walker.prints[1].toe_tip + samples.value.get("pressure_shift", zero)
    points = walker.points(motion)[1]
    ankle, metatarsal = (
        walker.mass
        * (
            samples.control.get(f"{joint}_2", zero)
            + device_moment(walker, phase, samples, motion, 1, joint)
        )
        for joint in ("ankle", "metatarsal")
    )
    force_x, force_y = reaction_from_moments(points, ankle, metatarsal, pressure)
    if walker.linear_sharing:
        force_x = walker.mass * samples.value["reaction_share"]
    return Sharing(force_x, force_y, pressure)


def device_moment(
    walker: Walker, phase: Phase, samples: Samples, motion: BodyMotion, role: int, joint: str
) -> Array:
    """Moment of a device on the distal segment per kg, (n,); zero where none acts."""
    zero = np.zeros_like(motion.trunk.angle)
    contact = phase.legs[role]
    found: Array = zero + walker.fittings.moment(
        role, joint, contact, motion, samples.value, samples.algebraic
    )
    return found


def device_moments(
    walker: Walker, phase: Phase, samples: Samples, motion: BodyMotion
) -> dict[tuple[int, str], Array | None]:
    """Moments of the devices that act [N m], by role and joint; None for a lock.

    A lock bears whatever the joint must bear.
    """
    found: dict[tuple[int, str], Array | None] = {}
    for role, contact in enumerate(phase.legs):
        for joint, device in walker.fittings.acting(role, contact):
            moment = device_moment(walker, phase, samples, motion, role, joint)
            found[role, joint] = None if device.kind == "locked" else walker.mass * moment
    return found


def own_part(
    moments: LegMoments, role: int, devices: Mapping[tuple[int, str], Array | None]
) -> LegMoments:
    """What the walker itself gives of the joint moments of a leg [N m]."""

    def own(joint: str) -> Any:
        total, device = getattr(moments, joint), devices.get((role, joint), 0.0)
        return 0 * total if device is None else total - device

    return LegMoments(*(own(joint) for joint in JOINTS)) if devices else moments


def _with_arrays(motion: BodyMotion, zero: Array) -> BodyMotion:
    """Constants (a flat foot's angle) spread over all instants."""

    def spread(x: Rotation) -> Rotation:
        return Rotation(x.angle + zero, x.rate + zero, x.acceleration + zero)

    one, two = (
        LegMotion(spread(g.thigh), spread(g.shank), spread(g.foot), spread(g.toes))
        for g in motion.legs
    )
    return BodyMotion(motion.hip, spread(motion.trunk), (one, two))
