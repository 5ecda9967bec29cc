"""The closed-form motion: contacts, symmetry, toe-off and time derivatives."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ergowalk.gait.footprints import leading_print, trailing_print
from ergowalk.gait.rhythm import Contact, PhaseOrder
from ergowalk.mechanics.foot import toe_chain
from ergowalk.mechanics.kinematics import leg_points
from ergowalk.transcription.spline.programme import MotionPiece, SplineProgramme

from .walks import programme, unknowns

ORDERS = list(PhaseOrder)
SEEDS = [0, 1, 2]


def walk(order: PhaseOrder, seed: int) -> tuple[SplineProgramme, list[MotionPiece]]:
    p = programme(order, extras=("heel_slope", "swing_foot"))
    c = unknowns(p.size, seed, 2e-3)
    assert p.value(c)[1][0] == 0.0, "this walk must be geometrically possible"
    return p, p.pieces(c, longest=2e-4)


def curves(piece: MotionPiece) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Value, rate and acceleration of all eleven coordinates."""
    hip, g = piece.motion.hip, piece.motion
    found = [(hip.position[i], hip.velocity[i], hip.acceleration[i]) for i in (0, 1)]
    turning = [g.trunk]
    for leg in g.legs:
        turning += [leg.thigh, leg.shank, leg.foot, leg.toes]
    return found + [(r.angle, r.rate, r.acceleration) for r in turning]


def derivative(values: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Five-point central differences at the third to the third-last of equally spaced instants."""
    h = time[1] - time[0]
    return (values[:-4] - 8 * values[1:-3] + 8 * values[3:-1] - values[4:]) / (12 * h)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", SEEDS)
def test_rates_and_accelerations_are_the_time_derivatives(order: PhaseOrder, seed: int) -> None:
    _, pieces = walk(order, seed)
    for piece in pieces:
        for value, rate, acceleration in curves(piece):
            for curve, slope in ((value, rate), (rate, acceleration)):
                error = np.abs(derivative(curve, piece.time) - slope[2:-2]).max()
                assert error <= 1e-6 * max(np.abs(slope).max(), 1.0)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", SEEDS)
def test_feet_rest_in_their_prints(order: PhaseOrder, seed: int) -> None:
    p, pieces = walk(order, seed)
    leg = p.problem.body.leg(0)
    prints = leading_print(leg), trailing_print(leg, p.problem.step_length_m)
    for piece in pieces:
        for i, contact in enumerate(piece.contacts):
            points = leg_points(leg, piece.motion.legs[i], piece.motion.hip)
            resting = {
                Contact.SWING: (),
                Contact.HEEL: ((points.heel, prints[i].heel),),
                Contact.FLAT: (
                    (points.heel, prints[i].heel),
                    (points.metatarsal, prints[i].metatarsal),
                ),
                Contact.FOREFOOT: (
                    (points.metatarsal, prints[i].metatarsal),
                    (points.toe_tip, prints[i].toe_tip),
                ),
                Contact.TOE: ((points.toe_tip, prints[i].toe_tip),),
            }[contact]
            for point, place in resting:
                assert np.abs(point.position[0] - place).max() < 1e-12
                assert np.abs(point.position[1]).max() < 1e-12
                assert np.abs(np.asarray(point.velocity)).max() < 1e-11


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", SEEDS)
def test_the_legs_exchange_at_half_stride(order: PhaseOrder, seed: int) -> None:
    """(2): value and rate of every coordinate, the hip one step farther."""
    p, pieces = walk(order, seed)
    first, last = curves(pieces[0]), curves(pieces[-1])
    exchanged = [0, 1, 2, 7, 8, 9, 10, 3, 4, 5, 6]
    for i, j in enumerate(exchanged):
        advance = p.problem.step_length_m if i == 0 else 0.0
        assert last[j][0][-1] - first[i][0][0] == pytest.approx(advance, abs=1e-12)
        assert last[j][1][-1] == pytest.approx(first[i][1][0], abs=1e-11)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", SEEDS)
def test_positions_and_velocities_never_jump(order: PhaseOrder, seed: int) -> None:
    _, pieces = walk(order, seed)
    for before, after in itertools.pairwise(pieces):
        assert before.time[-1] == after.time[0]
        for left, right in zip(curves(before), curves(after), strict=True):
            assert left[0][-1] == pytest.approx(right[0][0], abs=1e-12)
            assert left[1][-1] == pytest.approx(right[1][0], abs=1e-10)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("seed", SEEDS)
def test_toes_come_into_line_at_toe_off_and_lie_flat_at_heel_contact(
    order: PhaseOrder, seed: int
) -> None:
    """(7): epsilon - gamma - phi_m reaches zero with zero rate; epsilon starts at pi/2, at rest."""
    p, pieces = walk(order, seed)
    phi = p.problem.body.leg(0).foot_angle
    toe = [piece for piece in pieces if piece.contacts[1] is Contact.TOE]
    leg = toe[-1].motion.legs[1]
    assert leg.toes.angle[-1] - leg.foot.angle[-1] == pytest.approx(phi, abs=1e-12)
    assert leg.toes.rate[-1] == pytest.approx(leg.foot.rate[-1], abs=1e-10)
    leg = toe[0].motion.legs[1]
    assert leg.toes.angle[0] == pytest.approx(np.pi / 2, abs=1e-12)
    assert leg.toes.rate[0] == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_toe_phase_is_the_chain_of_the_mechanics(seed: int) -> None:
    p, pieces = walk(PhaseOrder.TOE_OFF_FIRST, seed)
    leg = p.problem.body.leg(0)
    tip = trailing_print(leg, p.problem.step_length_m).toe_tip
    for piece in pieces:
        if piece.contacts[1] is Contact.TOE:
            own = piece.motion.legs[1]
            ankle = leg_points(leg, own, piece.motion.hip).ankle
            foot, toes = toe_chain(leg, ankle, (tip, 0.0))
            for a, b in ((own.foot, foot), (own.toes, toes)):
                np.testing.assert_allclose(a.angle, b.angle, atol=1e-12)
                np.testing.assert_allclose(a.rate, b.rate, atol=1e-9)
                np.testing.assert_allclose(a.acceleration, b.acceleration, rtol=1e-8, atol=1e-7)


def test_free_functions_are_what_the_data_say() -> None:
    """psi_0 is the trunk angle at heel contact; the knee passes through its data at 0 and T/2."""
    p = programme()
    c = unknowns(p.size, 3, 2e-3)
    data, pieces = p.data(c), p.pieces(c)
    assert pieces[0].motion.trunk.angle[0] == pytest.approx(data[p.curves.psi], abs=1e-12)
    leg, other = (pieces[0].motion.legs[i] for i in (0, 1))
    knots = len(p.curves.grid) - 1
    for g, datum in ((leg, 0), (other, knots)):
        angle = g.thigh.angle[0] - g.shank.angle[0]
        assert angle == pytest.approx(data[p.curves.place("knee", datum)], abs=1e-12)
