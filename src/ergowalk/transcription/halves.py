"""A stride as halves: one that mirrors itself, or two, in which the legs change their roles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ergowalk.gait.rhythm import BOUNDARIES, Phase, PhaseOrder, half_stride_phases
from ergowalk.problem import GaitProblem
from ergowalk.transcription.curves import PhaseCurves, Trajectory
from ergowalk.transcription.layout import Mesh
from ergowalk.transcription.mesh import walking_mesh
from ergowalk.transcription.phases import Join, Link, PhasedProblem, PhaseModel, TimeRow
from ergowalk.transcription.steps import UnequalSteps
from ergowalk.transcription.walker import Smoothing, Walker

Orders = tuple[PhaseOrder, ...]
"""Order of the phases of each half that is solved."""

TAGS = ("", " 2")
"""What is appended to the names of the boundaries and phases of each half."""


@dataclass(frozen=True)
class Half:
    """Half a stride: the walker with its legs in their roles, the leading one first.

    Its clock starts as the leading heel meets the ground; ``tag`` tells its boundaries from those
    of the other half.
    """

    walker: Walker
    order: PhaseOrder
    tag: str = ""

    @property
    def phases(self) -> tuple[Phase, ...]:
        """Its phases in time order, boundaries under their plain names."""
        return half_stride_phases(self.order)

    def times(self, times: Mapping[str, float]) -> dict[str, float]:
        """Its own boundary instants [s] under their plain names."""
        return {name: times[name + self.tag] for name in BOUNDARIES}


def halves_of(problem: GaitProblem, orders: Orders, smoothing: Smoothing) -> tuple[Half, ...]:
    """The halves of a stride: one where the legs mirror each other."""
    if not problem.full_stride:
        return (Half(Walker(problem, smoothing), orders[0]),)
    length = 2 * problem.step_length_m
    low, high = problem.stride.bounds("length")
    step_1 = (length * (1 + low) / 2, length * (1 + high) / 2)
    walkers = []
    for i, lasts in enumerate(_durations(problem)):
        steps = UnequalSteps(i, length, step_1, lasts, "half_stride" + TAGS[1 - i])
        walkers.append(Walker(problem, smoothing, steps))
    return tuple(Half(w, o, t) for w, o, t in zip(walkers, orders, TAGS, strict=True))


def _durations(problem: GaitProblem) -> tuple[tuple[float, float], ...]:
    """Bounds [s] of the duration of both halves; a half lasts as long as the step that ends it."""
    low, high = problem.stride.bounds("time")
    half = problem.stride_time_s / 2
    return (half * (1 - high), half * (1 - low)), (half * (1 + low), half * (1 + high))


def times_twice(times: Mapping[str, float]) -> dict[str, float]:
    """Boundary instants of legs that mirror each other, as those of both halves."""
    return {name + tag: t for tag in TAGS for name, t in times.items()}


def in_phases(
    halves: Sequence[Half], trajectory: Trajectory
) -> Iterator[tuple[Half, Walker, Phase, PhaseCurves]]:
    """Every phase with its curves and the walker that has the steps of the trajectory."""
    given = {**trajectory.times, **trajectory.shared}
    curves = iter(trajectory.phases)
    for half in halves:
        walker = half.walker.at(given)
        for phase in half.phases:
            yield half, walker, phase, next(curves)


def mesh_of(
    halves: Sequence[Half], times: Mapping[str, float], stride: float, level: float
) -> Mesh:
    """The graded mesh of all halves for boundary instants [s]."""
    parts = [walking_mesh(h.order, h.times(times), stride, level) for h in halves]
    return tuple(fractions for part in parts for fractions in part)


def joined(problem: GaitProblem, chains: Sequence[PhasedProblem]) -> PhasedProblem:
    """Both halves of a stride as one problem; a half that mirrors itself stays as it is.

    The exchange that each chain asks for at its end is with the start of the other.
    """
    if len(chains) == 1:
        return chains[0]
    first, second = (
        _tagged(chain, tag, other)
        for chain, tag, other in zip(chains, TAGS, TAGS[::-1], strict=True)
    )
    stride, ends = problem.stride_time_s, tuple("half_stride" + tag for tag in TAGS)
    rows = [("stride time", dict.fromkeys(ends, 1.0), stride, stride)]
    for leg, tag, end in zip((1, 0), TAGS, ends[::-1], strict=True):
        # the trailing leg met the ground as long before as the other half lasts
        low, high = problem.rhythm_of(leg).bounds("toe_off")
        row = {"other_toe_off" + tag: 1.0, end: 1.0}
        rows.append(("toe-off", row, low * stride, high * stride))
    return replace(
        first,
        phases=first.phases + second.phases,
        times={**first.times, **second.times},
        time_rows=(*first.time_rows, *second.time_rows, *rows),
        joins=first.joins + second.joins,
        fixed={**first.fixed, **second.fixed},
        links=first.links + second.links,
    )


def _tagged(chain: PhasedProblem, tag: str, other: str) -> PhasedProblem:
    """The chain of one half with its own names for phases, boundaries and links."""

    def phase(model: PhaseModel) -> PhaseModel:
        name, start, end = (part + tag for part in (model.name, model.start, model.end))
        return replace(model, name=name, start=start, end=end)

    def link(given: Link) -> Link:
        return replace(given, name=given.name + tag, boundary=given.boundary + tag)

    def row(given: TimeRow) -> TimeRow:
        label, factors, low, high = given
        return label, {name + tag: f for name, f in factors.items()}, low, high

    return replace(
        chain,
        phases=tuple(phase(model) for model in chain.phases),
        times={name + tag: bounds for name, bounds in chain.times.items()},
        time_rows=tuple(row(given) for given in chain.time_rows),
        joins=tuple(Join(j.end + tag, j.start + other, j.names) for j in chain.joins),
        fixed={(edge + tag, n, kind): x for (edge, n, kind), x in chain.fixed.items()},
        links=tuple(link(given) for given in chain.links),
    )
