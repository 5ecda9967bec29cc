"""The massless two-link foot: its balance, its centre of pressure, and its toe-tip chain."""

from __future__ import annotations

from typing import Any

import numpy as np

from ergowalk.body import LegParameters
from ergowalk.mechanics.kinematics import LegPoints, Point, Rotation, Vector


def foot_balance(
    points: LegPoints, ankle_moment: Any, metatarsal_moment: Any, reaction: Vector
) -> Any:
    """Sixth line of (1): p - w + (y_A - y_M) R_x + (x_M - x_A) R_y, zero in balance [N m]."""
    (x_a, y_a), (x_m, y_m) = points.ankle.position, points.metatarsal.position
    return ankle_moment - metatarsal_moment + (y_a - y_m) * reaction[0] + (x_m - x_a) * reaction[1]


def toe_balance(
    points: LegPoints, metatarsal_moment: Any, reaction: Vector, center_of_pressure: Any
) -> Any:
    """Last line of (1): w + y_M R_x + (x_R - x_M) R_y, zero in balance [N m]; y_R = 0."""
    x_m, y_m = points.metatarsal.position
    return metatarsal_moment + y_m * reaction[0] + (center_of_pressure - x_m) * reaction[1]


def pressure_moment(points: LegPoints, ankle_moment: Any, reaction: Vector) -> Any:
    """x_R R_y [N m] from the sum of the two foot lines of (1): p + y_A R_x + (x_R - x_A) R_y = 0.

    Linear in moment and reaction, so it stays meaningful where the vertical reaction vanishes.
    """
    x_a, y_a = points.ankle.position
    return x_a * reaction[1] - y_a * reaction[0] - ankle_moment


def ankle_moment_under(points: LegPoints, reaction: Vector, center_of_pressure: Any) -> Any:
    """Ankle moment p [N m] that a reaction at ``center_of_pressure`` [m] needs."""
    x_a, y_a = points.ankle.position
    return -y_a * reaction[0] - (center_of_pressure - x_a) * reaction[1]


def metatarsal_moment_under(points: LegPoints, reaction: Vector, center_of_pressure: Any) -> Any:
    """Metatarsal moment w [N m] that a reaction at ``center_of_pressure`` [m] needs."""
    x_m, y_m = points.metatarsal.position
    return -y_m * reaction[0] - (center_of_pressure - x_m) * reaction[1]


def reaction_from_moments(
    points: LegPoints, ankle_moment: Any, metatarsal_moment: Any, center_of_pressure: Any
) -> Vector:
    """Ground reaction (R_x, R_y) [N] from the two foot lines of (1), x_R being known.

    Singular only where ankle, metatarsal joint and centre of pressure are in one line.
    """
    (x_a, y_a), (x_m, y_m) = points.ankle.position, points.metatarsal.position
    x_r = center_of_pressure
    determinant = y_a * (x_r - x_m) - y_m * (x_r - x_a)
    r_x = (-ankle_moment * (x_r - x_m) + metatarsal_moment * (x_r - x_a)) / determinant
    r_y = (-y_a * metatarsal_moment + y_m * ankle_moment) / determinant
    return r_x, r_y


def toe_chain(leg: LegParameters, ankle: Point, toe_tip: Vector) -> tuple[Rotation, Rotation]:
    """Foot and toe rotation (gamma, epsilon) of a foot that stands on its toe tip, (7).

    The two-link chain A-M-T between a moving ankle and a resting toe tip, bent with the
    metatarsal joint down and forward (epsilon > gamma), with exact rates and accelerations.
    NumPy only: numbers or arrays (n,) of SI units. A chain out of reach gives NaN, without a
    warning; one exactly stretched or folded has no finite rates.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return _toe_chain(leg, ankle, toe_tip)


def _toe_chain(leg: LegParameters, ankle: Point, toe_tip: Vector) -> tuple[Rotation, Rotation]:
    c, l_m = leg.ankle_to_metatarsal, leg.toe_length
    d_x, d_y = toe_tip[0] - ankle.position[0], toe_tip[1] - ankle.position[1]
    square = d_x**2 + d_y**2
    at_ankle = np.arccos((square + c**2 - l_m**2) / (2 * c * np.sqrt(square)))
    at_toe = np.arccos((square + l_m**2 - c**2) / (2 * l_m * np.sqrt(square)))
    line = np.arctan2(d_x, -d_y)  # angle of A -> T from the downward vertical
    gamma, epsilon = line - at_ankle, line + at_toe

    # D = c down(gamma) + l_m down(epsilon) differentiated once and twice; each time a 2 x 2 system
    def solve(right_x: Any, right_y: Any) -> tuple[Any, Any]:
        a11, a12 = c * np.cos(gamma), l_m * np.cos(epsilon)
        a21, a22 = c * np.sin(gamma), l_m * np.sin(epsilon)
        determinant = a11 * a22 - a12 * a21
        return (
            (right_x * a22 - a12 * right_y) / determinant,
            (a11 * right_y - a21 * right_x) / determinant,
        )

    gamma_rate, epsilon_rate = solve(-ankle.velocity[0], -ankle.velocity[1])
    pull_x = c * gamma_rate**2 * np.sin(gamma) + l_m * epsilon_rate**2 * np.sin(epsilon)
    pull_y = c * gamma_rate**2 * np.cos(gamma) + l_m * epsilon_rate**2 * np.cos(epsilon)
    gamma_acc, epsilon_acc = solve(-ankle.acceleration[0] + pull_x, -ankle.acceleration[1] - pull_y)
    return Rotation(gamma, gamma_rate, gamma_acc), Rotation(epsilon, epsilon_rate, epsilon_acc)
