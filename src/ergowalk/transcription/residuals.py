"""What a mesh leaves undone between its nodes, element by element.

At the nodes every constraint holds to the solver's tolerance; between them the motion is a
polynomial whose inverse dynamics need not follow the parabolas of the moments, nor stay inside
the bounds. Each element is given one number, its largest error divided by what it is allowed:
above 1 it should be cut.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.corridors import ANGLES
from ergowalk.gait.loads import Loads, inverse_dynamics
from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.mechanics.kinematics import BodyMotion, joint_angles
from ergowalk.problem import constraints as c
from ergowalk.problem.objective import eq10_joint_powers
from ergowalk.quantities import JOINTS
from ergowalk.transcription.curves import PhaseCurves, Samples, Trajectory, joined
from ergowalk.transcription.devices import LOADED_JOINTS
from ergowalk.transcription.halves import Half, in_phases
from ergowalk.transcription.motion import (
    body_motion,
    device_moments,
    load_sharing,
    own_part,
)
from ergowalk.transcription.walker import Walker

Array = NDArray[np.float64]

SAMPLES = 9
"""Instants of an element at which its errors are looked for, both ends included."""

LOADED = 0.1
"""Share of body weight above which the centre of pressure counts."""


@dataclass(frozen=True)
class Allowance:
    """Error that one element may have [unit in the name].

    A little less than an acceptable gait may have anywhere. A moment-rate limit is judged over
    any interval, so the errors at both of its ends add up: the moments get a third.
    ``energy_share`` is an error of the element's share in E, as a fraction of all E.
    """

    moment_nm_per_kg: float = 3e-3
    force_body_weights: float = 8e-4
    pressure_m: float = 1.5e-3
    height_m: float = 8e-5
    angle_deg: float = 0.08
    energy_share: float = 1e-3


@dataclass(frozen=True)
class Residuals:
    """What a mesh leaves undone.

    ``errors`` has one array (n_elements,) per phase, each element's largest error as a multiple
    of what it is allowed; infinite where the curves are no numbers. ``work`` is the integral of
    all absolute joint powers over the halves that are solved [J], from the dense
    curves.
    """

    errors: tuple[Array, ...]
    work: float

    @property
    def largest(self) -> float:
        """The largest error of all elements."""
        return max(float(e.max()) for e in self.errors)


def mesh_residuals(
    halves: Sequence[Half], trajectory: Trajectory, allowed: Allowance | None = None
) -> Residuals:
    """Errors of every element, and the work on the dense curves."""
    allowed = allowed or Allowance()
    parts = [
        _PhaseErrors(walker, phase, curves)
        for _, walker, phase, curves in in_phases(halves, trajectory)
    ]
    work = sum(float(np.sum(part.work)) for part in parts)
    return Residuals(tuple(part.largest(allowed, work) for part in parts), work)


class _PhaseErrors:
    """The dense curves of one phase, arrays (n_elements * SAMPLES,), and their errors."""

    def __init__(self, walker: Walker, phase: Phase, curves: PhaseCurves) -> None:
        self.walker, self.phase, self.curves = walker, phase, curves
        s = np.linspace(0.0, 1.0, SAMPLES)
        self.samples = joined([curves.in_element(k, s) for k in range(curves.elements)])
        width = np.diff(curves.fractions)
        fraction = (curves.fractions[:-1, None] + width[:, None] * s).ravel()
        self.time = curves.start + curves.duration * fraction
        self.width = curves.duration * width
        self.motion, self.loads = _dense(walker, phase, self.samples)
        powers = _powers(walker, phase, self.samples, self.motion, self.loads)
        self.work = self.width * (np.abs(powers) @ _simpson(SAMPLES)).sum(axis=0)

    def largest(self, allowed: Allowance, work: float) -> Array:
        """Errors over allowance, the largest of each element; ``work`` is that of all phases."""
        errors = [
            self._moments() / allowed.moment_nm_per_kg,
            self._forces() / allowed.force_body_weights,
            self._pressures() / allowed.pressure_m,
            self._heights() / allowed.height_m,
            self._angles() / allowed.angle_deg,
        ]
        found = np.max(errors, axis=0).reshape(-1, SAMPLES).max(axis=1)
        found = np.maximum(found, self._energy() / (allowed.energy_share * work))
        return np.where(np.isfinite(found), found, np.inf)

    def _moments(self) -> Array:
        """Distance of hip, knee and ankle moments from their parabolas [N m/kg]."""
        worst = np.zeros_like(self.time)
        devices = device_moments(self.walker, self.phase, self.samples, self.motion)
        for role, moments in enumerate(self.loads.moments):
            for joint in LOADED_JOINTS[self.phase.legs[role]]:
                control = self.samples.control.get(f"{joint}_{role + 1}")
                device = devices.get((role, joint), 0.0)
                if device is None or (joint == "metatarsal" and control is not None):
                    continue  # a lock bears anything; the metatarsal moment has no limit
                wanted = 0.0 if control is None else control
                own = (getattr(moments, joint) - device) / self.walker.mass
                worst = np.maximum(worst, np.abs(own - wanted))
        return worst

    def _standing(self) -> list[int]:
        return [i for i, contact in enumerate(self.phase.legs) if contact is not Contact.SWING]

    def _forces(self) -> Array:
        """Excess over (8), the cap and the friction cone [body weights]."""
        weight = self.walker.mass * self.walker.gravity
        worst = np.zeros_like(self.time)
        for i in self._standing():
            limits = self.walker.limits[i]
            cap, friction = limits.vertical_reaction_body_weights, limits.friction_coefficient
            force_x, force_y = (f / weight for f in self.loads.reactions[i])
            excess = [-force_y]
            if cap != "off":
                excess.append(force_y - cap)
            if friction != "off":
                excess.append(np.abs(force_x) - friction * force_y)
            worst = np.maximum(worst, np.max(excess, axis=0))
        return worst

    def _pressures(self) -> Array:
        """Distance of the centre of pressure from its interval (9) while loaded [m]."""
        weight = self.walker.mass * self.walker.gravity
        worst = np.zeros_like(self.time)
        for i in self._standing():
            if self.walker.linear_sharing and self.phase.legs[i] is Contact.TOE:
                continue  # (12) moves it along the toes on purpose
            first, last = c.eq9_pressure_edges(self.phase.legs[i], self.walker.prints[i])
            pressure = self.loads.pressures[i]
            outside = np.maximum(first - pressure, pressure - last)
            loaded = self.loads.reactions[i][1] > LOADED * weight
            worst = np.maximum(worst, np.where(loaded, outside, 0.0))
        return worst

    def _heights(self) -> Array:
        """Depth of the feet below ground (4) [m]."""
        points = self.walker.points(self.motion)
        heights = [
            height
            for contact, leg in zip(self.phase.legs, points, strict=True)
            for height in c.eq4_clearances(contact, leg)
        ]
        depth: Array = np.max([np.zeros_like(self.time), *(-h for h in heights)], axis=0)
        return depth

    def _angles(self) -> Array:
        """Distance of the joint angles from their corridors (6) [degrees]."""
        walker, worst = self.walker, np.zeros_like(self.time)
        stride = walker.problem.stride_time_s
        since = (self.time, self.time + walker.steps.other)  # the heel contact of each leg
        for i, leg in enumerate(self.motion.legs):
            segments = (r.angle for r in (leg.thigh, leg.shank, leg.foot, leg.toes))
            angles = joint_angles(walker.legs[i], self.motion.trunk.angle, *segments)
            for name, angle in zip(ANGLES, angles, strict=False):
                if walker.bands[i].width(name) is None:
                    continue
                corridor, place = walker.corridors[i][name], since[i] / stride
                outside = np.maximum(corridor.lower(place) - angle, angle - corridor.upper(place))
                worst = np.maximum(worst, outside)
        return np.degrees(worst)

    def _energy(self) -> Array:
        """Error of the quadrature of |power| in each element [J]."""
        scheme, curves = self.curves.scheme, self.curves
        nodes = joined([curves.in_element(k, scheme.points) for k in range(curves.elements)])
        motion, loads = _dense(self.walker, self.phase, nodes)
        powers = _powers(self.walker, self.phase, nodes, motion, loads, count=scheme.m)
        work = self.width * (np.abs(powers) @ scheme.weights).sum(axis=0)
        error: Array = np.abs(work - self.work)
        return error


def _dense(walker: Walker, phase: Phase, samples: Samples) -> tuple[BodyMotion, Loads]:
    motion = body_motion(walker, phase, samples)
    sharing = load_sharing(walker, phase, samples, motion)
    return motion, inverse_dynamics(walker.problem.body, motion, phase.legs, sharing)


def _powers(
    walker: Walker,
    phase: Phase,
    samples: Samples,
    motion: BodyMotion,
    loads: Loads,
    count: int = SAMPLES,
) -> Array:
    """Powers of the walker's own moments (10) [W], (joints of both legs, n_elements, count)."""
    powers: list[Array] = []
    devices = device_moments(walker, phase, samples, motion)
    for role, leg in enumerate(motion.legs):
        own = own_part(loads.moments[role], role, devices)
        powers += eq10_joint_powers(own, motion.trunk, leg)
    assert len(powers) == 2 * len(JOINTS)
    return np.stack(powers).reshape(len(powers), -1, count)


def _simpson(count: int) -> Array:
    """Weights of the composite rule on 0 ... 1 with an odd number of samples."""
    weights = np.full(count, 2.0)
    weights[1::2] = 4.0
    weights[[0, -1]] = 1.0
    return weights / (3 * (count - 1))
