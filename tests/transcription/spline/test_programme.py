"""Energy, measures and derivatives of the programme (18), (19)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.errors import ProblemError
from ergowalk.gait.loads import Loads, inverse_dynamics
from ergowalk.gait.rhythm import Contact, PhaseOrder
from ergowalk.problem import DoubleSupport
from ergowalk.problem.objective import eq10_joint_powers
from ergowalk.transcription.spline.curves import knot_grid
from ergowalk.transcription.spline.jets import Jet, arctan2, capped, floored
from ergowalk.transcription.spline.programme import MotionPiece, SplineProgramme
from ergowalk.transcription.spline.start import carried_over

from .walks import RHYTHMS, problem, programme, unknowns

BOTH = [
    pytest.param(order, sharing, id=f"{order}-{sharing}")
    for order in PhaseOrder
    for sharing in DoubleSupport
]


def loads(p: SplineProgramme, piece: MotionPiece) -> Loads:
    return inverse_dynamics(p.problem.body, piece.motion, piece.contacts, piece.sharing)


def powers(p: SplineProgramme, piece: MotionPiece) -> np.ndarray:
    found, motion = loads(p, piece), piece.motion
    return np.stack(
        [
            x
            for i in (0, 1)
            for x in eq10_joint_powers(found.moments[i], motion.trunk, motion.legs[i])
        ]
    )


def test_the_unknowns_are_those_of_18() -> None:
    """psi_0; C_1 ... C_{n-1} of every function; both ends of gamma; C_0 of both knees."""
    p = programme()
    n = len(p.curves.grid) - 1
    inner = {name: p.curves.all[name].knots - 1 for name in p.curves.all}
    expected = 1 + 2 * (inner["hip"])  # psi_0, x, x_g
    expected += 2 * (n - 1) + 2  # mu_1^k and mu_2^k
    expected += inner["foot_heel"] + inner["foot_rise"] + 2  # gamma_1 with C_0 and C_n
    expected += inner["thigh_toe"] + inner["thigh_swing"]  # alpha_2
    assert p.size == len(p.names) == len(set(p.names)) == expected
    assert {"psi[0]", "knee[0]", f"knee[{n}]", "foot_heel[0]"} <= set(p.names)
    assert f"foot_rise[{inner['foot_rise'] + 1}]" in p.names
    assert not {"hip[0]", "trunk[0]", "thigh_toe[0]"} & set(p.names)


def test_every_unknown_moves_the_walk() -> None:
    p = programme()
    jacobian = p.jacobian(unknowns(p.size, 5, 1e-3))
    assert np.abs(jacobian[0]).min() > 0


@pytest.mark.parametrize(("order", "sharing"), BOTH)
def test_energy_is_the_dense_integral_of_absolute_power(
    order: PhaseOrder, sharing: DoubleSupport
) -> None:
    """|power| has corners, so Gauss points between knots leave a percent or two."""
    p = programme(order, sharing)
    c = unknowns(p.size, 1, 1e-3)
    total = sum(
        np.trapezoid(np.abs(powers(p, piece)).sum(axis=0), piece.time)
        for piece in p.pieces(c, longest=1e-4)
    )
    assert p.value(c)[0] == pytest.approx(total / p.problem.step_length_m, rel=0.02)


@pytest.mark.parametrize(("order", "sharing"), BOTH)
def test_joints_without_work_carry_none(order: PhaseOrder, sharing: DoubleSupport) -> None:
    """The powers left out of E are zero: no moment in swing, no toe rotation before heel-off."""
    p = programme(order, sharing)
    for piece in p.pieces(unknowns(p.size, 2, 1e-3)):
        found = powers(p, piece)
        if piece.contacts[0] in (Contact.HEEL, Contact.FLAT):
            assert np.abs(found[3]).max() < 1e-7
        if piece.contacts[1] is Contact.SWING:
            assert np.abs(found[6:]).max() < 1e-7


@pytest.mark.parametrize(("order", "sharing"), BOTH)
def test_double_support_is_closed_as_in_12(order: PhaseOrder, sharing: DoubleSupport) -> None:
    """R_2x runs linearly from R_1x(T/2) to zero; x_R2 rests or runs linearly to the toe tip;
    the leading heel carries its load at the heel."""
    p = programme(order, sharing)
    pieces = p.pieces(unknowns(p.size, 3, 1e-3))
    last, toe_off = loads(p, pieces[-1]), p.curves.times["other_toe_off"]
    step, tip = p.problem.step_length_m, -p.problem.step_length_m + 0.3
    start = tip
    if sharing is DoubleSupport.LINEAR:  # as far as the load of leg 1 ends within its print
        start = np.clip(last.pressures[0][-1] - step, tip - 0.1, tip)
    beyond = 1e-9 if start == tip or last.pressures[0][-1] == start + step else 0.05
    weight = p.problem.body.total_mass * 9.81
    double = [piece for piece in pieces if Contact.SWING not in piece.contacts]
    for piece in double:
        left = 1 - piece.time / toe_off
        expected = last.reactions[0][0][-1] * left
        np.testing.assert_allclose(piece.sharing.force_x, expected, atol=1e-8 * weight)
        np.testing.assert_allclose(piece.sharing.pressure, tip + (start - tip) * left, atol=beyond)
        if piece.contacts[0] is Contact.HEEL:
            found = loads(p, piece)
            moment = found.pressures[0] * found.reactions[0][1]
            assert np.abs(moment).max() < 1e-9 * weight
            np.testing.assert_allclose(
                found.reactions[1][1], piece.sharing.force_y, atol=1e-8 * weight
            )
    if order is PhaseOrder.FLAT_FIRST:
        flat = [piece for piece in double if piece.contacts[0] is Contact.FLAT]
        heel = [piece for piece in double if piece.contacts[0] is Contact.HEEL]
        assert flat[-1].sharing.force_y[-1] == pytest.approx(0.0, abs=1e-9 * weight)
        assert flat[0].sharing.force_y[0] == pytest.approx(
            heel[-1].sharing.force_y[-1], abs=1e-8 * weight
        )


@pytest.mark.parametrize(("order", "sharing"), BOTH)
def test_the_gradient_is_that_of_the_penalised_energy(
    order: PhaseOrder, sharing: DoubleSupport
) -> None:
    """Along random lines, where no corner lies between the two points of the difference."""
    p = programme(order, sharing)
    weights = np.array([100.0, 20.0, 20.0, 20.0, 100.0, 0.1, 50.0])
    rng = np.random.default_rng(7)
    c = unknowns(p.size, 4, 1e-3)
    value, gradient = p.penalised(c, weights)
    energy, measures = p.value(c)
    assert value == pytest.approx(energy + weights @ measures, rel=1e-12)
    jacobian = p.jacobian(c)
    np.testing.assert_allclose(jacobian[0] + weights @ jacobian[1:], gradient, rtol=1e-9, atol=1e-9)
    for _ in range(5):
        line = rng.standard_normal(p.size)
        h = 1e-7
        up, down = (p.penalised(c + s * h * line, weights)[0] for s in (1, -1))
        assert (up - down) / (2 * h) == pytest.approx(gradient @ line, rel=1e-4)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10**6), power=st.floats(-3, 3), order=st.sampled_from(list(PhaseOrder)))
def test_no_unknowns_are_so_wild_that_numbers_fail(
    seed: int, power: float, order: PhaseOrder
) -> None:
    p = programme(order)
    c = unknowns(p.size, seed, 10**power)
    energy, measures = p.value(c)
    value, gradient = p.penalised(c, np.ones(7))
    assert np.isfinite(energy) and np.all(np.isfinite(measures)) and np.all(measures >= 0)
    assert np.isfinite(value) and np.all(np.isfinite(gradient))


@pytest.mark.parametrize("name", ["knee[0]", "hip[4]", "trunk[4]", "thigh_toe[1]"])
def test_what_is_missing_grows_smoothly_with_the_impossibility(name: str) -> None:
    """Zero where the geometry is possible, then rising without jumps."""
    p = programme()
    c, at = p.initial(), p.names.index(name)
    sizes = np.linspace(0, 2.0, 401)
    missing = []
    for size in sizes:
        c[at] = size
        missing.append(p.value(c)[1][0])
    missing = np.array(missing)
    assert missing[0] == 0 and missing[-1] > 0
    assert np.diff(missing).max() < 20 * (missing[-1] / len(sizes))
    assert np.all(missing[-40:] > 0)


def test_a_point_of_possible_geometry_is_not_bent() -> None:
    """The repair of impossible geometry is the identity elsewhere, exactly."""
    s = np.linspace(1.0, 3.0, 7)
    assert [float(floored(x, 1.0)) for x in s] == s.tolist()
    assert [float(capped(-x, -1.0, 0.5)) for x in s] == pytest.approx((-s).tolist(), abs=1e-15)


def test_the_floor_is_twice_differentiable() -> None:
    import casadi as ca

    x = ca.SX.sym("x")
    jet, _ = Jet(x, 1.0, 0.0).floored(0.7)
    slope = ca.gradient(jet.value, x)
    curvature = ca.gradient(slope, x)
    f = ca.Function("f", [x], [jet.rate - slope, jet.acceleration - curvature, slope, curvature])
    for at in (-5.0, 0.0, 0.5, 0.7 - 1e-9, 0.7 + 1e-9, 2.0):
        rate, acceleration, one, two = (float(v) for v in f(at))
        assert rate == pytest.approx(0, abs=1e-12) and acceleration == pytest.approx(0, abs=1e-9)
        if abs(at - 0.7) < 1e-6:
            assert one == pytest.approx(1, abs=1e-7) and two == pytest.approx(0, abs=1e-7)


def test_jets_differentiate_as_casadi_does() -> None:
    import casadi as ca

    t = ca.SX.sym("t")
    a = Jet(ca.sin(t) + 2, ca.cos(t), -ca.sin(t))
    b = Jet(t**2 + 1, 2 * t, ca.SX(2))
    for jet in (a * b, a.root(), a.sin(), b.cos(), arctan2(a, b), a - b, -a + 3.0):
        rate = ca.gradient(jet.value, t)
        f = ca.Function("f", [t], [jet.rate - rate, jet.acceleration - ca.gradient(rate, t)])
        for at in (-1.0, 0.3, 2.0):
            assert [float(v) for v in f(at)] == pytest.approx([0, 0], abs=1e-12)


def test_data_and_unknowns_are_inverse() -> None:
    p = programme()
    c = unknowns(p.size, 8, 0.01)
    np.testing.assert_allclose(p.unknowns_of(p.data(c)), c, atol=1e-14)


def test_rho_changes_the_data_and_not_the_curves_within_reach() -> None:
    """(13) maps data to the same curves for any rho: a walk has data for another rho."""
    p = programme()
    q = SplineProgramme(p.problem, p.rhythm, 9, 1e-8, start=p.start)
    data = p.data(p.initial())
    other = carried_over(data, p.curves, q.curves)
    assert np.abs(other - data).max() > 1e-3
    energy = q.value(q.unknowns_of(other))[0]
    assert energy == pytest.approx(p.value(p.initial())[0], rel=1e-6)


def test_more_knots_carry_the_same_walk() -> None:
    """A smooth walk keeps its energy on more knots, the closer the more there are."""
    p = programme()
    c = p.initial()
    energy = p.value(c)[0]
    errors = []
    for intervals in (14, 28, 56):
        fine = p.on_knots(c, intervals)
        errors.append(abs(fine.value(fine.initial())[0] / energy - 1))
    assert errors[0] > errors[2] and errors[2] < 0.05


def test_every_phase_change_is_a_knot_and_long_phases_have_more() -> None:
    grid = knot_grid([0.0, 0.08, 0.1, 0.23, 0.5], 12)
    assert len(grid) == 13 and np.all(np.diff(grid) > 0)
    assert {0.0, 0.08, 0.1, 0.23, 0.5} <= set(grid.tolist())
    assert np.diff(grid).max() < 0.05


def test_too_few_knots_are_refused() -> None:
    with pytest.raises(ProblemError, match=r"intervals.*must be 4 or more.*give more knots"):
        knot_grid([0.0, 0.08, 0.1, 0.23, 0.5], 3)


def test_a_step_as_long_as_the_foot_is_refused() -> None:
    short = problem().model_copy(update={"step_length_m": 0.31})
    with pytest.raises(ProblemError, match=r"step_length_m = 0.31.*cannot share.*change the step"):
        SplineProgramme(short, RHYTHMS[PhaseOrder.TOE_OFF_FIRST])
