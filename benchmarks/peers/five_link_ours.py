"""The five-link walker through ergowalk's transcription, which knows phases and not walking.

Rows of ergowalk belong to one instant, and heel strike relates the end of a step to the start of
the next. So a second phase of no mechanics follows the step: its coordinates are the links as the
next step counts them, without acceleration. At its start they obey the heel strike together with
the step's last instant, and at its end they are the very unknowns with which the step began.
"""

from __future__ import annotations

import casadi as ca
import five_link as walker
import numpy as np
import peer

import ergowalk
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Guess, Samples
from ergowalk.transcription.phases import (
    Coordinate,
    Instant,
    InstantFunction,
    Join,
    Link,
    PhasedProblem,
    PhaseModel,
    Terms,
    Unknown,
)

POINTS = 3
N = walker.LINKS
LINK = [f"link_{i}" for i in range(N)]
NEXT = [f"next_{i}" for i in range(N)]
MOMENT = [f"moment_{i}" for i in range(N)]
RATE, ACCELERATION, TORQUE = 3.0, 30.0, 10.0
"""Typical sizes [rad/s, rad/s2, N m] by which unknowns are divided."""
PAUSE = 0.1
"""Length [s] of the phase without mechanics."""


def problem(variant: str) -> PhasedProblem:
    """One variant as a chain of phases."""
    step = _phase("step", "start", "strike", LINK, MOMENT, _mechanics)
    nothing = {"time_rows": ()}
    times = {"start": (0.0, 0.0), "strike": (walker.STEP_TIME, walker.STEP_TIME)}
    if variant == "posture":
        fixed = {}
        for edge, state in (("start", walker.START_STATE), ("strike", walker.END_STATE)):
            for kind, numbers in zip(("value", "rate"), state, strict=True):
                fixed |= {(edge, n, kind): x for n, x in zip(LINK, numbers, strict=True)}
        return PhasedProblem((step,), times, joins=(), fixed=fixed, links=(), **nothing)
    pause = _phase("pause", "strike", "end", NEXT, [], _no_acceleration)
    end = walker.STEP_TIME + PAUSE
    return PhasedProblem(
        (step, pause),
        times | {"end": (end, end)},
        joins=(Join("end", "start", dict(zip(NEXT, LINK, strict=True))),),
        fixed={},
        links=(Link("heel_strike", "strike", _strike),),
        **nothing,
    )


def _phase(
    name: str,
    start: str,
    end: str,
    coordinates: list[str],
    controls: list[str],
    inside: InstantFunction,
) -> PhaseModel:
    def none(instant: Instant) -> Terms:
        return Terms()

    return PhaseModel(
        name,
        start,
        end,
        tuple(Coordinate(n, rate_scale=RATE, acceleration_scale=ACCELERATION) for n in coordinates),
        tuple(Unknown(n, scale=TORQUE) for n in controls),
        (),
        1.0,
        inside,
        none,
        none,
    )


def _mechanics(instant: Instant) -> Terms:
    """Equations of motion, in units of a typical moment, and the effort."""
    terms, links = Terms(), [instant.coordinates[n] for n in LINK]
    u = [instant.controls[n] for n in MOMENT]
    rows = walker.equations(
        [x.value for x in links],
        [x.rate for x in links],
        [x.acceleration for x in links],
        u,
        ca.sin,
        ca.cos,
    )
    terms.equal("equations of motion", *(row / TORQUE for row in rows))
    terms.integrand = sum(x**2 for x in u) / walker.EFFORT_SCALE
    return terms


def _no_acceleration(instant: Instant) -> Terms:
    """The links of the next step move on without force."""
    terms = Terms()
    terms.equal("pause", *(instant.coordinates[n].acceleration / ACCELERATION for n in NEXT))
    return terms


def _strike(instant: Instant) -> Terms:
    """Exchange of the legs, heel strike and step length."""
    terms = Terms()
    now, after = ([instant.coordinates[n] for n in names] for names in (LINK, NEXT))
    q, before = [x.value for x in now], [x.rate for x in now]
    start = [x.value + PAUSE * x.rate for x in after]  # with which the pause ends
    terms.equal("exchange", *(start[i] - q[N - 1 - i] for i in range(N)))
    momenta = walker.strike(q, before, [x.rate for x in after], ca.cos)
    terms.equal("heel strike", *momenta)
    forward, up = walker.foot(q, ca.sin, ca.cos)
    terms.equal("step length", forward - walker.STEP_LENGTH, up)
    return terms


def build(variant: str, elements: int) -> peer.Solver:
    """The programme of one variant on equal elements, as a function of the starting guess."""
    posed = problem(variant)
    mesh = [np.linspace(0.0, 1.0, elements + 1)]
    if variant == "impact":
        mesh.append(np.array([0.0, 1.0]))
    collocation = Collocation(posed, tuple(mesh), POINTS)
    programme = collocation.programme
    _ = programme.oracle.hessian  # made when first asked for: part of the build, not of a solve
    times = {name: low for name, (low, _) in posed.times.items()}
    solver = Ipopt(tolerance=1e-9, max_iterations=500)

    def solve(start: walker.Start) -> peer.Outcome:
        found = solver.minimise(programme, collocation.pack(_guess(start), times))
        return peer.Outcome(
            found.objective * walker.EFFORT_SCALE, found.converged, found.iterations, found.message
        )

    return solve


def _guess(start: walker.Start) -> Guess:
    """A start as curves of both phases."""

    def guess(phase: int, fractions: np.ndarray) -> Samples:
        if phase == 1:
            first = np.zeros(1)
            rate = np.repeat(start.rates(first), len(fractions), axis=0)
            angle = start.angles(first) - PAUSE * (1 - fractions)[:, None] * rate
            return Samples(_named(NEXT, angle), _named(NEXT, rate), _named(NEXT, 0 * rate), {}, {})
        t = walker.STEP_TIME * fractions
        return Samples(
            _named(LINK, start.angles(t)),
            _named(LINK, start.rates(t)),
            _named(LINK, start.accelerations(t)),
            _named(MOMENT, start.controls(t)),
            {},
        )

    return guess


def _named(names: list[str], columns: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip(names, columns.T, strict=True))


if __name__ == "__main__":
    peer.main(
        f"ergowalk {ergowalk.__version__}, CasADi {ca.__version__}",
        "{n} elements of " + f"{POINTS} Gauss points",
        build,
        fine=20,
    )
