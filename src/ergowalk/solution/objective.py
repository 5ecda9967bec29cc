"""The terms of the objective, on the dense curves of a gait."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ergowalk.gait.rhythm import Contact
from ergowalk.problem import GaitProblem
from ergowalk.problem.objective import WEIGHTS, Objective
from ergowalk.quantities import DEVICE_MOMENT, JOINTS
from ergowalk.solution.energy import absolute_integrals, smooth_pieces

Array = NDArray[np.float64]

GAUSS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Exact for the square of a cubic."""


def objective_terms(dataset: xr.Dataset, problem: GaitProblem) -> dict[str, float]:
    """Every term of the objective with its weight [J/m]; those of no weight are left out."""
    objective, mass = problem.objective, problem.body.total_mass
    distance = 2 * problem.step_length_m
    time = dataset["time"].to_numpy()
    power = dataset["joint_power"].transpose("time", "leg", "joint").to_numpy()
    parts = _works(time, power.reshape(len(power), -1), objective)
    if objective.charges_moments:
        value, rate = _squares(time, own_moments(dataset) / mass)
        parts["moment_squared_s_per_m2"] = mass * value
        parts["moment_rate_squared_s3_per_m2"] = mass * rate
    weights = {name: getattr(objective, name) for name in WEIGHTS}
    return {name: w * parts[name] / distance for name, w in weights.items() if w}


def objective_per_metre(dataset: xr.Dataset, problem: GaitProblem) -> float:
    """What was minimised [J/m], from the dense curves."""
    return sum(objective_terms(dataset, problem).values())


def own_moments(dataset: xr.Dataset) -> Array:
    """Moments that the walker itself gives, (n, 8) [N m].

    Up to heel-off the stored metatarsal moment only balances the last line of (1): the toes move
    with the sole, and what a muscle must give is zero.
    """
    moment = dataset["joint_moment"].transpose("time", "leg", "joint").to_numpy().copy()
    if DEVICE_MOMENT in dataset:
        moment -= dataset[DEVICE_MOMENT].transpose("time", "leg", "joint").to_numpy()
    phase = dataset["contact_phase"].transpose("time", "leg").to_numpy()
    standing = np.isin(phase, (Contact.HEEL, Contact.FLAT))
    moment[..., JOINTS.index("metatarsal")][standing] = 0.0
    return moment.reshape(len(moment), -1)


def _works(time: Array, powers: Array, objective: Objective) -> dict[str, float]:
    """Integrals over the stride [J] of what each term of work charges."""
    absolute = float(np.sum(absolute_integrals(time, powers)))
    signed = 0.0
    for piece in smooth_pieces(time):
        found = CubicSpline(time[piece], powers[piece]).integrate(time[piece][0], time[piece][-1])
        signed += float(np.sum(found))
    positive, negative = (absolute + signed) / 2, (absolute - signed) / 2
    muscle = positive / objective.positive_efficiency + negative / objective.negative_efficiency
    return {
        "absolute_work": absolute,
        "positive_work": positive,
        "muscle_work": muscle,
        "regenerative_work": positive - objective.regenerated_share * negative,
    }


def _squares(time: Array, moments: Array) -> tuple[float, float]:
    """Integrals of squared moments and squared rates; jumps between pieces cost nothing."""
    value, rate = 0.0, 0.0
    for piece in smooth_pieces(time):
        t = time[piece]
        spline = CubicSpline(t, moments[piece])
        half = np.diff(t)[:, None] / 2
        at = (t[:-1, None] + half) + half * GAUSS
        weights = (half * GAUSS_WEIGHTS)[..., None]
        value += float(np.sum(weights * spline(at) ** 2))
        rate += float(np.sum(weights * spline(at, 1) ** 2))
    return value, rate
