"""The problem of a measured person: corridors as a table, and what 'solve' takes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.corridors import SIGNALS, Signal
from ergowalk.measured.strides import POINTS
from ergowalk.measured.walk import MeasuredWalk
from ergowalk.problem import Corridors, GaitProblem, Limits, RhythmBounds

Array = NDArray[np.float64]

TABLE = "corridors.csv"
"""Name of the table beside the problem."""

LEAST_SHARE = 0.10
"""Least SD of reactions, moments and powers, as a share of the largest mean value."""

RHYTHM = 0.05
"""How far the contact instants may move from the measured ones, in parts of T."""

MARGIN = 0.01
"""Least distance of an instant from the ends of its range, in parts of T."""

LEADING, TRAILING = (0.0, 0.5), (0.5, 1.0)
"""Where the instants of the rhythm may lie (exclusive)."""


def corridor_table(walk: MeasuredWalk) -> str:
    """Mean and SD over the strides of both legs as a table that a problem may name.

    The SD is that between the strides, but at least the floor that was chosen for angles, and
    :data:`LEAST_SHARE` of the largest mean for the others. Signs are those of the built-in tables.
    """
    columns: dict[str, Array] = {"percent_stride": np.linspace(0.0, 100.0, POINTS)}
    for signal in SIGNALS.values():
        found = _in_table_units(walk, signal)
        if found is not None:
            columns |= dict(zip(signal.columns, found, strict=True))
    lines = [f"# {walk.choices.name}: {_counted(walk)}"]
    lines += [
        f"# sd: between strides, of angles at least {walk.choices.sd_floor_deg:g} deg, of the "
        f"others at least {LEAST_SHARE:.0%} of the largest mean",
        f"# low-pass {walk.choices.cutoff_hz:g} Hz; signs as in the built-in tables",
        ",".join(columns),
    ]
    rows = np.stack(list(columns.values()), axis=1)
    lines += [",".join(f"{value:.6g}" for value in row) for row in rows]
    return "\n".join(lines) + "\n"


def _in_table_units(walk: MeasuredWalk, signal: Signal) -> tuple[Array, Array] | None:
    found = walk.curve(signal.name)
    if found is None:
        return None
    angle = signal.unit == "deg"
    scale = 180 / math.pi if angle else 1 / walk.body.total_mass
    mean, sd = signal.sign * scale * found[0], scale * found[1]
    floor = walk.choices.sd_floor_deg if angle else LEAST_SHARE * float(np.abs(mean).max())
    return mean, np.maximum(sd, floor)


def _counted(walk: MeasuredWalk) -> str:
    sides = " and ".join(f"{sum(s.side == side for s in walk.strides)} of the {side} leg"
                         for side in walk.legs)  # fmt: skip
    return f"{len(walk.strides)} strides, {sides}; {len(walk.kinetic)} with forces"


def measured_problem(walk: MeasuredWalk) -> GaitProblem:
    """The problem of this person's walk: body, step length, stride time, rhythm, corridors.

    Contact instants are bounded within :data:`RHYTHM` of the measured means. Limits keep their
    defaults; the cap on the vertical reaction is raised to the person's peak where that is higher.

    Raises
    ------
    ProblemError, BodyError, CorridorError
        If the model cannot walk like this at all.
    """
    return GaitProblem(
        name=walk.choices.name,
        step_length_m=round(walk.step_length.mean, 4),
        stride_time_s=round(walk.stride_time.mean, 4),
        body=_rounded(walk),
        corridors=Corridors(source=TABLE),
        rhythm=_rhythm(walk),
        limits=_limits(walk),
    )


def _rounded(walk: MeasuredWalk) -> Body:
    """The body, with as many digits as a person has."""
    fields = {name: getattr(walk.body, name) for name in type(walk.body).model_fields}
    return Body(**{n: float(f"{v:.6g}") if isinstance(v, float) else v
                              for n, v in fields.items()})  # fmt: skip


def _rhythm(walk: MeasuredWalk) -> RhythmBounds:
    rhythm = walk.rhythm

    def around(instant: float, room: tuple[float, float]) -> tuple[float, float]:
        # a person may be where the model cannot: then the nearest window inside
        first, last = room[0] + MARGIN, room[1] - MARGIN
        low = max(min(instant, last - RHYTHM) - RHYTHM, first)
        return round(low, 3), round(min(max(instant, first + RHYTHM) + RHYTHM, last), 3)

    return RhythmBounds(
        heel_end=around(rhythm.heel_end, LEADING),
        heel_off=around(rhythm.heel_off, LEADING),
        toe_off=around(rhythm.toe_off, TRAILING),
    )


def _limits(walk: MeasuredWalk) -> Limits:
    default = Limits()
    changes: dict[str, object] = {}
    peak, cap = walk.peak_reaction(), default.vertical_reaction_body_weights
    if peak is not None and cap != "off" and peak > cap:
        changes["vertical_reaction_body_weights"] = math.ceil(20 * peak) / 20
    found: Limits = default.replace(**changes)
    return found
