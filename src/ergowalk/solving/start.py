"""A solved gait as the start of a collocation: curves of its dataset, instants of its rhythm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.footprints import trailing_print
from ergowalk.gait.rhythm import (
    PhaseOrder,
    Rhythm,
    boundary_fractions,
    half_stride_phases,
)
from ergowalk.problem import JOINTS, GaitProblem
from ergowalk.problem.design import value_at
from ergowalk.quantities import SEGMENTS
from ergowalk.solution import Solution
from ergowalk.transcription.curves import Guess, Samples
from ergowalk.transcription.guess import with_devices
from ergowalk.transcription.motion import body_motion
from ergowalk.transcription.walker import SHARING, Smoothing, Walker

Array = NDArray[np.float64]

SAME_INSTANT = 1e-9
"""Instants of a record closer than this part of the stride time are one, seen from both sides."""

KINDS = ("angle", "angular_velocity", "angular_acceleration")


@dataclass(frozen=True)
class StartingGait:
    """A gait to begin with; its phases are those of its own rhythm, whatever the problem's."""

    gait: Solution

    @property
    def order(self) -> PhaseOrder:
        """The order of its phases."""
        return self.gait.rhythm.order

    @property
    def stride_time(self) -> float:
        """Its T [s]."""
        return float(self.gait.dataset.attrs["stride_time"])

    def times(self, problem: GaitProblem) -> dict[str, float] | None:
        """Its boundary instants [s] in a problem's stride and inside its bounds.

        None where the problem excludes the order of its phases.
        """
        if self.order not in problem.rhythm.orders():
            return None
        own, inside = self.gait.rhythm, {}
        for name in ("heel_end", "heel_off", "toe_off"):
            low, high = problem.rhythm.bounds(name)
            inside[name] = min(max(getattr(own, name), low), high)
        rhythm = Rhythm(**inside)
        fractions = boundary_fractions(rhythm)
        phases = half_stride_phases(self.order)
        if any(fractions[p.start] >= fractions[p.end] for p in phases):
            return None
        return {name: f * problem.stride_time_s for name, f in fractions.items()}

    def design(self, problem: GaitProblem) -> dict[str, float]:
        """What this gait has of a problem's free numbers, as far as their bounds allow."""
        found = {f.path: (f, value_at(self.gait.problem, f.path)) for f in problem.design.free}
        return {p: f.inside(v) for p, (f, v) in found.items() if isinstance(v, int | float)}

    def guess(self, problem: GaitProblem) -> Guess:
        """Its curves phase by phase, stretched to the stride time of a problem."""
        phases, data, stride = half_stride_phases(self.order), self.gait.dataset, self.stride_time
        fractions = boundary_fractions(self.gait.rhythm)
        time = data["time"].to_numpy()
        own, slower = self.gait.problem, stride / problem.stride_time_s
        mass = own.body.total_mass
        tip = trailing_print(own.body.leg(0), own.step_length_m).toe_tip
        trunk = [data[f"trunk_{k}"].to_numpy() for k in KINDS]
        legs = [data[f"segment_{k}"].transpose("time", "leg", "segment").to_numpy() for k in KINDS]
        moment = data["joint_moment"].transpose("time", "leg", "joint").to_numpy() / mass
        force = data["ground_reaction_force"].transpose("time", "leg", "axis").to_numpy() / mass
        pressure = data["center_of_pressure"].transpose("time", "leg").to_numpy()[:, 1]
        shift = np.nan_to_num(pressure - tip)
        walker = Walker(problem, Smoothing())

        def guess(i: int, parts: Array) -> Samples:
            start, end = (fractions[n] * stride for n in (phases[i].start, phases[i].end))
            part = within(time, start, end, SAME_INSTANT * stride)
            at = start + (end - start) * parts

            def curve(values: Array) -> Array:
                return np.interp(at, time[part], values[part])

            value, rate, acceleration = (
                _angles(trunk[d], legs[d], curve, slower**d) for d in range(3)
            )
            control = {
                f"{joint}_{leg + 1}": curve(moment[:, leg, j])
                for leg in (0, 1)
                for j, joint in enumerate(JOINTS)
            }
            algebraic = {
                f"reaction_{axis}_{leg + 1}": curve(force[:, leg, k])
                for leg in (0, 1)
                for k, axis in enumerate("xy")
            }
            for name in ("foot_2", "toes_2"):
                algebraic |= {name: value[name], f"{name}_rate": rate[name]}
            if phases[i].double_support:
                for name, line in zip(SHARING, (shift, force[:, 1, 0]), strict=True):
                    value[name], acceleration[name] = curve(line), 0 * at
                    rate[name] = 0 * at + (line[part][-1] - line[part][0]) / (end - start)
            samples = Samples(value, rate, acceleration, control, algebraic)
            if not walker.fittings.devices:
                return samples
            return with_devices(walker, phases[i], samples, body_motion(walker, phases[i], samples))

        return guess


def within(time: Array, start: float, end: float, slack: float) -> slice:
    """The samples of a phase: where an instant stands twice, the side inside."""
    first = int(np.searchsorted(time, start + slack, "right")) - 1
    last = int(np.searchsorted(time, end - slack, "left"))
    return slice(max(first, 0), min(last, len(time) - 1) + 1)


def _angles(
    trunk: Array, legs: Array, curve: Callable[[Array], Array], factor: float
) -> dict[str, Array]:
    """Trunk and segments of both legs, or a derivative of theirs."""
    found = {"trunk": factor * curve(trunk)}
    for leg in (0, 1):
        for s, segment in enumerate(SEGMENTS):
            found[f"{segment}_{leg + 1}"] = factor * curve(legs[:, leg, s])
    return found
