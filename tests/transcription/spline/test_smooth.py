"""The programme without corners: the same walk, the same energy, exact derivatives, an optimum."""

from __future__ import annotations

from functools import cache

import casadi as ca
import numpy as np
import pytest

from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem import DoubleSupport
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.transcription.spline.curves import EXTRAS
from ergowalk.transcription.spline.rows import Asked
from ergowalk.transcription.spline.smooth import SmoothProgramme

from .walks import programme, unknowns

CASES = [
    (PhaseOrder.TOE_OFF_FIRST, DoubleSupport.OPTIMAL, Asked.EVERYTHING),
    (PhaseOrder.TOE_OFF_FIRST, DoubleSupport.LINEAR, Asked.PAPER),
    (PhaseOrder.FLAT_FIRST, DoubleSupport.OPTIMAL, Asked.PAPER),
    (PhaseOrder.FLAT_FIRST, DoubleSupport.LINEAR, Asked.EVERYTHING),
]
IDENTITIES = {"power slacks", "closure (2)-(7)", "sharing (12)", "splines (13)", "moments"}


@cache
def smooth(order: PhaseOrder, sharing: DoubleSupport, asked: Asked) -> SmoothProgramme:
    extras = EXTRAS if asked is Asked.EVERYTHING else ()
    return SmoothProgramme(programme(order, sharing, extras), asked)


@pytest.mark.parametrize(("order", "sharing", "asked"), CASES)
def test_a_walk_satisfies_every_identity_and_costs_its_energy(
    order: PhaseOrder, sharing: DoubleSupport, asked: Asked
) -> None:
    s = smooth(order, sharing, asked)
    c = unknowns(s.spline.size, 1, 1e-3)
    x = s.pack(c)
    np.testing.assert_allclose(s.unpack(x), c, atol=1e-14)
    violations = s.programme.violations(x)
    broken = {name: v for name, v in violations.items() if name in IDENTITIES}
    assert set(broken) >= IDENTITIES - {"moments"} and max(broken.values()) < 1e-10
    cost = float(s.programme.oracle.values(x, [])[0])
    if asked is Asked.PAPER:
        assert s.energy(cost) == pytest.approx(s.spline.value(c)[0], rel=1e-12)
    else:  # with the small cost of the swing foot
        assert s.spline.value(c)[0] < s.energy(cost) < 1.02 * s.spline.value(c)[0]


@pytest.mark.parametrize(("order", "sharing", "asked"), CASES)
def test_first_and_second_derivatives_agree_with_differences(
    order: PhaseOrder, sharing: DoubleSupport, asked: Asked
) -> None:
    s = smooth(order, sharing, asked)
    oracle, rng = s.programme.oracle, np.random.default_rng(2)
    x = s.pack(unknowns(s.spline.size, 3, 1e-3))
    line = rng.standard_normal(len(x))
    multipliers = rng.standard_normal(len(s.programme.labels))
    h = 1e-6

    def lagrangian_gradient(at: np.ndarray) -> np.ndarray:
        gradient = np.asarray(oracle.gradient(at, [])[1]).ravel()
        jacobian = oracle.jacobian(at, [])[1]
        return gradient + np.asarray(jacobian.T @ ca.DM(multipliers)).ravel()

    ahead, behind = (oracle.values(x + d * h * line, []) for d in (1, -1))
    slope = (np.asarray(ahead[1]) - np.asarray(behind[1])).ravel() / (2 * h)
    exact = np.asarray(oracle.jacobian(x, [])[1] @ ca.DM(line)).ravel()
    np.testing.assert_allclose(slope, exact, rtol=1e-5, atol=1e-5 * np.abs(exact).max())
    change = lagrangian_gradient(x + h * line) - lagrangian_gradient(x - h * line)
    triangle = oracle.hessian(x, [], 1.0, multipliers)
    hessian = triangle + triangle.T - ca.diag(ca.diag(triangle))
    product = np.asarray(hessian @ ca.DM(line)).ravel()
    np.testing.assert_allclose(
        change / (2 * h), product, rtol=1e-4, atol=1e-5 * np.abs(product).max()
    )


def test_the_optimum_obeys_19_and_costs_less() -> None:
    """IPOPT from the human start: every measure below its tolerance, the energy far lower."""
    s = smooth(PhaseOrder.TOE_OFF_FIRST, DoubleSupport.OPTIMAL, Asked.PAPER)
    start = s.spline.initial()
    solver = Ipopt(
        tolerance=1e-5, strategy="monotone", barrier_start=1e-2, push=1e-3, max_iterations=500
    )
    minimum = solver.minimise(s.programme, s.pack(start))
    assert minimum.converged, minimum.message
    energy, measures = s.spline.value(s.unpack(minimum.x))
    assert np.all(measures <= s.spline.tolerances())
    assert np.any(s.spline.value(start)[1] > s.spline.tolerances())
    assert energy == pytest.approx(s.energy(minimum.objective), rel=0.01)
    assert energy < 0.8 * s.spline.value(start)[0]
