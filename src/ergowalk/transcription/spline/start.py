"""z-bar of (16): human mean curves, moved until the equality constraints can hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ergowalk.mechanics.kinematics import HALF_PI
from ergowalk.transcription.spline.curves import (
    FOOT_HEEL,
    FOOT_RISE,
    KNEE,
    SWING_FOOT,
    THIGH_SWING,
    THIGH_TOE,
    TRUNK,
    Curves,
)

if TYPE_CHECKING:
    from ergowalk.transcription.spline.programme import SplineProgramme
    from ergowalk.transcription.spline.semi_inverse import Instant

Array = NDArray[np.float64]

OUTSIDE, MISSING, GROUND, LOAD, PRESSURE = 3.0, 200.0, 100.0, 20.0, 5.0
"""Weights of the fit, per standard deviation outside a corridor, metre out of reach, metre below
the ground, body weight of pull, metre of pressure astray."""

ROUGH, POWER = 2e-3, 0.3
"""The same per rad/s2 or m/s2 of acceleration and per W/kg of joint power: mean curves measured
on other people, with knots this sparse, would ask for absurd forces."""

FEW, SAMPLES = 12, 8
"""Intervals of the first fit; samples per knot where curves are carried to other knots."""

STEPS = 60
"""Evaluations of the fit: it need not be the best start, only a possible one."""


def human_data(programme: SplineProgramme) -> Array:
    """Data of all splines from the human mean curves, trunk upright, hip at its mean speed."""
    curves, problem = programme.curves, programme.problem
    stride, leg = problem.stride_time_s, problem.body.leg(0)
    human = {joint: corridor.mean for joint, corridor in problem.angle_corridors().items()}
    data = np.zeros(curves.size)

    def fill(name: str, later: float, angle) -> None:  # type: ignore[no-untyped-def]
        curve = curves.all[name]
        s = curve.spline.knots / stride + later
        count = curve.spline.parameters - (2 if name not in (KNEE, TRUNK) else 0)
        data[curve.first : curve.first + count] = angle(s[:count], 0)
        if name != KNEE:
            ends = angle(s[[0, -1]], 1) / stride
            data[[curve.index(-2), curve.index(-1)]] = ends

    def foot(s: Array, d: int) -> Array:
        level = HALF_PI - leg.foot_angle if d == 0 else 0.0
        total = human["ankle"](s, d) + human["hip"](s, d) - human["knee"](s, d)
        return np.asarray(total + level)

    fill(KNEE, 0.0, human["knee"])
    fill(FOOT_HEEL, 0.0, foot)
    fill(FOOT_RISE, 0.0, foot)
    fill(THIGH_TOE, 0.5, human["hip"])
    fill(THIGH_SWING, 0.5, human["hip"])
    data[curves.all[SWING_FOOT].first : curves.psi] = 0.0
    return data


def carried_over(data: Array, coarse: Curves, fine: Curves) -> Array:
    """Data on other knots or another rho for nearly the same curves, by least squares."""
    found = np.zeros(fine.size)
    found[fine.psi] = data[coarse.psi]
    for name, curve in fine.all.items():
        old, new = coarse.all[name].spline, curve.spline
        first, last = float(new.knots[0]), float(new.knots[-1])
        t = np.linspace(first, last, SAMPLES * len(new.knots))
        speed = (last - first) / len(new.knots)  # values and rates in one unit
        own, there = coarse.all[name].first, curve.first
        values = [speed**d * old(t, data[own : own + old.parameters], d) for d in (0, 1)]
        rows = [speed**d * new.matrix(t, d) for d in (0, 1)]
        answer = np.linalg.lstsq(np.concatenate(rows), np.concatenate(values), rcond=None)[0]
        found[there : there + new.parameters] = answer
    return found


def fitted(programme: SplineProgramme) -> Array:
    """The start: least squares of the distance from the human means, of what breaks (4)-(9), of
    accelerations and of powers, over the unknowns, the slope at landing and the swing foot.

    Many knots start from the fit on fewer.
    """
    from ergowalk.transcription.spline.programme import SplineProgramme

    curves = programme.curves
    intervals = len(curves.grid) - 1
    if intervals <= FEW:
        start = human_data(programme)
    else:
        few = SplineProgramme(programme.problem, programme.rhythm, FEW, programme.rho)
        start = carried_over(few.start, few.curves, curves)
    extras = ("heel_slope", "swing_foot")
    free = SplineProgramme(
        programme.problem, programme.rhythm, intervals, programme.rho, extras, start
    )
    sampler, unknowns = free.sampler, ca.MX.sym("C", free.size)
    data, missing = free.settled(unknowns)
    shared = sampler.shared(data)
    parts = [MISSING * missing]
    for instant, grid in zip(sampler.instants, sampler.gauss(2), strict=True):
        samples = sampler.mapped(instant, grid, residuals, data, shared)
        scale = np.sqrt(grid.weights / free.curves.half)
        parts.append(ca.vec(samples @ ca.diag(ca.DM(scale))))
    residual = ca.vertcat(*parts)
    function = ca.Function("residual", [unknowns], [residual])
    jacobian = ca.Function("jacobian", [unknowns], [ca.jacobian(residual, unknowns)])
    found = least_squares(
        lambda c: function(c).full().ravel(),
        np.zeros(free.size),
        lambda c: jacobian(c).full(),
        max_nfev=STEPS,
    )
    return free.data(found.x)


def residuals(instant: Instant) -> list[ca.SX]:
    """What the fit squares at an instant."""
    found: list[ca.SX] = []
    for i, angle in enumerate(instant.angles):
        low, high = instant.known[i], instant.known[6 + i]
        place = (2 * angle - low - high) / (high - low)
        found += [place, OUTSIDE * (ca.fmax(0.0, place - 0.9) + ca.fmax(0.0, -0.9 - place))]
    found.append(MISSING * instant.missing)
    heights = [p.position[1] for q in instant.points for p in (q.heel, q.toe_tip)]
    found += [GROUND * ca.fmax(0.0, -y) for y in heights]
    for force in instant.forces.reactions:
        found.append(LOAD * ca.fmax(0.0, -force[1]) / instant.weight)
    found += [ROUGH * jet.acceleration for jet in instant.jets.values()]
    found += [POWER * power / instant.problem.body.total_mass for power in instant.powers]
    found.append(instant.motion.trunk.angle)
    heel, tip = instant.prints[0].heel, instant.prints[0].toe_tip
    astray = ca.fmax(0.0, heel - instant.pressure) + ca.fmax(0.0, instant.pressure - tip)
    found.append(PRESSURE * astray)
    return found
