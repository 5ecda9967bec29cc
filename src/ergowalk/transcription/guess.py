"""Where the search begins: the human mean curves, made to stand on the ground."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.rhythm import (
    Contact,
    Phase,
    PhaseOrder,
    Rhythm,
    boundary_fractions,
    half_stride_phases,
)
from ergowalk.mechanics.dynamics import joint_moments_from, total_reaction
from ergowalk.mechanics.foot import ankle_moment_under, metatarsal_moment_under
from ergowalk.mechanics.kinematics import BodyMotion
from ergowalk.problem import Device, GaitProblem
from ergowalk.transcription.curves import Guess, Samples, Trajectory
from ergowalk.transcription.motion import body_motion
from ergowalk.transcription.walker import SHARING, Walker

Array = NDArray[np.float64]


SHORTEST_START = 0.015
"""Shortest phase of a starting rhythm, as a fraction of T, where the bounds leave room."""


def starting_rhythm(problem: GaitProblem, order: PhaseOrder) -> Rhythm:
    """The printed rhythm inside the bounds, in the asked order, with room for every phase."""
    return rhythm_with_room(problem, order, problem.rhythm.start())


def rhythm_with_room(problem: GaitProblem, order: PhaseOrder, wanted: Rhythm) -> Rhythm:
    """The nearest rhythm inside the bounds of the problem, in the asked order.

    Every phase lasts at least :data:`SHORTEST_START`, or as long as the bounds allow.
    """
    toe_low, toe_high = problem.rhythm.bounds("toe_off")
    ranges = {
        "heel_end": problem.rhythm.bounds("heel_end"),
        "other_toe_off": (toe_low - 0.5, toe_high - 0.5),
        "heel_off": problem.rhythm.bounds("heel_off"),
    }
    inner = [phase.end for phase in half_stride_phases(order)[:-1]]
    early = sorted((wanted.heel_end, wanted.other_toe_off))  # the asked order may exchange them
    lower, upper = zip((0.0, 0.0), *(ranges[name] for name in inner), (0.5, 0.5), strict=True)
    found = _with_room((0.0, *early, wanted.heel_off, 0.5), lower, upper)
    instants = dict(zip(inner, found[1:-1], strict=True))
    return Rhythm(instants["heel_end"], instants["heel_off"], instants["other_toe_off"] + 0.5)


def _with_room(
    wanted: Sequence[float], lower: Sequence[float], upper: Sequence[float]
) -> list[float]:
    """Instants in order between their bounds, moved only where that gives a phase its room."""
    rooms = _rooms(lower, upper)
    latest = list(upper)
    for k in reversed(range(len(rooms))):
        latest[k] = min(latest[k], latest[k + 1] - rooms[k])
    found = [lower[0]]
    for k, room in enumerate(rooms, start=1):
        later = max(wanted[k], found[-1] + room)
        found.append(max(lower[k], min(later, latest[k])))
    return found


def _rooms(lower: Sequence[float], upper: Sequence[float]) -> list[float]:
    """Shortest duration of each phase: :data:`SHORTEST_START`, less where the bounds are tighter.

    The phases between two instants share at most the upper bound of the later less the lower
    bound of the earlier. The tightest pair of instants gives its phases equal parts of that; the
    others share what is left to them, until all have their room.
    """
    count = len(lower) - 1
    rooms: dict[int, float] = {}
    while len(rooms) < count:
        parts = []
        for first, last in combinations(range(count + 1), 2):
            waiting = [k for k in range(first, last) if k not in rooms]
            if waiting:
                given = sum(rooms.get(k, 0.0) for k in range(first, last))
                parts.append(((upper[last] - lower[first] - given) / len(waiting), waiting))
        part, waiting = min(parts)
        if part >= SHORTEST_START:
            waiting = [k for k in range(count) if k not in rooms]
        rooms |= dict.fromkeys(waiting, min(max(part, 0.0), SHORTEST_START))
    return [rooms[k] for k in range(count)]


def starting_times(problem: GaitProblem, rhythm: Rhythm) -> dict[str, float]:
    """Boundary instants [s] of a rhythm."""
    stride = problem.stride_time_s
    return {name: f * stride for name, f in boundary_fractions(rhythm).items()}


def human_guess(walker: Walker, order: PhaseOrder, times: Mapping[str, float]) -> Guess:
    """Angles from the mean joint angles, trunk upright; for the kinematic fit."""
    phases, stride = half_stride_phases(order), walker.problem.stride_time_s

    def guess(i: int, fractions: Array) -> Samples:
        start, end = times[phases[i].start], times[phases[i].end]
        s = (start + (end - start) * fractions) / stride
        value, rate, acceleration = (_angles(walker, s, d) for d in (0, 1, 2))
        algebraic = {
            "foot_2": value["foot_2"],
            "toes_2": value["foot_2"] + walker.legs[1].foot_angle,
            "foot_2_rate": rate["foot_2"],
            "toes_2_rate": rate["foot_2"],
        }
        return Samples(value, rate, acceleration, {}, algebraic)

    return guess


def _angles(walker: Walker, s: Array, derivative: int) -> dict[str, Array]:
    """Segment angles of the human mean, or their time derivatives, at stride fractions s."""
    factor = walker.problem.stride_time_s**-derivative
    out = {"trunk": np.zeros_like(s)}
    for leg, shift in ((1, 0.0), (2, 0.5)):
        hip, knee, ankle = (
            walker.corridors[leg - 1][j].mean(s + shift, derivative) * factor
            for j in ("hip", "knee", "ankle")
        )
        out[f"thigh_{leg}"], out[f"shank_{leg}"] = hip, hip - knee
        out[f"foot_{leg}"] = (
            ankle + out[f"shank_{leg}"] + (0 if derivative else walker.flats[leg - 1])
        )
    return out


def loaded_guess(walker: Walker, order: PhaseOrder, fit: Trajectory) -> Guess:
    """The fitted motion with moments and reactions by inverse dynamics.

    In double support the trailing foot's share of the load runs linearly down to toe-off.
    """
    phases = half_stride_phases(order)
    toe_off, mass = fit.times["other_toe_off"], walker.mass

    def guess(i: int, fractions: Array) -> Samples:
        phase, curves = phases[i], fit.phases[i]
        samples = curves.at(fractions)
        motion = body_motion(walker, phase, samples)
        time = curves.start + curves.duration * fractions
        share = np.clip(1 - time / toe_off, 0.0, 1.0) if phase.double_support else 0.0 * time
        force = total_reaction(walker.coefficients, motion)
        two = (share * force[0], share * force[1])
        one = (force[0] - two[0], force[1] - two[1])
        points, tip = walker.points(motion), walker.prints[1].toe_tip
        p_2 = ankle_moment_under(points[1], two, tip) if phase.double_support else 0.0 * time
        w_2 = metatarsal_moment_under(points[1], two, tip) if phase.double_support else p_2
        first, second = joint_moments_from(walker.coefficients, motion, (one, two), p_2)
        (x_a, y_a), x_m = points[0].ankle.position, points[0].metatarsal.position[0]
        w_1 = first[2] + y_a * one[0] + (x_m - x_a) * one[1]
        moments = [*first, w_1, *second, w_2]
        total = {n: m / mass for n, m in zip(_CONTROLS, moments, strict=True)}
        rest = dict.fromkeys(SHARING, 0 * time)
        value = {**samples.value, **rest, "reaction_share": two[0] / mass}
        rate, acceleration = {**samples.rate, **rest}, {**samples.acceleration, **rest}
        algebraic = {
            "reaction_x_1": one[0] / mass,
            "reaction_y_1": one[1] / mass,
            "reaction_x_2": two[0] / mass,
            "reaction_y_2": two[1] / mass,
            "foot_2": motion.legs[1].foot.angle,
            "toes_2": motion.legs[1].toes.angle,
            "foot_2_rate": motion.legs[1].foot.rate,
            "toes_2_rate": motion.legs[1].toes.rate,
        }
        samples = Samples(value, rate, acceleration, total, algebraic)
        return with_devices(walker, phase, samples, motion)

    return guess


def with_devices(walker: Walker, phase: Phase, samples: Samples, motion: BodyMotion) -> Samples:
    """A guess whose controls are total moments per kg, divided between walker and devices.

    Dampers in series start where their springs are slack, locks bear all.
    """
    fittings = walker.fittings
    if not fittings.devices:
        return samples
    control, algebraic = dict(samples.control), dict(samples.algebraic)
    value, rate = dict(samples.value), dict(samples.rate)
    acceleration = dict(samples.acceleration)
    for role, contact in enumerate(phase.legs):
        for joint, device in fittings.acting(role, contact):
            name = f"{joint}_{role + 1}"
            x = fittings.deflection(role, joint, motion)
            slip = f"slip_{name}"
            value[slip], rate[slip], acceleration[slip] = x.angle, x.rate, 0 * x.rate
            algebraic[f"lock_{name}"] = control.get(name, 0 * x.rate)
            if joint == "ankle" and _stands_still(walker, role, contact, device):
                _follow_shank(value, rate, acceleration, role, x.angle)
                motion = body_motion(walker, phase, Samples(value, rate, acceleration, {}, {}))
            if name in control and device.kind not in ("locked", "free"):
                bears = fittings.moment(role, joint, contact, motion, value, {})
                control[name] = control[name] - bears
    return Samples(value, rate, acceleration, control, algebraic)


def _stands_still(walker: Walker, role: int, contact: Contact, device: Device) -> bool:
    """Whether a swinging foot cannot turn against its shank."""
    if contact is not Contact.SWING:
        return False
    if device.kind == "locked" and device.rest_angle_deg != "latched":
        return True
    moving = walker.fittings.moves_swing_foot(role, contact)
    return moving is device and not device.damping_nms_per_rad


def _follow_shank(
    value: dict[str, Array],
    rate: dict[str, Array],
    acceleration: dict[str, Array],
    role: int,
    deflection: Array,
) -> None:
    """The foot turned to where its device is slack, and moving with the shank."""
    foot, shank = f"foot_{role + 1}", f"shank_{role + 1}"
    value[foot] = value[foot] - deflection
    rate[foot], acceleration[foot] = rate[shank], acceleration[shank]


_CONTROLS = tuple(f"{j}_{i}" for i in (1, 2) for j in ("hip", "knee", "ankle", "metatarsal"))
