"""Problem A as a phased problem: minimal coordinates, one contact chain from the standing foot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ergowalk.gait.rhythm import BOUNDARIES, Contact, Phase, PhaseOrder, half_stride_phases
from ergowalk.problem import JOINTS, GaitProblem
from ergowalk.problem import constraints as c
from ergowalk.transcription.design import flat_foot_links, frees_foot_angle, mass_factor
from ergowalk.transcription.device_links import device_links, fixed_moments
from ergowalk.transcription.halves import Orders, halves_of, joined
from ergowalk.transcription.phases import Instant, Join, Link, PhasedProblem, PhaseModel, Terms
from ergowalk.transcription.unknowns import algebraics, controls, coordinates
from ergowalk.transcription.walker import SHARING, Smoothing, Walker

FIT_ROUGHNESS = 1e-4
"""Weight of squared accelerations in the kinematic fit, against squared corridor positions."""


def walking_problem(
    problem: GaitProblem, orders: Orders, smoothing: Smoothing | None = None
) -> PhasedProblem:
    """Problem A in phases, over as many halves of the stride as there are phase orders.

    Coordinates: trunk, thighs, shanks, the leading foot unless flat, the trailing foot in swing.
    The hip follows from the contact of leg 1, so (4) holds by construction there. Controls are
    moments per kg.
    """
    halves = halves_of(problem, orders, smoothing or Smoothing())
    return joined(problem, [_half(half.walker, half.order) for half in halves])


def _half(walker: Walker, order: PhaseOrder) -> PhasedProblem:
    problem = walker.problem

    def model(phase: Phase) -> PhaseModel:
        def inside(instant: Instant) -> Terms:
            at = walker.at(instant.shared)
            motion = at.motion(phase, instant)
            terms = at.dynamics_rows(phase, instant, motion)
            terms.rows += at.friction_rows(phase, instant).rows
            terms.rows += at.pressure_rows(phase, instant, motion, at.reactions(instant)).rows
            return terms

        def path(instant: Instant) -> Terms:
            at = walker.at(instant.shared)
            motion = at.motion(phase, instant)
            terms = at.corridor_rows(phase, instant, motion)
            terms.rows += at.clearance_rows(phase, instant, motion).rows
            return terms

        def at_ends(instant: Instant) -> Terms:
            at = walker.at(instant.shared)
            return at.load_rows(phase, instant, at.motion(phase, instant))

        return PhaseModel(
            phase.name,
            phase.start,
            phase.end,
            coordinates(walker, phase),
            controls(walker, phase),
            algebraics(walker, phase),
            1.0,
            inside,
            path,
            at_ends,
            path_everywhere=phase.legs[1] is Contact.TOE,
            curves=walker.corridor_curves,
            shared=walker.seen,
            absolute_weights=problem.objective.of_work,
            cost_factor=mass_factor(walker),
            **_rates(walker),
        )

    return _chain(walker, order, model, with_loads=True)


def kinematic_problem(problem: GaitProblem, order: PhaseOrder) -> PhasedProblem:
    """The motion of mirrored legs: nearest to the human means under all contact equations."""
    walker = Walker(problem, Smoothing())

    def model(phase: Phase) -> PhaseModel:
        def inside(instant: Instant) -> Terms:
            at = walker.at(instant.shared)
            motion = at.motion(phase, instant)
            terms = Terms()
            places = at.corridor_places(phase, instant, motion)
            terms.integrand = sum(place**2 for _, place in places)
            if phase.legs[1] is Contact.TOE:
                at.toe_contact_rows(terms, at.points(motion)[1])
            for state in instant.coordinates.values():
                terms.integrand = terms.integrand + FIT_ROUGHNESS * state.acceleration**2
            return terms

        def path(instant: Instant) -> Terms:
            at = walker.at(instant.shared)
            return at.clearance_rows(phase, instant, at.motion(phase, instant))

        def nothing(instant: Instant) -> Terms:
            return Terms()

        loads = ("reaction", "lock")
        kept = tuple(z for z in algebraics(walker, phase) if not z.name.startswith(loads))
        return PhaseModel(
            "fit_" + phase.name,
            phase.start,
            phase.end,
            tuple(
                q
                for q in coordinates(walker, phase)
                if q.name not in SHARING and not q.name.startswith("slip")
            ),
            (),
            kept,
            1.0,
            inside,
            path,
            nothing,
            curves=walker.corridor_curves,
            shared=walker.seen,
        )

    return _chain(walker, order, model, with_loads=False)


def _chain(
    walker: Walker, order: PhaseOrder, model: Callable[[Phase], PhaseModel], *, with_loads: bool
) -> PhasedProblem:
    """Phases, boundary times, exchange of legs and links of the half stride."""
    problem = walker.problem
    phases = half_stride_phases(order)
    models = tuple(model(phase) for phase in phases)
    names = {x.name for m in models for x in m.coordinates}
    names |= {x.name for m in models for x in m.controls}
    # Leg 1 stands on a known foot at t = 0 and so does leg 2 half a stride before: the trailing
    # foot's angle at 0 follows from the contact and is not an unknown there.
    own = {"foot_1", *SHARING}
    if walker.limits[0].moment_rate_nm_per_kg_s.of("metatarsal") is None:
        own.add("metatarsal_1")  # free to jump when the load passes to the toe tip
    exchange = c.eq2_exchange(tuple(sorted(names - own)))
    fixed = {
        key: value
        for key, value in c.fixed_at_boundaries(walker.flat).items()
        if key[2] != "control"
    }
    flat = [k for k in fixed if k[2] == "value"] if frees_foot_angle(problem) else []
    fixed = {key: value for key, value in fixed.items() if key not in flat}
    if with_loads:
        fixed |= fixed_moments(walker, phases)
    if walker.linear_sharing and with_loads:
        fixed |= {("other_toe_off", n, "value"): 0.0 for n in SHARING}
    at_toe_off = next(p.legs[0] for p in phases if p.end == "other_toe_off")
    shortest = c.SHORTEST_PHASE * problem.stride_time_s
    return PhasedProblem(
        phases=models,
        times=_time_bounds(walker),
        time_rows=tuple(
            ("rhythm (3)", {later: 1.0, earlier: -1.0}, shortest, np.inf)
            for earlier, later in c.eq3_rhythm_order(order)
        ),
        joins=(Join("half_stride", "heel_contact", exchange),),
        fixed=fixed,
        links=(
            Link("toe_off", "other_toe_off", lambda t: walker.at(t.shared).toe_off(at_toe_off, t)),
            Link("landing", "half_stride", lambda t: walker.at(t.shared).landing(t)),
            *flat_foot_links(walker, (boundary for boundary, _, _ in flat)),
            *(device_links(walker, phases) if with_loads else ()),
        ),
        shared=walker.shared,
    )


def _rates(walker: Walker) -> dict[str, Any]:
    """Bounds and costs of the rates of the walker's own moments, by name."""
    names = [(j, i) for j in JOINTS for i in (1, 2)]
    rates = {f"{j}_{i}": walker.limits[i - 1].moment_rate_nm_per_kg_s.of(j) for j, i in names}
    small, price = walker.small, walker.problem.objective.moment_rate_squared_s3_per_m2
    cost = dict.fromkeys(JOINTS, price + small.moment_rate)
    cost["metatarsal"] = price + small.metatarsal_rate
    return {
        "control_rates": {n: r for n, r in rates.items() if r is not None},
        "control_rate_cost": {f"{j}_{i}": cost[j] for j, i in names},
    }


def _time_bounds(walker: Walker) -> Mapping[str, tuple[float, float]]:
    """Bounds of the boundary instants [s]; those of unequal legs depend on each other too."""
    stride, rhythm = walker.problem.stride_time_s, walker.problem.rhythm_of(0)
    if walker.unequal is None:
        toe_off, end = rhythm.bounds("toe_off"), (0.5, 0.5)
        leaves = (toe_off[0] - 0.5, toe_off[1] - 0.5)
    else:
        low, high = walker.unequal.duration
        end, leaves = (low / stride, high / stride), (0.0, high / stride)
    fractions = {
        "heel_contact": (0.0, 0.0),
        "heel_end": rhythm.bounds("heel_end"),
        "other_toe_off": leaves,
        "heel_off": rhythm.bounds("heel_off"),
        "half_stride": end,
    }
    return {n: (fractions[n][0] * stride, fractions[n][1] * stride) for n in BOUNDARIES}
