"""Problem B of the paper: the smoothing cubic spline, eqs (13)-(15).

Of all curves S in C2[a, b] with given end slopes (14) or periodic ends (15), the spline has least

    J(S) = integral of S''^2 dt + sum_j (S(t_j) - z_j)^2 / rho_j        (13)

It is a cubic between neighbouring knots. For given knots and rho it depends linearly on its data,
so the map from data to curve is solved for once.

Write s for the values and M for the second derivatives at the knots, K and A for stiffness and
mass matrix of piecewise linear functions on the knots, f = K M and r = s - z. Then

    A M + K s = e          slopes are continuous; e = (-S'(a), 0, ..., 0, S'(b)), or 0 if periodic
    r_j = rho_j f_j        J is stationary: f_j is minus the jump of S''' at the knot, S''' being
                           zero outside [a, b]

In here time is measured in mean steps h = (b - a) / n, which makes rho / h^3 a pure number and the
entries of both matrices about 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ergowalk.errors import InputError

Array = NDArray[np.float64]
IndexArray = NDArray[np.intp]

ROUNDING = 1e-12
"""How far outside the knots an instant may lie, relative to the larger end, and still count."""


class Ends(Enum):
    """What is asked of the two ends of a curve."""

    CLAMPED = "clamped"
    """Given slopes (14)."""

    PERIODIC = "periodic"
    """Value, slope and curvature the same at both ends (15)."""


@dataclass(frozen=True)
class SmoothingSpline:
    """Smoothing splines on given knots, eqs (13)-(15), for any data p.

    Clamped, p = (z_0, ..., z_n, S'(a), S'(b)); periodic, p = (z_0, ..., z_{n-1}), z_n being z_0.

    Parameters
    ----------
    knots : (n + 1,) array
        Instants a = t_0 < ... < t_n = b [s]; two or more if clamped, three or more if periodic.
    rho : (n + 1,) array
        Freedom of each knot [s^3], zero or more: at zero the curve goes through the datum, the
        larger it is the smoother the curve. Periodic, first and last are the same knot, counted
        once in (13).
    ends : Ends

    Raises
    ------
    InputError
        If knots or rho cannot be used.
    """

    knots: Array
    rho: Array
    ends: Ends

    def __post_init__(self) -> None:
        for name in ("knots", "rho"):  # own copies: the map below is solved for only once
            own = np.array(getattr(self, name), dtype=float)
            own.flags.writeable = False
            object.__setattr__(self, name, own)
        _check_knots(self.knots, self.ends)
        _check_rho(self.rho, self.knots, self.ends)

    @property
    def parameters(self) -> int:
        """Length of p: n + 3 if clamped, n if periodic."""
        n = len(self.knots) - 1
        return n + 3 if self.ends is Ends.CLAMPED else n

    def matrix(self, t: ArrayLike, derivative: int = 0) -> Array:
        """The matrix D with S^(d)(t) = D p.

        Parameters
        ----------
        t : (k,) array
            Instants [s]: within the knots if clamped, anywhere if periodic.
        derivative : int
            d from 0 to 3. The third derivative jumps at a knot; its right-hand value is given
            (at the last of clamped knots, the left-hand one).

        Returns
        -------
        (k, parameters) array, per s^d (the columns of the end slopes times s).

        Raises
        ------
        InputError
            If an instant lies outside clamped knots, or there is no such derivative.
        """
        if derivative not in range(4):
            raise InputError(
                "must be 0, 1, 2 or 3",
                "a cubic has no further derivatives",
                field="derivative",
                value=derivative,
            )
        left, u = self._place(t)
        h = self._steps[left]
        right = (left + 1) % len(self._maps.values)
        on_values, on_curvatures = _weights(derivative, u, h)
        maps = self._maps
        found = sum(
            value[:, None] * maps.values[at] + curvature[:, None] * maps.curvatures[at]
            for at, value, curvature in zip((left, right), on_values, on_curvatures, strict=True)
        )
        matrix: Array = np.asarray(found) / self._unit**derivative
        return matrix

    def __call__(self, t: ArrayLike, p: ArrayLike, derivative: int = 0) -> Array:
        """S^(d)(t) for data p: (k,) array; see :meth:`matrix`."""
        curve: Array = self.matrix(t, derivative) @ self._data(p)
        return curve

    def functional(self, p: ArrayLike) -> float:
        """Least value J(S) of (13) for data p; an interpolated knot contributes nothing."""
        data = self._data(p)
        curvature, residual = self._maps.curvatures @ data, self._maps.residuals @ data
        force = self._stiffness @ curvature
        rho = self._freedom
        # r^2 / rho = rho f^2; where rho is small f is the accurate one, where large r
        misfit = np.where(rho < 1, rho * force**2, residual**2 / np.maximum(rho, 1))
        return float(curvature @ self._mass @ curvature + misfit.sum()) / self._unit**3

    @property
    def _unit(self) -> float:
        return float(self.knots[-1] - self.knots[0]) / (len(self.knots) - 1)

    @property
    def _steps(self) -> Array:
        steps: Array = np.diff(self.knots) / self._unit
        return steps

    @property
    def _freedom(self) -> Array:
        """Rho of each knot, the joint knot once, in units of h^3."""
        count = len(self.knots) - (self.ends is Ends.PERIODIC)
        return self.rho[:count] / self._unit**3

    @cached_property
    def _mass(self) -> Array:
        """A: integrals of products of the hat functions of the knots."""
        h = self._steps
        return self._assembled(h / 3, h / 6)

    @cached_property
    def _stiffness(self) -> Array:
        """K: integrals of products of the derivatives of the hat functions."""
        h = self._steps
        return self._assembled(1 / h, -1 / h)

    def _assembled(self, same: Array, other: Array) -> Array:
        count = len(self._freedom)
        left = np.arange(len(same))
        right = (left + 1) % count
        matrix = np.zeros((count, count))
        np.add.at(matrix, (left, left), same)
        np.add.at(matrix, (right, right), same)
        np.add.at(matrix, (left, right), other)
        np.add.at(matrix, (right, left), other)
        return matrix

    @cached_property
    def _maps(self) -> _Maps:
        """Solve for M and for r of the knots that are not interpolated (r = 0 at the others)."""
        mass, stiffness, rho = self._mass, self._stiffness, self._freedom
        count, free = len(rho), np.flatnonzero(rho > 0)
        data = np.eye(count, self.parameters)
        slopes = np.zeros_like(data)
        if self.ends is Ends.CLAMPED:
            slopes[0, -2], slopes[-1, -1] = -self._unit, self._unit
        # rho f - r = 0, divided by 1 + rho: bounded however large rho is
        share = 1 / (1 + rho[free])
        stationary = (rho[free] * share)[:, None] * stiffness[free]
        system = np.block([[mass, stiffness[:, free]], [stationary, -np.diag(share)]])
        if len(free) == count:
            # Since the f_j add up to zero, so do r_j / rho_j. For large rho nothing else would
            # tell how high the curve lies, so this takes the place of the row of least rho.
            row = int(np.argmin(rho))
            system[count + row] = np.concatenate([np.zeros(count), rho[row] / rho])
        given = np.zeros((count + len(free), self.parameters))
        given[:count] = slopes - stiffness @ data
        solved = np.linalg.solve(system, given)
        solved += np.linalg.solve(system, given - system @ solved)  # gains a digit
        residuals = np.zeros_like(data)
        residuals[free] = solved[count:]
        return _Maps(data + residuals, solved[:count], residuals)

    def _place(self, t: ArrayLike) -> tuple[IndexArray, Array]:
        """Interval of each instant and the fraction of it that has passed."""
        t = np.atleast_1d(np.asarray(t, dtype=float))
        a, b = float(self.knots[0]), float(self.knots[-1])
        slack = ROUNDING * max(abs(a), abs(b))
        allowed = np.isfinite(t)
        if self.ends is Ends.CLAMPED:
            allowed &= (t >= a - slack) & (t <= b + slack)
        if t.ndim != 1 or not allowed.all():
            raise InputError(
                f"must be a list of instants between the first knot {a:g} s and the last {b:g} s"
                if self.ends is Ends.CLAMPED
                else "must be a list of finite instants",
                "evaluate the curve where it is defined",
                field="t",
                value=t.shape if t.ndim != 1 else float(t[~allowed][0]),
            )
        if self.ends is Ends.CLAMPED:
            inside = np.clip(t, a, b)
        else:  # wrapping rounds: a knot must stay where it is
            inside = np.where((t >= a) & (t < b), t, a + np.mod(t - a, b - a))
        left = np.searchsorted(self.knots, inside, "right") - 1
        left = np.minimum(left, len(self.knots) - 2)
        return left, (inside - self.knots[left]) / np.diff(self.knots)[left]

    def _data(self, p: ArrayLike) -> Array:
        data = np.asarray(p, dtype=float)
        if data.shape != (self.parameters,):
            raise InputError(
                f"must be {self.parameters} numbers",
                "give a value for each knot, then the two end slopes"
                if self.ends is Ends.CLAMPED
                else "give a value for each knot but the last, which is the first again",
                field="p.shape",
                value=data.shape,
            )
        return data


@dataclass(frozen=True)
class _Maps:
    """Values s, curvatures M and residuals r at the knots as matrices: each times p.

    Shape (knots, parameters), the joint knot of a periodic curve once.
    """

    values: Array
    curvatures: Array
    residuals: Array


def _weights(derivative: int, u: Array, h: Array) -> tuple[tuple[Array, Array], ...]:
    """What left and right value, left and right curvature contribute at fraction u of a step h."""
    v = 1 - u
    if derivative == 0:
        return (v, u), (-(h**2) / 6 * (v - v**3), -(h**2) / 6 * (u - u**3))
    if derivative == 1:
        return (-1 / h, 1 / h), (h / 6 * (1 - 3 * v**2), h / 6 * (3 * u**2 - 1))
    zero = np.zeros_like(u)
    return (zero, zero), ((v, u) if derivative == 2 else (-1 / h, 1 / h))


def _check_knots(knots: Array, ends: Ends) -> None:
    least = 2 if ends is Ends.CLAMPED else 3
    if knots.ndim != 1 or len(knots) < least:
        raise InputError(
            f"must be a list of {least} or more instants for {ends.value} ends",
            "add knots",
            field="knots.shape",
            value=knots.shape,
        )
    wrong = np.flatnonzero(~np.isfinite(knots))
    if len(wrong):
        raise InputError(
            "must be a finite number",
            "give every knot in seconds",
            field=f"knots[{wrong[0]}]",
            value=float(knots[wrong[0]]),
        )
    wrong = np.flatnonzero(np.diff(knots) <= 0) + 1
    if len(wrong):
        raise InputError(
            f"must be later than the knot before it, {knots[wrong[0] - 1]:g} s",
            "sort the knots and give each once",
            field=f"knots[{wrong[0]}]",
            value=float(knots[wrong[0]]),
        )


def _check_rho(rho: Array, knots: Array, ends: Ends) -> None:
    if rho.shape != knots.shape:
        raise InputError(
            f"must have one number for each of the {len(knots)} knots",
            "give zero where the curve is to go through its datum",
            field="rho.shape",
            value=rho.shape,
        )
    wrong = np.flatnonzero(~(np.isfinite(rho) & (rho >= 0)))
    if len(wrong):
        raise InputError(
            "must be finite and not negative",
            "give zero to interpolate, a large number to smooth",
            field=f"rho[{wrong[0]}]",
            value=float(rho[wrong[0]]),
        )
    if ends is Ends.PERIODIC and rho[0] != rho[-1]:
        raise InputError(
            f"must equal rho[0] = {rho[0]:g}",
            "the two ends of a periodic curve are one knot",
            field="rho[-1]",
            value=float(rho[-1]),
        )
