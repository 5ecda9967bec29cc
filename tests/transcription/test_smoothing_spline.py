"""Problem B: the smoothing spline is the minimiser of (13) under (14) or (15), for any data."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp
from scipy.interpolate import CubicSpline

from ergowalk.errors import InputError
from ergowalk.transcription.spline.smoothing import Ends, SmoothingSpline

LAW = settings(deadline=None, max_examples=100, derandomize=True, database=None)
SLOW_LAW = settings(LAW, max_examples=30)

STRIDE = 1.14
NUMBERS = st.floats(-3, 3)
RHO = st.one_of(st.just(0.0), st.floats(-8, 12).map(lambda power: 10.0**power))
ALL_ENDS = st.sampled_from(Ends)


@dataclass(frozen=True)
class Case:
    """A spline and data for it."""

    spline: SmoothingSpline
    p: np.ndarray

    @property
    def data(self) -> np.ndarray:
        """z at every knot, the joint knot of a periodic curve twice."""
        if self.spline.ends is Ends.PERIODIC:
            return np.append(self.p, self.p[0])
        return self.p[:-2]

    def instants(self) -> np.ndarray:
        """Knots and three instants between each two."""
        knots = self.spline.knots
        steps = np.diff(knots)[:, None] * np.array([0.0, 0.2, 0.5, 0.9])
        return np.append((knots[:-1, None] + steps).ravel(), knots[-1])


def joined(ends: Ends, rho: list[float]) -> np.ndarray:
    """First and last rho of a periodic spline are one."""
    return np.array([*rho[:-1], rho[0]]) if ends is Ends.PERIODIC else np.array(rho)


@st.composite
def cases(
    draw: st.DrawFn,
    ends: st.SearchStrategy[Ends] = ALL_ENDS,
    rho: st.SearchStrategy[float] = RHO,
    most: int = 20,
) -> Case:
    kind, n = draw(ends), draw(st.integers(3, most))
    steps = draw(st.lists(st.floats(0.05, 1.0), min_size=n, max_size=n))
    knots = draw(st.floats(-2, 2)) + np.cumsum([0.0, *steps])
    freedom = draw(st.lists(rho, min_size=n + 1, max_size=n + 1))
    spline = SmoothingSpline(knots, joined(kind, freedom), kind)
    return Case(spline, data_of(draw, spline.parameters))


def data_of(draw: st.DrawFn, size: int) -> np.ndarray:
    return np.array(draw(st.lists(NUMBERS, min_size=size, max_size=size)))


def interpolant(ends: Ends, t: np.ndarray, values: np.ndarray, slopes: np.ndarray) -> CubicSpline:
    """SciPy's cubic spline through values with clamped or periodic ends."""
    if ends is Ends.PERIODIC:
        return CubicSpline(t, np.append(values[:-1], values[0]), bc_type="periodic")
    return CubicSpline(t, values, bc_type=((1, slopes[0]), (1, slopes[1])))


def halved(knots: np.ndarray) -> np.ndarray:
    return np.sort(np.append(knots, (knots[:-1] + knots[1:]) / 2))


def bending(curve: CubicSpline) -> float:
    """Integral of the squared second derivative, exactly: on a piece it is a parabola."""
    a, b, mid = curve.x[:-1], curve.x[1:], (curve.x[:-1] + curve.x[1:]) / 2
    squares = curve(a, 2) ** 2 + 4 * curve(mid, 2) ** 2 + curve(b, 2) ** 2
    return float(np.sum((b - a) / 6 * squares))


def misfit(spline: SmoothingSpline, distance: np.ndarray) -> float:
    """Sum of distance^2 / rho over the knots that are not interpolated, each once."""
    counts = spline.rho > 0
    counts[-1] &= spline.ends is Ends.CLAMPED
    return float(np.sum(distance[counts] ** 2 / spline.rho[counts]))


def curve_of(case: Case) -> CubicSpline:
    """The case's spline rebuilt by SciPy from values at its knots and half way between them."""
    t = halved(case.spline.knots)
    return interpolant(case.spline.ends, t, case.spline(t, case.p), case.p[-2:])


@st.composite
def admissible(draw: st.DrawFn, spline: SmoothingSpline) -> CubicSpline:
    """A C2 curve that may be added: zero where interpolated, end slopes zero or periodic.

    It has twice as many pieces as the spline, so it leaves the space of splines on the knots.
    """
    t = halved(spline.knots)
    values = data_of(draw, len(t))
    if spline.ends is Ends.PERIODIC:
        values[-1] = values[0]
    values[::2][spline.rho == 0] = 0.0
    return interpolant(spline.ends, t, values, np.zeros(2))


# -- the two limits ------------------------------------------------------------------------------


@LAW
@given(cases(rho=st.just(0.0)))
def test_without_freedom_it_is_the_interpolating_spline(case: Case) -> None:
    spline, t = case.spline, case.instants()
    known = interpolant(spline.ends, spline.knots, case.data, case.p[-2:])
    for d in range(4):
        if d == 3:  # it jumps at a knot
            t = np.setdiff1d(t, spline.knots)
        scale = max(1.0, np.abs(known(t, d)).max())
        np.testing.assert_allclose(spline(t, case.p, d), known(t, d), rtol=0, atol=1e-10 * scale)


@LAW
@given(cases())
def test_a_knot_without_freedom_has_its_datum_to_the_last_digit(case: Case) -> None:
    fixed = case.spline.rho == 0
    found = case.spline(case.spline.knots[fixed], case.p)
    np.testing.assert_array_equal(found, case.data[fixed])


@LAW
@given(cases(), st.sampled_from([5e-324, 1e-300, 1e-30]))
def test_hardly_any_freedom_is_none(case: Case, least: float) -> None:
    spline = case.spline
    hardly = SmoothingSpline(spline.knots, np.where(spline.rho > 0, spline.rho, least), spline.ends)
    with np.errstate(all="raise", under="ignore"):
        found, level = hardly.matrix(case.instants()), hardly.functional(case.p)
    np.testing.assert_allclose(found, spline.matrix(case.instants()), rtol=0, atol=1e-10)
    assert level == pytest.approx(spline.functional(case.p), rel=1e-9, abs=1e-9)


@st.composite
def loose(draw: st.DrawFn, ends: Ends) -> Case:
    """A stride with rho of about 1e12 s^3 everywhere."""
    case = draw(cases(st.just(ends), st.floats(1e12, 4e12)))
    knots = case.spline.knots
    knots = np.append((knots[:-1] - knots[0]) * (STRIDE / np.ptp(knots)), STRIDE)
    return Case(SmoothingSpline(knots, case.spline.rho, ends), case.p)


def fixed_at(case: Case, *where: int) -> Case:
    rho = case.spline.rho.copy()
    rho[list(where)] = 0.0
    return Case(SmoothingSpline(case.spline.knots, rho, case.spline.ends), case.p)


@LAW
@given(loose(Ends.PERIODIC))
def test_a_free_periodic_curve_becomes_the_weighted_mean(case: Case) -> None:
    mean = np.average(case.p, weights=1 / case.spline.rho[:-1])
    np.testing.assert_allclose(case.spline(case.instants(), case.p), mean, rtol=0, atol=1e-9)
    level = np.sum((case.p - mean) ** 2 / case.spline.rho[:-1])
    assert case.spline.functional(case.p) == pytest.approx(level, rel=1e-9, abs=1e-22)


@LAW
@given(loose(Ends.PERIODIC), st.data())
def test_a_free_periodic_curve_becomes_its_one_fixed_value(case: Case, data: st.DataObject) -> None:
    j = data.draw(st.integers(1, len(case.p) - 1))
    for where in ((j,), (0, -1)):
        held = fixed_at(case, *where)
        found = held.spline(case.instants(), case.p)
        np.testing.assert_allclose(found, case.p[where[0]], rtol=0, atol=1e-9)


@LAW
@given(loose(Ends.CLAMPED), st.data())
def test_a_free_clamped_curve_becomes_the_parabola_of_its_end_slopes(
    case: Case, data: st.DataObject
) -> None:
    """Nearest to the data, or through the one datum that is interpolated."""

    def parabola(t: np.ndarray) -> np.ndarray:
        first, last = case.p[-2:]
        return first * t + (last - first) * t**2 / (2 * STRIDE)

    t = case.instants()
    gap = case.data - parabola(case.spline.knots)
    height = np.average(gap, weights=1 / case.spline.rho)
    found = case.spline(t, case.p)
    np.testing.assert_allclose(found, height + parabola(t), rtol=0, atol=1e-9)
    j = data.draw(st.integers(0, len(gap) - 1))
    found = fixed_at(case, j).spline(t, case.p)
    np.testing.assert_allclose(found, gap[j] + parabola(t), rtol=0, atol=1e-9)


@LAW
@given(loose(Ends.CLAMPED))
def test_the_papers_free_clamped_curve_becomes_the_cubic_of_its_ends(case: Case) -> None:
    """rho_0 = rho_n = 0, eq (17)."""
    case, t = fixed_at(case, 0, -1), case.instants()
    cubic = CubicSpline(
        [0.0, STRIDE], case.data[[0, -1]], bc_type=((1, case.p[-2]), (1, case.p[-1]))
    )
    np.testing.assert_allclose(case.spline(t, case.p), cubic(t), rtol=0, atol=1e-9)


# -- the minimum ---------------------------------------------------------------------------------


@LAW
@given(cases())
def test_the_functional_is_that_of_the_curve(case: Case) -> None:
    curve = curve_of(case)
    level = bending(curve) + misfit(case.spline, curve(case.spline.knots) - case.data)
    assert case.spline.functional(case.p) == pytest.approx(level, rel=1e-9, abs=1e-18)


@LAW
@given(cases(), st.data())
def test_no_other_curve_with_these_ends_is_better(case: Case, data: st.DataObject) -> None:
    """J(S + e h) - J(S) = e^2 (integral h''^2 + sum h(t_j)^2 / rho_j): no first-order term."""
    spline, knots = case.spline, case.spline.knots
    curve, h = curve_of(case), data.draw(admissible(spline))
    least = spline.functional(case.p)
    second = bending(h) + misfit(spline, h(knots))
    # a curve that should be straight bends by the rounding of its values
    straight = (1e-14 * np.abs(case.p).max()) ** 2 / np.diff(knots).min() ** 3
    for e in (-1.0, 0.1, 1.0):
        changed = CubicSpline(curve.x, np.zeros(len(curve.x)))
        changed.c = curve.c + e * h.c
        other = bending(changed) + misfit(spline, changed(knots) - case.data)
        rounding = 1e-10 * (least + other) + straight
        assert other >= least - rounding
        assert other - least == pytest.approx(e**2 * second, abs=rounding)


def exact(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Values and slopes at the knots, minimising (13) over them directly, in 60 digits."""
    spline, mp.dps = case.spline, 60
    t, count = [mp.mpf(float(x)) for x in spline.knots], len(case.p)
    if spline.ends is Ends.CLAMPED:
        count -= 2
    hessian, right = mp.zeros(2 * count), mp.zeros(2 * count, 1)
    for i, (start, end) in enumerate(pairwise(t)):
        j, s = (i + 1) % count, end - start
        beam = mp.matrix(
            [
                [12, 6 * s, -12, 6 * s],
                [6 * s, 4 * s**2, -6 * s, 2 * s**2],
                [-12, -6 * s, 12, -6 * s],
                [6 * s, 2 * s**2, -6 * s, 4 * s**2],
            ]
        )
        for row, a in enumerate((i, count + i, j, count + j)):
            for column, b in enumerate((i, count + i, j, count + j)):
                hessian[a, b] += beam[row, column] / s**3

    def fix(row: int, value: float) -> None:
        hessian[row, :] = mp.zeros(1, 2 * count)
        hessian[row, row], right[row] = 1, float(value)

    for j in range(count):
        if spline.rho[j] == 0:
            fix(j, case.data[j])
        else:
            hessian[j, j] += 1 / mp.mpf(float(spline.rho[j]))
            right[j] += float(case.data[j]) / mp.mpf(float(spline.rho[j]))
    if spline.ends is Ends.CLAMPED:
        fix(count, case.p[-2])
        fix(2 * count - 1, case.p[-1])
    found = np.array([float(x) for x in mp.lu_solve(hessian, right)])
    return found[:count], found[count:]


@SLOW_LAW
@given(cases(rho=st.one_of(st.just(0.0), st.floats(-30, 15).map(lambda e: 10.0**e)), most=10))
def test_it_is_the_direct_minimum_however_rho_varies(case: Case) -> None:
    values, slopes = exact(case)
    t = case.spline.knots[: len(values)]
    np.testing.assert_allclose(case.spline(t, case.p), values, rtol=0, atol=1e-11)
    scale = max(1.0, np.abs(slopes).max())
    np.testing.assert_allclose(case.spline(t, case.p, 1), slopes, rtol=0, atol=1e-11 * scale)


@LAW
@given(cases(), st.floats(1.0, 100.0))
def test_more_freedom_never_costs(case: Case, factor: float) -> None:
    spline = case.spline
    freer = SmoothingSpline(spline.knots, spline.rho * factor, spline.ends)
    assert freer.functional(case.p) <= spline.functional(case.p) * (1 + 1e-10)


# -- the curve -----------------------------------------------------------------------------------


@LAW
@given(cases())
def test_every_piece_is_the_cubic_of_its_derivatives_and_meets_the_next_in_c2(case: Case) -> None:
    """Taylor from each knot, with its right-hand third derivative, as far as the next knot."""
    spline, p, knots = case.spline, case.p, case.spline.knots
    at_knots = np.array([spline(knots, p, d) for d in range(4)])
    for i, step in enumerate(np.diff(knots)):
        piece = np.polynomial.Polynomial(at_knots[:, i] / [1, 1, 2, 6])
        for d in range(4):
            cubic = piece.deriv(d) if d else piece
            scale = max(1.0, np.abs(at_knots[d]).max())
            u = step * np.array([0.0, 0.3, 0.8])
            np.testing.assert_allclose(
                spline(knots[i] + u, p, d), cubic(u), rtol=0, atol=1e-9 * scale
            )
            if d < 3:  # for periodic ends the last knot is the first
                assert cubic(step) == pytest.approx(at_knots[d, i + 1], abs=1e-9 * scale)


@LAW
@given(cases(st.just(Ends.CLAMPED)))
def test_clamped_ends_have_the_given_slopes_and_the_inner_third_derivative(case: Case) -> None:
    a, b = case.spline.knots[[0, -1]]
    scale = max(1.0, np.abs(case.spline(case.instants(), case.p, 1)).max())
    np.testing.assert_allclose(
        case.spline([a, b], case.p, 1), case.p[-2:], rtol=0, atol=1e-11 * scale
    )
    last, before = case.spline([b, b - 0.01], case.p, 3)
    assert last == before


@LAW
@given(cases(st.just(Ends.PERIODIC)), st.integers(-4, 4))
def test_a_periodic_curve_repeats_itself_for_ever(case: Case, periods: int) -> None:
    knots = case.spline.knots
    t = case.instants()
    for d in range(3):
        found = case.spline(t + periods * np.ptp(knots), case.p, d)
        expected = case.spline(t, case.p, d)
        scale = max(1.0, np.abs(case.spline(t, case.p, d + 1)).max())
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * scale)


def test_wrapping_does_not_move_a_knot() -> None:
    """Else the third derivative would be the left-hand one at some knots."""
    knots = np.array([-0.7, -0.3, *(np.arange(1, 10) / 30)])  # 1/30 + 0.7 - 0.7 is not 1/30
    spline = SmoothingSpline(knots, np.zeros(11), Ends.PERIODIC)
    later = knots[:-1] + 0.01
    np.testing.assert_array_equal(spline.matrix(knots[:-1], 3), spline.matrix(later, 3))
    np.testing.assert_array_equal(spline.matrix(knots[-1:], 3), spline.matrix(later[:1], 3))


def test_an_instant_just_before_the_first_knot_is_just_before_the_last() -> None:
    spline = SmoothingSpline([0.0, 0.4, 0.7, 1.14], [0, 1e-3, 1e-3, 0], Ends.PERIODIC)
    p = np.array([1.0, -2.0, 0.5])
    for t in (-5e-324, -1e-20, np.nextafter(1.14, 0), 1.14, np.nextafter(1.14, 2)):
        assert spline([t], p)[0] == pytest.approx(1.0, abs=1e-14)


@LAW
@given(cases(), st.data(), NUMBERS)
def test_curves_add_up_as_their_data_do(case: Case, data: st.DataObject, factor: float) -> None:
    spline, t = case.spline, case.instants()
    other = data.draw(st.composite(data_of)(spline.parameters))
    for d in range(4):
        one, two = spline(t, case.p, d), spline(t, other, d)
        both = spline(t, case.p + factor * other, d)
        scale = max(1.0, np.abs(one).max(), np.abs(two).max())
        np.testing.assert_allclose(both, one + factor * two, rtol=0, atol=1e-11 * scale)
        np.testing.assert_array_equal(spline.matrix(t, d) @ case.p, one)


@LAW
@given(cases(), NUMBERS, NUMBERS)
def test_a_straight_line_needs_no_smoothing(case: Case, height: float, slope: float) -> None:
    spline, t = case.spline, case.instants()
    if spline.ends is Ends.PERIODIC:
        p, slope = np.full(spline.parameters, height), 0.0
    else:
        p = np.array([*(height + slope * spline.knots), slope, slope])
    size, step = max(1.0, np.abs(p).max()), np.diff(spline.knots).min()
    for d, expected in enumerate((height + slope * t, slope, 0.0, 0.0)):
        rounding = 1e-13 * size / step**d  # that of d divided differences
        np.testing.assert_allclose(spline(t, p, d) - expected, 0.0, rtol=0, atol=rounding)
    assert spline.functional(p) == pytest.approx(0.0, abs=1e-20 * size**2)


@LAW
@given(cases(), st.floats(1e-3, 1e3), st.floats(-5, 5))
def test_the_curve_does_not_depend_on_unit_and_origin_of_time(
    case: Case, unit: float, origin: float
) -> None:
    spline, t = case.spline, case.instants()
    other = SmoothingSpline(unit * (spline.knots - origin), unit**3 * spline.rho, spline.ends)
    p = case.p.copy()
    if spline.ends is Ends.CLAMPED:
        p[-2:] /= unit
    found = other(unit * (t - origin), p)
    np.testing.assert_allclose(found, spline(t, case.p), rtol=0, atol=1e-9)
    assert unit**3 * other.functional(p) == pytest.approx(
        spline.functional(case.p), rel=1e-7, abs=1e-12
    )


# -- what it refuses -----------------------------------------------------------------------------


def test_it_keeps_its_own_knots() -> None:
    knots, rho = np.linspace(0.0, STRIDE, 5), np.zeros(5)
    spline = SmoothingSpline(knots, rho, Ends.CLAMPED)
    knots[1], rho[1] = 0.1, 1.0
    assert spline(np.array([STRIDE / 4]), np.arange(7.0))[0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        spline.knots[1] = 0.1


@pytest.mark.parametrize(
    ("knots", "rho", "ends", "message"),
    [
        (
            [0.0, 0.5, 0.5, 1.0],
            [0] * 4,
            Ends.CLAMPED,
            r"knots\[2\] = 0.5: must be later than .*sort",
        ),
        ([0.0, 0.7, 0.5, 1.0], [0] * 4, Ends.PERIODIC, r"knots\[2\] = 0.5: .* before it, 0.7 s"),
        ([0.0, np.nan, 1.0], [0] * 3, Ends.CLAMPED, r"knots\[1\] = nan: must be a finite.*seconds"),
        ([0.0, 0.5, np.inf], [0] * 3, Ends.CLAMPED, r"knots\[2\] = inf: must be a finite number"),
        ([0.0], [0], Ends.CLAMPED, r"knots.shape = \(1,\): .* 2 or more .* clamped ends; add"),
        ([0.0, 1.0], [0] * 2, Ends.PERIODIC, r"= \(2,\): .* 3 or more .* periodic ends; add knots"),
        ([[0.0, 1.0]], [[0] * 2], Ends.CLAMPED, r"knots.shape = \(1, 2\): must be a list"),
        ([0.0, 0.5, 1.0], [0] * 2, Ends.CLAMPED, r"rho.shape = \(2,\): .* the 3 knots; give zero"),
        (
            [0.0, 0.5, 1.0],
            [0, -1e-9, 0],
            Ends.CLAMPED,
            r"rho\[1\] = -1e-09: .* negative; give zero",
        ),
        ([0.0, 0.5, 1.0], [0, np.nan, 0], Ends.PERIODIC, r"rho\[1\] = nan: must be finite"),
        ([0.0, 0.5, 1.0], [np.inf, 0, 0], Ends.CLAMPED, r"rho\[0\] = inf: must be finite"),
        (
            [0.0, 0.5, 1.0],
            [1, 0, 0],
            Ends.PERIODIC,
            r"rho\[-1\] = 0.0: .* rho\[0\] = 1; .*one knot",
        ),
    ],
)
def test_knots_and_rho_that_cannot_be_are_refused(
    knots: list[float], rho: list[float], ends: Ends, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        SmoothingSpline(np.array(knots), np.array(rho), ends)


def stride(ends: Ends) -> SmoothingSpline:
    return SmoothingSpline(np.linspace(0.0, STRIDE, 5), np.zeros(5), ends)


@pytest.mark.parametrize("t", [-1e-9, STRIDE + 1e-9, np.nan, np.inf])
def test_an_instant_outside_clamped_knots_is_refused(t: float) -> None:
    with pytest.raises(
        InputError, match=r"t = .*: must .* first knot 0 s and the last 1.14 s; eva"
    ):
        stride(Ends.CLAMPED).matrix(np.array([0.5, t]))


def test_an_instant_at_the_end_but_for_rounding_is_at_the_end() -> None:
    spline = SmoothingSpline(np.linspace(STRIDE / 2, STRIDE, 5), np.zeros(5), Ends.CLAMPED)
    ends = np.array([STRIDE / 2, STRIDE])
    for d in range(4):
        found = spline.matrix(ends + np.array([-2e-16, 4e-16]), d)
        np.testing.assert_array_equal(found, spline.matrix(ends, d))


@pytest.mark.parametrize("t", [np.nan, -np.inf])
def test_an_instant_that_is_no_number_is_refused(t: float) -> None:
    with pytest.raises(InputError, match=r"t = (nan|-inf): must be a list of finite instants; eva"):
        stride(Ends.PERIODIC).matrix(np.array([0.5, t]))


@pytest.mark.parametrize("ends", Ends)
def test_a_table_of_instants_is_refused(ends: Ends) -> None:
    with pytest.raises(InputError, match=r"t = \(2, 2\): must be a list of .*instants"):
        stride(ends).matrix(np.zeros((2, 2)))


@pytest.mark.parametrize("derivative", [-1, 4])
def test_a_derivative_that_a_cubic_does_not_have_is_refused(derivative: int) -> None:
    with pytest.raises(InputError, match=f"derivative = {derivative}: must be 0, 1, 2 or 3; a cub"):
        stride(Ends.PERIODIC).matrix([0.5], derivative)


@pytest.mark.parametrize(
    ("ends", "message"),
    [
        (Ends.CLAMPED, r"p.shape = \(5,\): must be 7 numbers; .*, then the two end slopes"),
        (Ends.PERIODIC, r"p.shape = \(5,\): must be 4 numbers; .* but the last, .* first again"),
    ],
)
def test_data_of_another_length_are_refused(ends: Ends, message: str) -> None:
    with pytest.raises(InputError, match=message):
        stride(ends)(np.array([0.5]), np.zeros(5))
    with pytest.raises(InputError, match=message):
        stride(ends).functional(np.zeros(5))
