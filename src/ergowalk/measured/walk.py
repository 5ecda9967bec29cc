"""A measured walk: this person's body, strides, their mean and spread, and what they cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.errors import RecordingError
from ergowalk.gait.rhythm import Rhythm
from ergowalk.measured.choices import Choices
from ergowalk.measured.dynamics import joint_loads
from ergowalk.measured.events import Events, events_by_feet, merged
from ergowalk.measured.kinematics import belt_speed, flat_frames, foot_shape, leg_angles
from ergowalk.measured.loads import FootLoad, foot_loads
from ergowalk.measured.person import (
    Lengths,
    carried_mass,
    measured_lengths,
    person_body,
)
from ergowalk.measured.strides import JOINTS, LegRecord, Stride, strides_of
from ergowalk.measured.trial import Trial, trial_of
from ergowalk.recording import Recording

Array = NDArray[np.float64]

GRAVITY = 9.81
"""[m/s2]"""


@dataclass(frozen=True)
class Spread:
    """Mean and standard deviation of strides (0 of one)."""

    mean: float
    sd: float

    @classmethod
    def of(cls, values: list[float]) -> Spread:
        """Mean and standard deviation (n - 1) of some values."""
        sd = float(np.std(values, ddof=1)) if len(values) > 1 else 0.0
        return cls(float(np.mean(values)), sd)


@dataclass(frozen=True)
class MeasuredWalk:
    """What a recording says of a walk.

    ``legs`` holds all curves over the trial, ``strides`` those of both legs, ``notes`` what was
    assumed on the way, a sentence each.
    """

    trial: Trial
    choices: Choices
    body: Body
    lengths: Lengths
    legs: Mapping[str, LegRecord]
    strides: tuple[Stride, ...]
    notes: tuple[str, ...]

    @property
    def kinetic(self) -> tuple[Stride, ...]:
        """The strides whose stance the plates have seen."""
        return tuple(stride for stride in self.strides if stride.kinetic)

    @property
    def toes_seen(self) -> bool:
        """Whether the toes have a marker on every leg."""
        return all(leg.angles.toes_seen for leg in self.legs.values())

    @property
    def stride_time(self) -> Spread:
        """Stride time T [s]."""
        return Spread.of([stride.duration for stride in self.strides])

    @property
    def step_length(self) -> Spread:
        """Step length L, half the stride [m]."""
        return Spread.of([stride.length / 2 for stride in self.strides])

    @property
    def rhythm(self) -> Rhythm:
        """Mean contact instants as fractions of T."""
        flat, heel_off, toe_off = np.mean([stride.rhythm for stride in self.strides], axis=0)
        return Rhythm(float(flat), float(heel_off), float(toe_off))

    @property
    def energy_per_metre(self) -> Spread | None:
        """E of (10) [J/m], the mean of the strides that have it: hip, knee, ankle, and metatarsals
        where the toes were seen; a leg counts twice where the other is another stride."""
        costs = [2 * sum(stride.work.values()) / stride.length for stride in self.kinetic]
        return Spread.of(costs) if costs else None

    def energy_by_joint(self) -> dict[str, float]:
        """Part of E of each joint [J/m]."""
        return {
            joint: float(np.mean([2 * s.work[joint] / s.length for s in self.kinetic]))
            for joint in JOINTS
            if self.kinetic
        }

    def curve(self, name: str) -> tuple[Array, Array] | None:
        """Mean and standard deviation (101,) of a curve over the strides that have it."""
        values = [stride.curves[name] for stride in self.strides if name in stride.curves]
        if not values:
            return None
        sd = np.std(values, axis=0, ddof=1) if len(values) > 1 else np.zeros(len(values[0]))
        return np.mean(values, axis=0), sd

    def peak_reaction(self) -> float | None:
        """Largest vertical reaction of any stride in body weights."""
        weight = self.body.total_mass * self.body.gravity_m_s2
        peaks = [float(s.curves["reaction_y"].max()) / weight for s in self.kinetic]
        return max(peaks) if peaks else None


def measure(
    recording: Recording,
    choices: Choices | None = None,
    static: Recording | None = None,
    body: Body | None = None,
) -> MeasuredWalk:
    """The walk that a recording holds.

    Parameters
    ----------
    recording : Recording
        Markers and force plates of one trial.
    choices : Choices, optional
        How it is measured.
    static : Recording, optional
        A trial in which the person stands still with all markers.
    body : Body, optional
        The person's body with equal legs, where it is known.

    Raises
    ------
    RecordingError
        If no walk can be measured from it: the message says why.
    """
    choices = choices or Choices()
    trial = trial_of(recording, choices, static)
    loads, notes = foot_loads(trial, choices)
    events, told = _events(trial, loads, choices)
    flat = {side: flat_frames(trial, events[side]) for side in trial.legs}
    sides = [side for side in trial.legs if flat[side].any()]
    if not sides:
        raise _no_stride(trial, events, "no leg has a whole stance")
    told += [f"{s} leg: left out, no whole stance" for s in trial.legs if s not in sides]
    lengths = measured_lengths(trial, [foot_shape(trial.legs[s], flat[s]) for s in sides])
    if body is None:
        mass, how = _mass(trial, loads, events, choices)
        body = person_body(mass, lengths, choices)
        notes += how
    belt = belt_speed(trial, flat)
    if belt:
        notes.append(f"the floor moves at {belt:.2f} m/s under the flat foot: a treadmill")
    legs = {}
    for side in sides:
        found = joint_loads(
            trial.legs[side], body.leg(0), loads[side].load, trial.rate, body.gravity_m_s2
        )
        angles = leg_angles(trial, side, flat[side])
        legs[side] = LegRecord(side, events[side], angles, loads[side], found)
    strides = tuple(s for leg in legs.values() for s in strides_of(trial, leg, belt))
    _check_strides(trial, strides, events)
    return MeasuredWalk(trial, choices, body, lengths, legs, strides, (*trial.notes, *notes, *told))


def _events(
    trial: Trial, loads: Mapping[str, FootLoad], choices: Choices
) -> tuple[dict[str, Events], list[str]]:
    events, told = {}, []
    for side in trial.legs:
        by_feet = events_by_feet(trial, side)
        if choices.kinematic_events or not loads[side].contacts:
            events[side] = by_feet
            told.append(f"{side} leg: contacts by the movement of the foot")
        else:
            events[side], text = merged(by_feet, loads[side].events())
            told.append(f"{side} leg: {text}")
    return events, told


def _mass(
    trial: Trial, loads: Mapping[str, FootLoad], events: Mapping[str, Events], choices: Choices
) -> tuple[float, list[str]]:
    if choices.mass_kg is not None:
        return choices.mass_kg, []
    masses = []
    for side, load in loads.items():
        contacts = events[side].contacts
        for start, end in pairwise(contacts):
            toe_off = events[side].toe_off_in(start, end)
            if toe_off is not None and load.covers(trial.time, start, toe_off):
                time = np.linspace(start, end, 2001)
                force = np.interp(time, trial.time, load.load[:, 1])
                masses.append(carried_mass({side: force}, time, GRAVITY))
    if not masses:
        why = "has no force plates" if not trial.recording.plates else "has no whole stride on them"
        raise RecordingError(
            f"{why} to weigh the person by",
            "give --mass in kg",
            field="mass",
            file=trial.recording.file,
        )
    mass = float(np.mean(masses))
    return mass, [f"mass {mass:.1f} kg, by what the plates carry over {len(masses)} strides"]


def _check_strides(trial: Trial, strides: tuple[Stride, ...], events: Mapping[str, Events]) -> None:
    if not strides:
        raise _no_stride(trial, events, "no leg has a whole stride")
    toe_off = float(np.mean([stride.rhythm[2] for stride in strides]))
    if not 0.5 < toe_off < 0.85:
        raise RecordingError(
            "a walking foot is on the ground for 50 to 85 % of the stride",
            "give a walk; a run has no double support",
            field="toe-off / stride time",
            value=round(toe_off, 3),
            file=trial.recording.file,
        )
    length = float(np.mean([stride.length for stride in strides]))
    if not 0.2 < length < 4.0:
        raise RecordingError(
            "must lie between 0.2 and 4 m",
            "give a forward walk, with the markers in their units",
            field="stride length",
            value=round(length, 3),
            file=trial.recording.file,
        )


def _no_stride(trial: Trial, events: Mapping[str, Events], what: str) -> RecordingError:
    times = "; ".join(
        f"{side} contacts at {_listed(e.contacts)} s, toe-offs at {_listed(e.toe_offs)} s"
        for side, e in events.items()
    )
    return RecordingError(
        f"{what} from heel contact to heel contact ({times} of {trial.time[0]:.2f} to "
        f"{trial.time[-1]:.2f} s)",
        "give a longer recording of a walk",
        file=trial.recording.file,
    )


def _listed(instants: tuple[float, ...]) -> str:
    return ", ".join(f"{t:.2f}" for t in instants) or "no"
