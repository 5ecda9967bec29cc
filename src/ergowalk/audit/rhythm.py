"""Lines about time: the grid of the record, the contact phases and the rhythm."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ergowalk.audit import residuals
from ergowalk.audit.record import PHASES, RHYTHM, SWING, UNKNOWN_PHASE, Record, as_number
from ergowalk.audit.report import AuditLine, Worst

CYCLE = (1, 2, 3, 4, SWING)
"""Phases of a leg from heel contact on: heel, flat, forefoot, toe, swing."""


NOT_STATED = "the stored problem does not state rhythm.{}"


def grid_lines(record: Record) -> list[AuditLine]:
    """Time from 0 to T in steps of T/400 or less, five samples or more in each piece."""
    time, period, pieces = record.time, record.stride_time, record.pieces
    ends = Worst(float(max(abs(time[0]), abs(time[-1] - period))) / period, "")
    step = np.diff(time) / period
    at = int(np.argmax(step))
    longest = Worst(float(step[at]), f"t = {time[at]:.4f} s")
    short = np.flatnonzero(pieces.last - pieces.first + 1 < 5)
    where = f"t = {time[pieces.first[short[0]]]:.4f} s" if len(short) else ""
    return [
        residuals.TIME_SPAN.judged(ends),
        residuals.TIME_STEPS.judged(longest),
        residuals.SMOOTH_PIECES.judged(Worst(float(len(short)), where)),
    ]


def phase_line(record: Record) -> AuditLine:
    """Phases in cyclic order, each lasting, changing at the instants of the rhythm."""
    found = Worst(0.0, "")
    for leg in (0, 1):
        runs = _runs(record, leg)
        fault = _order_fault(runs, record.stride_time)
        if fault:
            return residuals.PHASES.cannot_be_judged(f"leg {leg + 1}: {fault}")
        for before, run in pairwise([*runs, runs[0]]):
            late = _offset(record, leg, before, run)
            if late > found.value:
                where = f"t = {run.start:.4f} s, leg {leg + 1}, start of {PHASES[run.phase]}"
                found = Worst(late, where)
    return residuals.PHASES.judged(found)


@dataclass(frozen=True)
class _Run:
    """A stretch of samples in one phase [s]."""

    phase: int
    start: float
    end: float


def _runs(record: Record, leg: int) -> list[_Run]:
    """Stretches of one phase in the order of the record, the seam at T closed."""
    phase, time = record.phase[:, leg], record.time
    change = np.flatnonzero(np.diff(phase))
    ends = zip([0, *(change + 1)], [*change, len(time) - 1], strict=True)
    runs = [_Run(int(phase[a]), float(time[a]), float(time[b])) for a, b in ends]
    if len(runs) > 1 and runs[0].phase == runs[-1].phase:
        wrapped = runs.pop()
        runs[0] = _Run(wrapped.phase, wrapped.start, runs[0].end + record.stride_time)
    return runs


def _order_fault(runs: list[_Run], period: float) -> str:
    """What is wrong with the sequence of phases of a leg; empty if nothing is."""
    for run in runs:
        if run.phase == UNKNOWN_PHASE:
            return f"no known phase at t = {run.start:.4f} s"
    for run, after in pairwise([*runs, runs[0]]):
        if CYCLE.index(after.phase) != (CYCLE.index(run.phase) + 1) % len(CYCLE):
            when = run.end % period
            return f"{PHASES[after.phase]} follows {PHASES[run.phase]} at t = {when:.4f} s"
    if len(runs) != len(CYCLE):
        return f"{len(runs)} phases in a stride, not {len(CYCLE)}"
    for run in runs:
        if run.end - run.start <= 1e-9 * period:
            return f"{PHASES[run.phase]} does not last at t = {run.start:.4f} s"
    return ""


def _offset(record: Record, leg: int, before: _Run, run: _Run) -> float:
    """How far the change between two phases is from the rhythm, as a fraction of T.

    The last sample before and the first one after it both count: the instant stands twice.
    """
    starts = (0.0, *(record.rhythms[leg][name] for name in RHYTHM))
    wanted = starts[CYCLE.index(run.phase)] + record.contacts[leg] / record.stride_time
    distance = np.array([before.end, run.start]) / record.stride_time - wanted
    return float(np.max(np.abs(distance - np.round(distance))))


def rhythm_lines(record: Record) -> list[AuditLine]:
    """The rhythm against inequality (3) and against what the stored problem asks for."""
    breaches: dict[str, float] = {}
    for leg in _own_legs(record):
        heel_end, heel_off, tip, toe_off = (record.rhythms[leg][name] for name in RHYTHM)
        breaches |= {
            "heel_end after heel_off" + _of(record, leg): heel_end - heel_off,
            "heel_off after toe_tip_start" + _of(record, leg): heel_off - tip,
            "toe_tip_start after toe_off" + _of(record, leg): tip - toe_off,
            "toe-off of the other leg after heel_off" + _of(record, leg): (
                _other_toe_off(record, leg) - heel_off
            ),
        }
    if record.each_leg:
        both = sum(rhythm["toe_tip_start"] for rhythm in record.rhythms)
        breaches["heel contacts of both legs"] = abs(both - 1.0)
    lines = [residuals.RHYTHM_ORDER.judged(_greatest(breaches)), _asked_line(record)]
    return lines + ([_steps_line(record)] if record.each_leg else [])


def _own_legs(record: Record) -> tuple[int, ...]:
    """The legs that have a rhythm of their own."""
    return (0, 1) if record.each_leg else (0,)


def _of(record: Record, leg: int) -> str:
    return f", leg {leg + 1}" if record.each_leg else ""


def _other_toe_off(record: Record, leg: int) -> float:
    """Toe-off of the other leg after the heel contact of this one, which came later."""
    own, other = record.rhythms[leg], record.rhythms[1 - leg]
    return other["toe_off"] - (1.0 - own["toe_tip_start"] if record.each_leg else 0.5)


def _asked_line(record: Record) -> AuditLine:
    breaches: dict[str, float] = {}
    for leg in _own_legs(record):
        asked = record.leg_table("rhythm", leg)
        for name in ("heel_end", "heel_off", "toe_off"):
            bounds = _bounds(asked.get(name))
            if bounds is None:
                return residuals.RHYTHM_AS_ASKED.cannot_be_judged(NOT_STATED.format(name))
            value = record.rhythms[leg][name]
            breaches[name + _of(record, leg)] = max(bounds[0] - value, value - bounds[1])
        early = record.rhythms[leg]["heel_end"] - _other_toe_off(record, leg)
        orders = {"toe-off-first": -early, "flat-first": early, "best": 0.0}
        order = str(asked.get("order"))
        if order not in orders:
            return residuals.RHYTHM_AS_ASKED.cannot_be_judged(NOT_STATED.format("order"))
        breaches["order" + _of(record, leg)] = orders[order]
    return residuals.RHYTHM_AS_ASKED.judged(_greatest(breaches))


def _steps_line(record: Record) -> AuditLine:
    """Length and time of the two steps against each other and against the problem."""
    first, second = record.step_lengths
    time = 1.0 - 2 * record.rhythm["toe_tip_start"]  # T_1 less T_2, over T
    found = {
        "step_length_asymmetry": (first - second) / (first + second),
        "step_time_asymmetry": time,
    }
    breaches = {"step_lengths": abs(first + second - 2 * record.step_length) / record.step_length}
    for name, value in found.items():
        bounds = _bounds(record.table("stride").get(name))
        if bounds is None:
            note = f"the stored problem does not state stride.{name}"
            return residuals.STEPS_AS_ASKED.cannot_be_judged(note)
        breaches[name] = max(bounds[0] - value, value - bounds[1])
    note = f"asymmetry of length {found['step_length_asymmetry']:+.4f}, of time {time:+.4f}"
    return residuals.STEPS_AS_ASKED.judged(_greatest(breaches), note)


def _bounds(asked: object) -> tuple[float, float] | None:
    """Lower and upper bound that a number or a pair asks for."""
    pair = [as_number(x) for x in (asked if isinstance(asked, list) else [asked, asked])]
    return (pair[0], pair[1]) if len(pair) == 2 and np.all(np.isfinite(pair)) else None


def _greatest(breaches: dict[str, float]) -> Worst:
    name = max(breaches, key=lambda k: breaches[k])
    return Worst(breaches[name], name) if breaches[name] > 0 else Worst(0.0, "")
