"""From the unknowns of the collocation back to the whole walker, as arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.loads import Sharing
from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.mechanics.foot import reaction_from_moments, toe_chain
from ergowalk.mechanics.kinematics import BodyMotion, LegMotion, Rotation, link
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
        + link(walker.leg.thigh_length, leg.thigh)
        + link(walker.leg.shank_length, leg.shank)
    )
    foot, toes = toe_chain(walker.leg, ankle, (walker.prints[1].toe_tip, 0.0))
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
        walker.mass * samples.control[name] for name in ("ankle_2", "metatarsal_2")
    )
    force_x, force_y = reaction_from_moments(points, ankle, metatarsal, pressure)
    if walker.linear_sharing:
        force_x = walker.mass * samples.value["reaction_share"]
    return Sharing(force_x, force_y, pressure)


def _with_arrays(motion: BodyMotion, zero: Array) -> BodyMotion:
    """Constants (a flat foot's angle) spread over all instants."""

    def spread(x: Rotation) -> Rotation:
        return Rotation(x.angle + zero, x.rate + zero, x.acceleration + zero)

    one, two = (
        LegMotion(spread(g.thigh), spread(g.shank), spread(g.foot), spread(g.toes))
        for g in motion.legs
    )
    return BodyMotion(motion.hip, spread(motion.trunk), (one, two))
