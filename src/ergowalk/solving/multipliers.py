"""Multipliers that a solver does not tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ergowalk.nlp import NonlinearProgramme
from ergowalk.solvers.ipopt import Minimum
from ergowalk.solving.stages import StageResult


def with_fixed_multipliers(result: StageResult) -> Minimum:
    """The minimum with the multipliers of fixed variables, which the solver never sees.

    They are what is missing to stationarity: gradient plus Jacobian' multipliers of rows plus
    multipliers of bounds is zero.
    """
    return with_fixed(result.collocation.programme, result.minimum)


def with_fixed(programme: NonlinearProgramme, minimum: Minimum) -> Minimum:
    """As :func:`with_fixed_multipliers`, for a minimum of any programme."""
    gradient = np.asarray(programme.oracle.gradient(minimum.x, [])[1]).ravel()
    jacobian = programme.oracle.jacobian(minimum.x, [])[1]
    rest = -gradient - np.asarray(jacobian.T @ minimum.row_multipliers).ravel()
    fixed = programme.lower == programme.upper
    bounds = np.where(fixed, rest, minimum.variable_multipliers)
    return replace(minimum, variable_multipliers=bounds)
