"""E of (10) from samples: exact where it can be, convergent where not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from ergowalk.solution.energy import absolute_integrals, joint_energies, smooth_pieces


def absolute_integral(time, power) -> float:
    """Of one power."""
    return float(absolute_integrals(time, np.asarray(power)[:, None])[0])


Array = NDArray[np.float64]

LAW = settings(deadline=None, max_examples=60, derandomize=True, database=None)

grids = st.integers(4, 12).flatmap(
    lambda n: arrays(np.float64, n - 1, elements=st.floats(0.05, 1.0))
)
"""Steps between samples, as unequal as they like."""


@dataclass(frozen=True)
class Cubic:
    """Power on one piece, a cubic whose roots are known: inside the piece, or beside it."""

    time: Array
    scale: float
    roots: Array

    @property
    def power(self) -> Array:
        return np.asarray(Polynomial.fromroots(self.roots)(self.time) * self.scale)

    @property
    def work(self) -> float:
        """Integral of the absolute power, cut at the roots."""
        start, end = self.time[0], self.time[-1]
        inside = self.roots[(self.roots > start) & (self.roots < end)]
        integral = self.scale * Polynomial.fromroots(self.roots).integ()
        return float(np.abs(np.diff(integral(np.array([start, *np.sort(inside), end])))).sum())


@st.composite
def cubics(draw: st.DrawFn, start: float = 0.3) -> Cubic:
    time = start + np.concatenate([[0.0], np.cumsum(draw(grids))])
    places = draw(arrays(np.float64, 3, elements=st.floats(-0.5, 1.5)))
    roots = time[0] + places * (time[-1] - time[0])
    return Cubic(time, draw(st.floats(-4, 4)), roots)


@LAW
@given(cubics())
def test_a_cubic_with_its_sign_changes_is_exact(piece: Cubic) -> None:
    tolerance = 1e-9 * (1 + np.abs(piece.power).max() * np.ptp(piece.time))
    assert absolute_integral(piece.time, piece.power) == pytest.approx(piece.work, abs=tolerance)


@LAW
@given(cubics(), cubics())
def test_pieces_add_up_and_jumps_between_them_cost_nothing(first: Cubic, second: Cubic) -> None:
    shift = first.time[-1] - second.time[0]
    second = Cubic(second.time + shift, second.scale, second.roots + shift)
    found = absolute_integral(
        np.concatenate([first.time, second.time]), np.concatenate([first.power, second.power])
    )
    size = 1 + max(np.abs(p.power).max() * np.ptp(p.time) for p in (first, second))
    assert found == pytest.approx(first.work + second.work, abs=1e-9 * size)


def test_a_sign_change_inside_a_jump_is_not_smeared() -> None:
    t = np.concatenate([np.linspace(0, 1, 5), np.linspace(1, 2, 5)])
    power = np.concatenate([np.full(5, 3.0), np.full(5, -2.0)])
    assert absolute_integral(t, power) == pytest.approx(5.0, abs=1e-13)


def test_smooth_power_converges_with_the_fourth_power_of_the_step() -> None:
    """Integral of |sin(7 t + 1)| e^-t over [0, 2], from an antiderivative."""

    def primitive(t: Array) -> Array:
        wave = -np.sin(7 * t + 1) - 7 * np.cos(7 * t + 1)
        return np.asarray(np.exp(-t) * wave / 50)

    zeros = (np.pi * np.arange(1, 5) - 1) / 7
    cuts = np.concatenate([[0.0], zeros[zeros < 2.0], [2.0]])
    exact = float(np.abs(np.diff(primitive(cuts))).sum())
    errors = []
    for n in (20, 40, 80, 160):
        t = np.linspace(0.0, 2.0, n + 1)
        errors.append(abs(absolute_integral(t, np.sin(7 * t + 1) * np.exp(-t)) - exact))
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert errors[-1] < 1e-7
    assert orders.mean() > 3.7


def test_no_power_is_no_energy() -> None:
    t = np.linspace(0, 1, 9)
    assert absolute_integral(t, np.zeros(9)) == 0.0
    partly = np.concatenate([np.zeros(9), np.ones(9)])
    assert absolute_integral(np.concatenate([t, 1 + t]), partly) == pytest.approx(1.0)


@pytest.mark.parametrize("n", [2, 3])
def test_pieces_of_two_and_three_samples_are_a_line_and_a_parabola(n: int) -> None:
    t = np.linspace(0.0, 1.0, n)
    polynomial = Polynomial.fromroots([0.3]) if n == 2 else Polynomial.fromroots([0.2, 0.7])
    # 0.3^2/2 + 0.7^2/2; for the parabola 1/3 - 0.45 + 0.14 and twice the 0.5^3/6 below zero
    area = 0.29 if n == 2 else 1 / 3 - 0.45 + 0.14 + 2 * 0.5**3 / 6
    assert absolute_integral(t, polynomial(t)) == pytest.approx(area, abs=1e-14)


def test_pieces_end_where_time_stands_still() -> None:
    time = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 4.0])
    assert [(p.start, p.stop) for p in smooth_pieces(time)] == [(0, 3), (3, 5), (6, 8)]


def test_what_is_not_a_number_is_not_counted() -> None:
    """A motion out of reach has no power; its E is for the record only."""
    t = np.linspace(0.0, 1.0, 11)
    power = np.full(11, 4.0)
    power[[0, 5]] = np.nan, np.inf
    assert absolute_integral(t, power) == pytest.approx(4.0 * (0.3 + 0.4))
    assert absolute_integral(t, np.full(11, np.nan)) == 0.0


def test_energies_of_joints_count_both_legs() -> None:
    t = np.linspace(0.0, 2.0, 11)
    power = np.zeros((11, 2, 2))
    power[:, 0, 0], power[:, 1, 0], power[:, 1, 1] = 3.0, -1.0, 2.0
    dataset = xr.Dataset(
        {"joint_power": (("time", "leg", "joint"), power)},
        coords={"time": t, "joint": ["hip", "knee"]},
    )
    assert joint_energies(dataset) == pytest.approx({"hip": 8.0, "knee": 4.0})
