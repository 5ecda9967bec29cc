"""The free functions (11) as smoothing splines, and which of their data are unknowns (18).

On [0, T/2], leg 1 leading; the second half repeats it with the legs exchanged, so gamma_2 and
alpha_1 on [T/2, T] are gamma_1 and alpha_2 again and have no unknowns of their own. A curve of
(11) that changes its law at a phase change is one spline per stretch:

=========== =================== ================== ==========================================
name        function            interval           given by the equality constraints
=========== =================== ================== ==========================================
knee        mu_1^k              [0, T], periodic   nothing; mu_2^k(t) = mu_1^k(t + T/2)
hip         x - 2 L t / T       [0, T/2], periodic knot 0: both legs on their prints (4), (5)
trunk       x_g - 2 L t / T     [0, T/2], periodic knot 0, from psi_0
foot_heel   gamma_1             [0, tau_h]         flat at rest at tau_h; slope at 0 held
foot_rise   gamma_1             [tau_m, T/2]       flat at rest at tau_m; slope at T/2 by (2)
thigh_toe   alpha_2             [0, tau_s]         both ends: (2) and toe-off (7)
thigh_swing alpha_2             [tau_s, T/2]       both ends: toe-off (7) and (2)
swing_foot  mu_2^a - human mean [tau_s, T/2]       both ends: (7), (2); interior held
force_toe   R_2x less (12)      [0, tau_s]         both ends zero; all else held at zero
=========== =================== ================== ==========================================

The knots of all of them are those of one grid, in which every phase change is a knot.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import Rhythm, boundary_fractions, half_stride_phases
from ergowalk.problem import GaitProblem
from ergowalk.transcription.spline.smoothing import Ends, SmoothingSpline

Array = NDArray[np.float64]

KNEE, HIP, TRUNK = "knee", "hip", "trunk"
FOOT_HEEL, FOOT_RISE = "foot_heel", "foot_rise"
THIGH_TOE, THIGH_SWING = "thigh_toe", "thigh_swing"
SWING_FOOT, FORCE_TOE = "swing_foot", "force_toe"

START_SLOPE, END_SLOPE = -2, -1
"""Data of a clamped spline that are its end slopes."""

EXTRAS = ("heel_slope", "swing_foot", "force_toe")
"""What (18) holds at its initial value, and may be freed beyond it: slope of the foot at heel
contact, swing foot, and the horizontal force under the toe tip, which then bends away from (12)
by force_toe times the body's weight."""


def phase_times(problem: GaitProblem, rhythm: Rhythm) -> dict[str, float]:
    """Boundary instants [s] of the half stride."""
    stride = problem.stride_time_s
    return {name: f * stride for name, f in boundary_fractions(rhythm).items()}


LOAD_CHANGES = 2.0
"""How many times closer the knots are in double support than elsewhere."""


def knot_grid(changes: ArrayLike, intervals: int, density: ArrayLike = 1.0) -> Array:
    """Knots on [0, T/2]: every phase change, and phases divided so that no interval is long.

    Parameters
    ----------
    changes : (m + 1,) array
        Phase changes [s], both ends included.
    intervals : int
        Number of intervals of the half stride.
    density : (m,) array
        How close the knots of each phase are to be, relative to each other.

    Raises
    ------
    ProblemError
        If there are fewer than one interval per phase and three in all.
    """
    changes = np.asarray(changes, dtype=float)
    lengths = np.diff(changes) * density
    parts = np.ones(len(lengths), dtype=int)
    least = max(3, len(lengths))
    if intervals < least:
        raise ProblemError(
            f"must be {least} or more, one for each phase",
            "give more knots",
            field="intervals",
            value=intervals,
        )
    for _ in range(intervals - len(lengths)):
        parts[np.argmax(lengths / parts)] += 1
    pieces = [
        np.linspace(a, b, n + 1)[:-1]
        for a, b, n in zip(changes[:-1], changes[1:], parts, strict=True)
    ]
    return np.concatenate([*pieces, changes[-1:]])


@dataclass(frozen=True)
class Curve:
    """One spline, and where its data stand in the list of all data."""

    name: str
    spline: SmoothingSpline
    first: int

    @property
    def knots(self) -> int:
        """Number n of intervals of the spline."""
        return len(self.spline.knots) - 1

    def index(self, datum: int) -> int:
        """Place of a datum in the list of all data; negative ones count from the end."""
        return self.first + datum % self.spline.parameters


class Curves:
    """All splines of a problem with a given rhythm.

    Parameters
    ----------
    problem, rhythm
    intervals : int
        Knot intervals of the half stride.
    rho : float
        Freedom of the knots (17) [s^3], the same for all functions; zero at their ends.
    """

    def __init__(self, problem: GaitProblem, rhythm: Rhythm, intervals: int, rho: float) -> None:
        times = phase_times(problem, rhythm)
        self.phases = half_stride_phases(rhythm.order)
        self.times, self.half = times, times["half_stride"]
        changes = [times[p.start] for p in self.phases] + [self.half]
        density = [LOAD_CHANGES if p.double_support else 1.0 for p in self.phases]
        self.grid = knot_grid(changes, intervals, density)
        self.advance = 2 * problem.step_length_m / problem.stride_time_s
        grid, half = self.grid, self.half
        toe_off, flat, rise = (times[n] for n in ("other_toe_off", "heel_end", "heel_off"))
        both = np.concatenate([grid, grid[1:] + half])

        def within(a: float, b: float) -> Array:
            return grid[(grid >= a) & (grid <= b)]

        plan = {
            KNEE: (both, Ends.PERIODIC),
            HIP: (grid, Ends.PERIODIC),
            TRUNK: (grid, Ends.PERIODIC),
            FOOT_HEEL: (within(0.0, flat), Ends.CLAMPED),
            FOOT_RISE: (within(rise, half), Ends.CLAMPED),
            THIGH_TOE: (within(0.0, toe_off), Ends.CLAMPED),
            THIGH_SWING: (within(toe_off, half), Ends.CLAMPED),
            SWING_FOOT: (within(toe_off, half), Ends.CLAMPED),
            FORCE_TOE: (within(0.0, toe_off), Ends.CLAMPED),
        }
        self.all: dict[str, Curve] = {}
        first = 0
        for name, (knots, ends) in plan.items():
            freedom = np.full(len(knots), rho)
            freedom[[0, -1]] = 0.0
            if name == KNEE:
                freedom[len(grid) - 1] = 0.0  # the end of mu_1^k(., [0, T/2]), the start of mu_2^k
            self.all[name] = Curve(name, SmoothingSpline(knots, freedom, ends), first)
            first += self.all[name].spline.parameters
        self.psi = first
        self.size = first + 1

    def rows(self, name: str, times: ArrayLike, derivative: int) -> Array:
        """Matrix (len(times), size) that gives a function, or a derivative, from all data.

        Without the mean advance of hip and trunk, see :meth:`offset`.
        """
        curve = self.all[name]
        t = np.atleast_1d(np.asarray(times, dtype=float))
        rows = np.zeros((len(t), self.size))
        end = curve.first + curve.spline.parameters
        rows[:, curve.first : end] = curve.spline.matrix(t, derivative)
        return rows

    def offset(self, name: str, times: ArrayLike, derivative: int) -> Array:
        """What is added to the spline: the mean advance 2 L t / T of hip and trunk."""
        t = np.atleast_1d(np.asarray(times, dtype=float))
        if name not in (HIP, TRUNK) or derivative > 1:
            return np.zeros_like(t)
        return self.advance * (t if derivative == 0 else np.ones_like(t))

    def place(self, name: str, datum: int) -> int:
        """Index of a datum in the list of all data."""
        return self.all[name].index(datum)

    def unknowns(self, extras: tuple[str, ...] = ()) -> dict[str, int]:
        """Names and places of the entries of C in (18), and of the extras asked for."""
        found = {"psi[0]": self.psi}

        def take(name: str, data: range) -> None:
            found.update({f"{name}[{j}]": self.place(name, j) for j in data})

        take(KNEE, range(self.all[KNEE].knots))
        take(HIP, range(1, self.all[HIP].knots))
        take(TRUNK, range(1, self.all[TRUNK].knots))
        take(FOOT_HEEL, range(self.all[FOOT_HEEL].knots))
        take(FOOT_RISE, range(1, self.all[FOOT_RISE].knots + 1))
        take(THIGH_TOE, range(1, self.all[THIGH_TOE].knots))
        take(THIGH_SWING, range(1, self.all[THIGH_SWING].knots))
        if "heel_slope" in extras:
            found[f"{FOOT_HEEL}.slope[0]"] = self.place(FOOT_HEEL, START_SLOPE)
        if "swing_foot" in extras:
            take(SWING_FOOT, range(1, self.all[SWING_FOOT].knots))
        if "force_toe" in extras:
            n = self.all[FORCE_TOE].knots
            take(FORCE_TOE, range(1, n))
            found[f"{FORCE_TOE}.slope[0]"] = self.place(FORCE_TOE, START_SLOPE)
            found[f"{FORCE_TOE}.slope[{n}]"] = self.place(FORCE_TOE, END_SLOPE)
        return found
