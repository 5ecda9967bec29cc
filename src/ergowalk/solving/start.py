"""A solved gait as the start of a collocation: curves of its dataset, instants of its rhythm."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.footprints import trailing_print
from ergowalk.gait.rhythm import PhaseOrder, half_stride_phases
from ergowalk.problem import JOINTS, GaitProblem
from ergowalk.problem.design import free_values, value_at
from ergowalk.quantities import SEGMENTS
from ergowalk.solution import Solution
from ergowalk.transcription.curves import Guess, Samples
from ergowalk.transcription.guess import with_devices
from ergowalk.transcription.halves import Half, Orders
from ergowalk.transcription.motion import body_motion
from ergowalk.transcription.steps import STEP_1
from ergowalk.transcription.walker import SHARING, Walker

Array = NDArray[np.float64]

SAME_STEPS = 0.02
"""Share by which step length and stride time may differ where steps are almost the same."""

SAME_INSTANT = 1e-9
"""Instants of a record closer than this part of the stride time are one, seen from both sides."""

KINDS = ("angle", "angular_velocity", "angular_acceleration")


@dataclass(frozen=True)
class StartingGait:
    """A gait to begin with; its phases are those of its own rhythm, whatever the problem's.

    A gait whose legs mirror each other serves for both halves of a stride.
    """

    gait: Solution

    @property
    def stride_time(self) -> float:
        """Its T [s]."""
        return float(self.gait.dataset.attrs["stride_time"])

    def has_steps_of(self, problem: GaitProblem) -> bool:
        """Whether the steps of a problem are almost those of this gait."""
        own = self.gait.problem
        pairs = (
            (problem.step_length_m, own.step_length_m),
            (problem.stride_time_s, own.stride_time_s),
        )
        return all(abs(wanted / has - 1) <= SAME_STEPS for wanted, has in pairs)

    def orders(self, problem: GaitProblem) -> Orders | None:
        """The orders of its phases in the halves of a problem; None where that excludes them."""
        found = tuple(self._order(half) for half in range(1 + problem.full_stride))
        return found if set(found) <= set(problem.rhythm.orders()) else None

    def times(self, problem: GaitProblem, halves: Sequence[Half]) -> dict[str, float] | None:
        """Its boundary instants [s] in a problem's stride and inside its bounds.

        None where a phase would have no room.
        """
        found: dict[str, float] = {}
        for i, half in enumerate(halves):
            fractions = self._fractions(i, (problem, len(halves)))
            if any(fractions[p.start] >= fractions[p.end] for p in half.phases):
                return None
            stride = problem.stride_time_s
            found |= {name + half.tag: f * stride for name, f in fractions.items()}
        return found

    def shared(self, problem: GaitProblem) -> dict[str, float]:
        """Its unknowns of no instant: step 1 where the legs have their own, and the design."""
        if not problem.full_stride:
            return self.design(problem)
        first, second = self.gait.step_lengths
        step_1 = 2 * problem.step_length_m * first / (first + second)
        return {STEP_1: step_1, **self.design(problem)}

    def design(self, problem: GaitProblem) -> dict[str, float]:
        """What this gait has of a problem's free numbers, as far as their bounds allow."""
        found = {f.path: (f, value_at(self.gait.problem, f.path)) for f in problem.design.free}
        return {p: f.inside(v) for p, (f, v) in found.items() if isinstance(v, int | float)}

    def guess(self, problem: GaitProblem, halves: Sequence[Half]) -> Guess:
        """Its curves phase by phase, stretched to the stride time of a problem."""
        times = self.times(problem, halves) or {}
        given = {**free_values(problem), **self.shared(problem), **times}
        slower = self.stride_time / problem.stride_time_s
        each = [self._half(i, half.walker.at(given), slower) for i, half in enumerate(halves)]
        count = len(halves[0].phases)
        return lambda i, fractions: each[i // count](i % count, fractions)

    def _order(self, half: int) -> PhaseOrder:
        fractions = self._fractions(half)
        first = fractions["other_toe_off"] <= fractions["heel_end"]
        return PhaseOrder.TOE_OFF_FIRST if first else PhaseOrder.FLAT_FIRST

    def _fractions(
        self, half: int, inside: tuple[GaitProblem, int] | None = None
    ) -> dict[str, float]:
        """Boundary instants of a half over T, on its own clock; inside the bounds of a problem.

        Of a problem with one half the legs mirror each other.
        """
        leads, trails = self.gait.rhythms[half], self.gait.rhythms[1 - half]
        found = {n: getattr(leads, n) for n in ("heel_end", "heel_off")}
        toe_off, lasts = trails.toe_off, leads.toe_tip_start
        before = 1.0 - lasts
        if inside is not None:
            problem, count = inside
            found = {n: _clamped(x, problem.rhythm_of(half).bounds(n)) for n, x in found.items()}
            trailing = 1 - half if count > 1 else half
            if count == 1:
                lasts, before = 0.5, 0.5
            toe_off = _clamped(toe_off, problem.rhythm_of(trailing).bounds("toe_off"))
        return {
            "heel_contact": 0.0,
            **found,
            "other_toe_off": toe_off - before,
            "half_stride": lasts,
        }

    def _half(self, index: int, walker: Walker, slower: float) -> Guess:
        """The curves of one half, legs in their roles, at rates so many times as high."""
        phases, stride = half_stride_phases(self._order(index)), self.stride_time
        data = self.gait.dataset
        fractions, roles = self._fractions(index), [index, 1 - index]
        contact = index * self.gait.rhythm.toe_tip_start * stride
        time = data["time"].to_numpy() - contact
        own = self.gait.problem
        mass = own.body.total_mass
        step_1, step_2 = self.gait.step_lengths
        behind, origin = (step_2, step_2) if index else (step_1, 0.0)
        tip = origin + trailing_print(own.body.leg(roles[1]), behind).toe_tip
        trunk = [data[f"trunk_{k}"].to_numpy() for k in KINDS]

        def in_roles(name: str, dim: str) -> Array:
            found: Array = data[name].transpose("time", "leg", dim).to_numpy()[:, roles]
            return found

        legs = [in_roles(f"segment_{k}", "segment") for k in KINDS]
        moment = in_roles("joint_moment", "joint") / mass
        force = in_roles("ground_reaction_force", "axis") / mass
        pressure = data["center_of_pressure"].transpose("time", "leg").to_numpy()[:, roles[1]]
        shift = np.nan_to_num(pressure - tip)

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
                f"{joint}_{role + 1}": curve(moment[:, role, j])
                for role in (0, 1)
                for j, joint in enumerate(JOINTS)
            }
            algebraic = {
                f"reaction_{axis}_{role + 1}": curve(force[:, role, k])
                for role in (0, 1)
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


def _clamped(value: float, bounds: tuple[float, float]) -> float:
    return min(max(value, bounds[0]), bounds[1])


def _angles(
    trunk: Array, legs: Array, curve: Callable[[Array], Array], factor: float
) -> dict[str, Array]:
    """Trunk and segments of both legs, or a derivative of theirs."""
    found = {"trunk": factor * curve(trunk)}
    for leg in (0, 1):
        for s, segment in enumerate(SEGMENTS):
            found[f"{segment}_{leg + 1}"] = factor * curve(legs[:, leg, s])
    return found
