"""Walking as a phased problem: what is unknown where, and a motion that stands on the ground."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ergowalk.gait.rhythm import Contact, Phase, PhaseOrder, half_stride_phases
from ergowalk.mechanics.foot import foot_balance, toe_balance
from ergowalk.mechanics.kinematics import HALF_PI, BodyMotion, LegPoints, link
from ergowalk.problem import GaitProblem, JointBounds, Limits, RhythmBounds, preset
from ergowalk.solving.stages import Effort, OrderSearch
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Samples, Trajectory
from ergowalk.transcription.edges import BAND
from ergowalk.transcription.guess import human_guess, loaded_guess, starting_rhythm, starting_times
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.mesh import walking_mesh
from ergowalk.transcription.motion import body_motion, load_sharing
from ergowalk.transcription.phases import Instant, State
from ergowalk.transcription.walker import SHARING, Smoothing, Walker
from ergowalk.transcription.walking import walking_problem

Array = NDArray[np.float64]

PROBLEM = preset("berbyuk2002")
ORDERS = tuple(PhaseOrder)
ORDER_NAMES = [str(order) for order in ORDERS]

KERNELS = KernelStore()
"""Of :data:`PROBLEM`; they are the same in both orders."""


def collocation(order: PhaseOrder, level: float = 0.3, m: int = 2) -> Collocation:
    times = starting_times(PROBLEM, starting_rhythm(PROBLEM, order))
    mesh = walking_mesh(order, times, PROBLEM.stride_time_s, level)
    return Collocation(walking_problem(PROBLEM, (order,)), mesh, m, KERNELS)


# --- unknowns and rows -------------------------------------------------------------------------

UNKNOWNS = {
    "heel+toe": (6, 7, 8, 7),
    "heel+swing": (7, 5, 2, 5),
    "flat+toe": (5, 7, 8, 7),
    "flat+swing": (6, 5, 2, 5),
    "forefoot+swing": (7, 6, 2, 6),
}
"""Coordinates, moments, algebraics, joints that may do work, of each phase.

A flat foot has no angle, a foot on its toe tip follows from its ankle (two angles and rates at
the Gauss points); two reactions of each standing foot; the ankle works while the foot is loaded,
the metatarsal joint while the toes are.
"""

EQUATIONS = {
    "heel+toe": {"equations of motion (1)": 7, "foot (1)": 2, "toe contact (4)": 4},
    "heel+swing": {"equations of motion (1)": 7},
    "flat+toe": {"equations of motion (1)": 7, "foot (1)": 2, "toe contact (4)": 4},
    "flat+swing": {"equations of motion (1)": 7},
    "forefoot+swing": {"equations of motion (1)": 7, "foot (1)": 1},
}
"""Equations at each Gauss point."""


@pytest.mark.parametrize("order", ORDERS, ids=ORDER_NAMES)
def test_each_phase_has_its_unknowns(order: PhaseOrder) -> None:
    walk = collocation(order)
    for phase, kernel in zip(walk.problem.phases, walk.kernels, strict=True):
        found = (
            len(phase.coordinates),
            len(phase.controls),
            len(phase.algebraics),
            kernel.n_abs,
        )
        assert found == UNKNOWNS[phase.name]


@pytest.mark.parametrize("order", ORDERS, ids=ORDER_NAMES)
def test_each_phase_has_its_equations(order: PhaseOrder) -> None:
    walk = collocation(order)
    for phase, kernel in zip(walk.problem.phases, walk.kernels, strict=True):
        equal = kernel.lower == kernel.upper
        for name, count in EQUATIONS[phase.name].items():
            rows = [i for i, label in enumerate(kernel.labels) if label == name]
            assert len(rows) == 2 * count  # two Gauss points
            assert np.all(equal[rows])
        heel = phase.name.startswith("heel")
        pressure = [e for e, n in zip(equal, kernel.labels, strict=True) if "pressure (9)" in n]
        assert sum(pressure) == (2 if heel else 0)
        assert bool(pressure) and all(pressure) == heel


@pytest.mark.parametrize("order", ORDERS, ids=ORDER_NAMES)
def test_phases_and_boundaries_chain_in_the_order_asked_for(order: PhaseOrder) -> None:
    problem = walking_problem(PROBLEM, (order,))
    assert [p.name for p in problem.phases] == [p.name for p in half_stride_phases(order)]
    assert [(p.start, p.end) for p in problem.phases] == [
        (p.start, p.end) for p in half_stride_phases(order)
    ]
    for one, two in zip(problem.phases[:-1], problem.phases[1:], strict=True):
        assert one.end == two.start
    assert problem.times["heel_contact"] == (0.0, 0.0)
    half = PROBLEM.stride_time_s / 2
    assert problem.times["half_stride"] == (half, half)
    low, high = PROBLEM.rhythm.bounds("toe_off")
    assert problem.times["other_toe_off"] == pytest.approx(
        ((low - 0.5) * 2 * half, (high - 0.5) * 2 * half)
    )


@pytest.mark.parametrize("order", ORDERS, ids=ORDER_NAMES)
def test_legs_exchange_their_unknowns_at_half_stride(order: PhaseOrder) -> None:
    walk = collocation(order)
    boundary = walk.layout.boundary
    for name in ("thigh", "shank"):
        for kind in ("value", "rate"):
            for one, two in ((1, 2), (2, 1)):
                last = boundary["half_stride", f"{name}_{one}", kind]
                assert last == boundary["heel_contact", f"{name}_{two}", kind]
    assert boundary["half_stride", "trunk", "value"] == boundary["heel_contact", "trunk", "value"]
    for joint in ("hip", "knee"):
        assert (
            boundary["half_stride", f"{joint}_1", "control"]
            == boundary["heel_contact", f"{joint}_2", "control"]
        )
    assert boundary["half_stride", "foot_2", "value"] == boundary["heel_contact", "foot_1", "value"]


def test_limits_become_bounds_where_they_are_set() -> None:
    limits = Limits(
        vertical_reaction_body_weights=1.2,
        moment_nm_per_kg=JointBounds(hip=2.0, ankle=1.5),
        moment_rate_nm_per_kg_s=JointBounds(hip=20.0, knee=30.0, ankle=40.0),
    )
    problem = walking_problem(PROBLEM.replace(limits=limits), (PhaseOrder.TOE_OFF_FIRST,))
    bounds = {u.name: (u.lower, u.upper) for p in problem.phases for u in p.controls}
    assert bounds["hip_1"] == bounds["hip_2"] == (-2.0, 2.0)
    assert bounds["ankle_2"] == (-1.5, 1.5)
    assert bounds["knee_1"] == bounds["metatarsal_1"] == (-np.inf, np.inf)
    cap = 1.2 * PROBLEM.body.gravity_m_s2
    reactions = {z.name: (z.lower, z.upper) for p in problem.phases for z in p.algebraics}
    assert reactions["reaction_y_1"] == reactions["reaction_y_2"] == (0.0, cap)
    assert reactions["reaction_x_1"] == (-np.inf, np.inf)
    for phase in problem.phases:
        assert phase.control_rates == {
            "hip_1": 20.0, "hip_2": 20.0, "knee_1": 30.0, "knee_2": 30.0, "ankle_1": 40.0,
            "ankle_2": 40.0,
        }  # fmt: skip


def test_limits_that_are_off_leave_no_bounds() -> None:
    problem = walking_problem(preset("berbyuk2002-printed"), (PhaseOrder.TOE_OFF_FIRST,))
    for phase in problem.phases:
        assert phase.control_rates == {}
        for z in phase.algebraics:
            assert z.upper == np.inf
            assert z.lower == (0.0 if z.name.startswith("reaction_y") else -np.inf)


def test_linear_sharing_adds_its_unknowns_in_double_support_only() -> None:
    linear = PROBLEM.replace(double_support="linear")
    for phase in walking_problem(linear, (PhaseOrder.FLAT_FIRST,)).phases:
        lines = {q.name for q in phase.coordinates} & set(SHARING)
        assert lines == (set(SHARING) if phase.name.endswith("toe") else set())


def test_the_lines_of_linear_sharing_end_at_nothing_through_the_toe_tip() -> None:
    """(12) at toe-off; before it the load passes between metatarsal joint and toe tip."""
    linear = walking_problem(PROBLEM.replace(double_support="linear"), (PhaseOrder.FLAT_FIRST,))
    for name in SHARING:
        assert linear.fixed["other_toe_off", name, "value"] == 0.0
        assert name not in linear.joins[0].names.values()
    shift = next(q for q in linear.phases[0].coordinates if q.name == "pressure_shift")
    assert (shift.lower, shift.upper) == (-PROBLEM.body.leg(0).toe_length, 0.0)


# --- the starting rhythm -----------------------------------------------------------------------


@pytest.mark.parametrize("order", ORDERS, ids=ORDER_NAMES)
@pytest.mark.parametrize(
    "rhythm",
    [
        RhythmBounds(),
        RhythmBounds(heel_end=0.1),
        RhythmBounds(toe_off=0.6),
        RhythmBounds(heel_end=(0.05, 0.12), toe_off=(0.55, 0.58), heel_off=0.2),
        RhythmBounds(heel_off=(0.15, 0.2)),
    ],
    ids=["free", "heel_end fixed", "toe_off fixed", "narrow", "early heel_off"],
)
def test_the_search_starts_inside_the_bounds_with_room_for_every_phase(
    order: PhaseOrder, rhythm: RhythmBounds
) -> None:
    problem = PROBLEM.replace(rhythm=rhythm)
    start = starting_rhythm(problem, order)
    for name in ("heel_end", "heel_off", "toe_off"):
        low, high = rhythm.bounds(name)
        assert low <= getattr(start, name) <= high
    times = starting_times(problem, start)
    lengths = [times[p.end] - times[p.start] for p in half_stride_phases(order)]
    assert min(lengths) > 0.005 * problem.stride_time_s
    assert sum(lengths) == pytest.approx(problem.stride_time_s / 2)


def test_the_search_of_the_printed_order_starts_at_the_printed_rhythm() -> None:
    start = starting_rhythm(PROBLEM, PhaseOrder.TOE_OFF_FIRST)
    assert (start.heel_end, start.heel_off, start.toe_off) == pytest.approx((0.1, 0.23, 0.58))


# --- the kinematic fit -------------------------------------------------------------------------


@dataclass(frozen=True)
class Fit:
    """The motion nearest to the human means, of one problem and order."""

    problem: GaitProblem
    order: PhaseOrder
    walker: Walker
    trajectory: Trajectory

    @property
    def phases(self) -> tuple[Phase, ...]:
        return half_stride_phases(self.order)

    def dense(self, i: int, count: int = 9) -> tuple[Samples, BodyMotion, Array]:
        """Samples, motion and instants of phase i, inside and at the ends of its elements."""
        curves, s = self.trajectory.phases[i], np.linspace(0.0, 1.0, count)
        parts = [curves.in_element(k, s) for k in range(curves.elements)]
        samples = joined(parts)
        width = np.diff(curves.fractions)[:, None]
        fractions = (curves.fractions[:-1, None] + width * s).ravel()
        time = curves.start + curves.duration * fractions
        return samples, body_motion(self.walker, self.phases[i], samples), time

    def points(self, i: int) -> tuple[LegPoints, LegPoints]:
        return self.walker.points(self.dense(i)[1])


def joined(parts: list[Samples]) -> Samples:
    kinds = ("value", "rate", "acceleration", "control", "algebraic")
    return Samples(
        *(
            {n: np.concatenate([getattr(p, k)[n] for p in parts]) for n in getattr(parts[0], k)}
            for k in kinds
        )
    )


def fitted(name: str, order: PhaseOrder) -> Fit:
    problem = preset(name)
    search = OrderSearch(problem, (order,), Smoothing(), Effort(), None)
    return Fit(problem, order, search.walker, search.fit())


CASES = [(f"winter-{c}", o) for c in ("slow", "natural", "fast") for o in ORDERS]


@pytest.fixture(scope="module", params=CASES, ids=[f"{c}-{o}" for c, o in CASES])
def fit(request: pytest.FixtureRequest) -> Fit:
    return fitted(*request.param)


@pytest.fixture(scope="module")
def one_fit() -> Fit:
    return fitted("winter-natural", PhaseOrder.FLAT_FIRST)


def test_the_fit_stands_on_its_prints(fit: Fit) -> None:
    one, two = fit.walker.prints
    for i, phase in enumerate(fit.phases):
        leading, trailing = fit.points(i)
        resting = leading.heel if phase.legs[0] is Contact.HEEL else leading.metatarsal
        place = one.heel if phase.legs[0] is Contact.HEEL else one.metatarsal
        assert np.abs(resting.position[0] - place).max() < 1e-12
        assert np.abs(resting.position[1]).max() < 1e-12
        assert np.abs(np.stack(resting.velocity)).max() < 1e-12
        if phase.legs[1] is Contact.TOE:
            tip = trailing.toe_tip
            assert np.abs(tip.position[0] - two.toe_tip).max() < 1e-12
            assert np.abs(tip.position[1]).max() < 1e-12
            assert np.abs(np.stack(tip.velocity)).max() < 1e-11


def test_the_fit_lands_one_step_ahead_at_rest_and_leaves_at_rest(fit: Fit) -> None:
    heel = fit.points(3)[1].heel
    assert abs(heel.position[0][-1] - fit.problem.step_length_m) < 1e-8
    assert abs(heel.position[1][-1]) < 1e-8
    assert max(abs(v[-1]) for v in heel.velocity) < 1e-7
    first_swing = next(i for i, p in enumerate(fit.phases) if p.legs[1] is Contact.SWING)
    tip = fit.points(first_swing)[1].toe_tip
    assert abs(tip.position[0][0] - fit.walker.prints[1].toe_tip) < 1e-8
    assert abs(tip.position[1][0]) < 1e-8
    assert max(abs(v[0]) for v in tip.velocity) < 1e-7


def test_the_fit_is_continuous_where_phases_meet(fit: Fit) -> None:
    for i in range(3):
        before, after = fit.dense(i)[1], fit.dense(i + 1)[1]
        for kind, tolerance in (("position", 1e-8), ("velocity", 1e-7)):
            for axis in (0, 1):
                left, right = (getattr(m.hip, kind)[axis] for m in (before, after))
                assert abs(left[-1] - right[0]) < tolerance
        for leg in (0, 1):
            for segment in ("thigh", "shank", "foot"):
                left, right = (getattr(m.legs[leg], segment) for m in (before, after))
                assert abs(left.angle[-1] - right.angle[0]) < 1e-6, (i, leg, segment)


def test_the_fit_repeats_itself_with_the_legs_exchanged(fit: Fit) -> None:
    first, last = fit.dense(0)[1], fit.dense(3)[1]
    for segment in ("thigh", "shank", "foot"):
        for one, two in ((0, 1), (1, 0)):
            left = getattr(last.legs[one], segment)
            right = getattr(first.legs[two], segment)
            assert abs(left.angle[-1] - right.angle[0]) < 1e-6, segment
    shift = last.hip.position[0][-1] - first.hip.position[0][0]
    assert shift == pytest.approx(fit.problem.step_length_m, abs=1e-7)


def test_the_fit_keeps_its_feet_above_the_ground_at_mesh_points(fit: Fit) -> None:
    for i, phase in enumerate(fit.phases):
        at_mesh = fit.dense(i, 2)[1]
        for points, contact in zip(fit.walker.points(at_mesh), phase.legs, strict=True):
            if contact is not Contact.TOE:  # at all Gauss points there, but not at mesh points
                for point in (points.heel, points.metatarsal, points.toe_tip):
                    assert point.position[1].min() > -1e-7


def test_the_toes_bend_upward_in_the_toe_phase(fit: Fit) -> None:
    for i, phase in enumerate(fit.phases):
        if phase.legs[1] is Contact.TOE:
            leg = fit.dense(i)[1].legs[1]
            bend = leg.toes.angle - leg.foot.angle - fit.walker.leg.foot_angle
            assert bend.min() > -1e-3


def test_the_fit_stays_near_the_human_means(fit: Fit) -> None:
    """Within three standard deviations everywhere, within one and a half on average."""
    places = []
    for i, phase in enumerate(fit.phases):
        _, motion, time = fit.dense(i)
        edges = fit.walker.corridor_curves[0].at(time)
        instant = Instant(time, {}, {}, {"foot_2": 0.0}, curves=edges)
        places += [p for _, p in fit.walker.corridor_places(phase, instant, motion)]
    assert max(float(np.abs(p).max()) for p in places) < 4.0
    assert np.sqrt(np.mean(np.concatenate(places) ** 2)) < 1.2


def test_corridor_edges_as_functions_of_time_are_the_corridors(fit: Fit) -> None:
    """Values and both time derivatives, leg 2 half a stride later."""
    curves, stride = fit.walker.corridor_curves[0], fit.problem.stride_time_s
    time = np.linspace(0, stride, 11)
    table = np.asarray(curves.evaluate(time[None, :])).reshape(3, len(curves.names), -1)
    for leg in (1, 2):
        for joint, corridor in fit.walker.corridors[leg - 1].items():
            s = time / stride + 0.5 * (leg - 1)
            middle, half = (curves.names.index(f"{joint}_{leg} {edge}") for edge in BAND)
            for order in (0, 1, 2):
                scale = stride**-order
                np.testing.assert_allclose(
                    table[order, middle], corridor.mean(s, order) * scale, rtol=1e-9, atol=1e-9
                )
                np.testing.assert_allclose(
                    table[order, half],
                    corridor.width * corridor.sd(s, order) * scale,
                    rtol=1e-9,
                    atol=1e-9,
                )


def test_the_trailing_foot_at_gauss_points_is_the_one_of_the_toe_chain(fit: Fit) -> None:
    """The solver's algebraic unknowns and the closed form agree."""
    for i, phase in enumerate(fit.phases):
        if phase.legs[1] is not Contact.TOE:
            continue
        curves = fit.trajectory.phases[i]
        for k in range(curves.elements):
            samples = curves.in_element(k, curves.scheme.points)
            leg = body_motion(fit.walker, phase, samples).legs[1]
            for name, segment in (("foot_2", leg.foot), ("toes_2", leg.toes)):
                np.testing.assert_allclose(samples.algebraic[name], segment.angle, atol=1e-6)
                np.testing.assert_allclose(
                    samples.algebraic[f"{name}_rate"], segment.rate, atol=1e-5
                )


# --- from unknowns to the whole walker ---------------------------------------------------------


def all_curves(motion: BodyMotion) -> list[tuple[Array, Array, Array]]:
    """Value, rate, acceleration of every angle and of the hip."""
    out = [
        (r.angle, r.rate, r.acceleration)
        for r in (
            motion.trunk,
            *(getattr(g, s) for g in motion.legs for s in ("thigh", "shank", "foot", "toes")),
        )
    ]
    hip = motion.hip
    return out + [(hip.position[a], hip.velocity[a], hip.acceleration[a]) for a in (0, 1)]


def test_rates_and_accelerations_are_derivatives_in_time(one_fit: Fit) -> None:
    """Central differences inside elements, in every phase, of every angle and of the hip."""
    step = 1e-4
    for i, phase in enumerate(one_fit.phases):
        curves = one_fit.trajectory.phases[i]
        for k in range(curves.elements):
            width = curves.duration * (curves.fractions[k + 1] - curves.fractions[k])
            s = np.linspace(0.2, 0.8, 4)
            low, here, high = (
                all_curves(body_motion(one_fit.walker, phase, curves.in_element(k, s + d)))
                for d in (-step, 0.0, step)
            )
            for before, now, after in zip(low, here, high, strict=True):
                for order in (0, 1):
                    slope = (after[order] - before[order]) / (2 * step * width)
                    scale = 1.0 + np.abs(now[order + 1]).max()
                    np.testing.assert_allclose(slope, now[order + 1], atol=2e-5 * scale)


def test_the_hip_follows_from_the_contact(one_fit: Fit) -> None:
    """Going down the standing leg from the hip ends on its print."""
    leg, one = one_fit.walker.leg, one_fit.walker.prints[0]
    for i, phase in enumerate(one_fit.phases):
        motion = one_fit.dense(i)[1]
        foot = motion.legs[0]
        metatarsal = (
            motion.hip
            + link(leg.thigh_length, foot.thigh)
            + link(leg.shank_length, foot.shank)
            + link(leg.ankle_to_metatarsal, foot.foot)
        )
        place = one.metatarsal
        if phase.legs[0] is Contact.HEEL:
            tilt = foot.foot.angle + leg.foot_angle - HALF_PI
            place = one.heel + leg.heel_to_metatarsal * np.cos(tilt)
        np.testing.assert_allclose(metatarsal.position[0], place, atol=1e-12)
        assert np.abs(motion.hip.position[1] - 1.05).max() < 0.1  # two nearly straight legs


def test_a_flat_foot_is_flat(one_fit: Fit) -> None:
    for i, phase in enumerate(one_fit.phases):
        if phase.legs[0] is Contact.FLAT:
            leg = one_fit.dense(i)[1].legs[0]
            np.testing.assert_array_equal(leg.foot.angle, one_fit.walker.flat)
            np.testing.assert_array_equal(leg.toes.angle, HALF_PI)
            for turn in (leg.foot, leg.toes):
                np.testing.assert_array_equal(turn.rate, 0.0)
                np.testing.assert_array_equal(turn.acceleration, 0.0)


def test_the_search_starts_from_the_human_mean_angles(one_fit: Fit) -> None:
    """Joint angles (6) of the very first guess are the means of the table, trunk upright."""
    walker, stride = one_fit.walker, one_fit.problem.stride_time_s
    times = one_fit.trajectory.times
    guess = human_guess(walker, one_fit.order, times)
    fractions, step = np.linspace(0.1, 0.9, 5), 1e-5
    for i, phase in enumerate(one_fit.phases):
        length = times[phase.end] - times[phase.start]
        s = (times[phase.start] + length * fractions) / stride
        here = guess(i, fractions)
        for leg, shift in ((1, 0.0), (2, 0.5)):
            thigh, shank, foot = (here.value[f"{n}_{leg}"] for n in ("thigh", "shank", "foot"))
            angles = {"hip": thigh, "knee": thigh - shank, "ankle": foot - shank - walker.flat}
            for joint, angle in angles.items():
                mean = one_fit.problem.angle_corridors()[joint].mean(s + shift)
                np.testing.assert_allclose(angle, mean, atol=1e-12)
        assert not np.any(here.value["trunk"])
        low, high = guess(i, fractions - step), guess(i, fractions + step)
        for kind, derivative in (("value", "rate"), ("rate", "acceleration")):
            for name, expected in getattr(here, derivative).items():
                rise = getattr(high, kind)[name] - getattr(low, kind)[name]
                slope = rise / (2 * step * length)
                tolerance = 1e-5 * (1 + np.abs(expected).max())
                np.testing.assert_allclose(slope, expected, atol=tolerance)


def loaded(fit: Fit, i: int) -> tuple[Samples, BodyMotion, Array]:
    """The first guess with forces and moments, its motion, and instants."""
    fractions = np.linspace(0.01, 0.99, 13)
    samples = loaded_guess(fit.walker, fit.order, fit.trajectory)(i, fractions)
    curves = fit.trajectory.phases[i]
    return (
        samples,
        body_motion(fit.walker, fit.phases[i], samples),
        curves.start + curves.duration * fractions,
    )


def test_the_first_guess_obeys_the_equations_of_motion(one_fit: Fit) -> None:
    """Checked by the very rows that the solver sees."""
    walker = one_fit.walker
    for i, phase in enumerate(one_fit.phases):
        samples, _motion, time = loaded(one_fit, i)
        states = {
            n: State(samples.value[n], samples.rate[n], samples.acceleration[n])
            for n in samples.value
        }
        instant = Instant(time, states, samples.control, samples.algebraic)
        terms = walker.dynamics_rows(phase, instant, walker.motion(phase, instant))
        residuals = {
            name: np.abs(value).max()
            for name, value, _, _ in terms.rows
            if name in ("equations of motion (1)", "foot (1)", "toe contact (4)")
        }
        assert residuals
        assert max(residuals.values()) < 1e-9, (phase.name, residuals)


def test_a_trailing_foot_is_loaded_as_its_two_moments_say(one_fit: Fit) -> None:
    walker = one_fit.walker
    for i, phase in enumerate(one_fit.phases):
        samples, motion, _ = loaded(one_fit, i)
        sharing = load_sharing(walker, phase, samples, motion)
        if phase.legs[1] is Contact.SWING:
            assert not np.any(sharing.force_x) and not np.any(sharing.force_y)
            continue
        points = walker.points(motion)[1]
        reaction = (sharing.force_x, sharing.force_y)
        ankle, metatarsal = (walker.mass * samples.control[n] for n in ("ankle_2", "metatarsal_2"))
        np.testing.assert_allclose(
            foot_balance(points, ankle, metatarsal, reaction), 0.0, atol=1e-9
        )
        np.testing.assert_allclose(
            toe_balance(points, metatarsal, reaction, sharing.pressure), 0.0, atol=1e-9
        )
        np.testing.assert_allclose(
            sharing.force_y, walker.mass * samples.algebraic["reaction_y_2"], atol=1e-7
        )
        np.testing.assert_array_equal(sharing.pressure, walker.prints[1].toe_tip)


def test_with_linear_sharing_the_force_and_its_place_run_along_their_lines(
    one_fit: Fit,
) -> None:
    linear = Walker(one_fit.problem.replace(double_support="linear"), Smoothing())
    samples, motion, time = loaded(one_fit, 0)
    lines = {"reaction_share": 0.3 - 0.2 * time, "pressure_shift": 0.01 - 0.1 * time}
    changed = replace(samples, value={**samples.value, **lines})
    sharing = load_sharing(linear, one_fit.phases[0], changed, motion)
    np.testing.assert_allclose(sharing.force_x, linear.mass * (0.3 - 0.2 * time))
    np.testing.assert_allclose(sharing.pressure, linear.prints[1].toe_tip + 0.01 - 0.1 * time)


def test_with_linear_sharing_the_load_leaves_along_straight_lines() -> None:
    """(12) for a whole gait: R_2x and x_R2 run straight to (0, toe tip) at toe-off."""
    problem = preset("berbyuk2002-rhythm").replace(double_support="linear")
    (order,) = problem.rhythm.orders()
    search = OrderSearch(problem, (order,), Smoothing(), Effort(), None)
    held = search.fixed_rhythm(search.fit())
    assert held.minimum.converged
    worst = held.collocation.programme.violations(held.minimum.x)
    assert max(worst.values()) < 1e-6
    curves = held.trajectory.phases[0]
    time = np.linspace(0.0, 1.0, 41)
    samples = curves.at(time)
    motion = body_motion(search.walker, half_stride_phases(order)[0], samples)
    sharing = load_sharing(search.walker, half_stride_phases(order)[0], samples, motion)
    tip, toes = search.walker.prints[1].toe_tip, problem.body.leg(0).toe_length
    first = sharing.force_x[0]
    np.testing.assert_allclose(sharing.force_x, first * (1 - time), atol=1e-6 * abs(first) + 1e-6)
    begin = sharing.pressure[0] - tip
    np.testing.assert_allclose(sharing.pressure - tip, begin * (1 - time), atol=1e-8)
    assert -toes - 1e-6 <= begin <= 1e-6
