"""The terms of the objective on dense curves: identities, and squares with known integrals."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from ergowalk.problem import GaitProblem, Objective, preset
from ergowalk.solution.objective import objective_per_metre, objective_terms

PAPER: GaitProblem = preset("berbyuk2002-rhythm")

CLOSES = 1e-5
"""Relative: the signed work of a periodic walk is zero as far as quadrature tells."""


def value(gait: xr.Dataset, **weights: float) -> float:
    """The objective of some weights alone [J/m]."""
    objective = Objective(**{"absolute_work": 0.0, **weights})
    return objective_per_metre(gait, PAPER.replace(objective=objective))


def test_without_weights_of_its_own_it_is_e(paper_gait: xr.Dataset) -> None:
    energy = paper_gait.attrs["energy_per_metre"]
    assert value(paper_gait, absolute_work=1.0) == pytest.approx(energy, rel=1e-12)
    assert paper_gait.attrs["objective_per_metre"] == energy


def test_what_a_periodic_walk_gains_it_loses(paper_gait: xr.Dataset) -> None:
    """No ground and no device takes work, so each cost of work is a multiple of E."""
    energy = paper_gait.attrs["energy_per_metre"]
    assert value(paper_gait, positive_work=1.0) == pytest.approx(energy / 2, rel=CLOSES)
    muscles = (1 / 0.25 + 1 / 1.2) / 2 * energy
    assert value(paper_gait, muscle_work=1.0) == pytest.approx(muscles, rel=CLOSES)
    back = value(paper_gait, regenerative_work=1.0, regenerated_share=0.3)
    assert back == pytest.approx(0.35 * energy, rel=CLOSES)


def test_a_weighted_sum_is_the_sum_of_its_terms(paper_gait: xr.Dataset) -> None:
    objective = Objective(absolute_work=0.5, muscle_work=0.1, moment_squared_s_per_m2=0.2)
    problem = PAPER.replace(objective=objective)
    terms = objective_terms(paper_gait, problem)
    assert list(terms) == ["absolute_work", "muscle_work", "moment_squared_s_per_m2"]
    assert objective_per_metre(paper_gait, problem) == pytest.approx(sum(terms.values()))
    assert terms["absolute_work"] == pytest.approx(paper_gait.attrs["energy_per_metre"] / 2)


def test_squares_of_a_wave_and_of_its_rate() -> None:
    """A hip moment A sin(2 pi t / T): the integrals are A^2 T / 2 and (2 pi / T)^2 of that."""
    stride, size = PAPER.stride_time_s, 40.0
    time = np.linspace(0.0, stride, 801)
    moment = np.zeros((len(time), 2, 4))
    moment[:, 0, 0] = size * np.sin(2 * np.pi * time / stride)
    moment[:, :, 3] = 7.0  # of no muscle while the foot is flat
    gait = xr.Dataset(
        {
            "joint_moment": (("time", "leg", "joint"), moment),
            "joint_power": (("time", "leg", "joint"), 0 * moment),
            "contact_phase": (("time", "leg"), np.full((len(time), 2), 2)),
        },
        coords={"time": time},
    )
    squared = size**2 * stride / 2 / PAPER.body.total_mass / (2 * PAPER.step_length_m)
    assert value(gait, moment_squared_s_per_m2=1.0) == pytest.approx(squared, rel=1e-8)
    rates = (2 * np.pi / stride) ** 2 * squared
    assert value(gait, moment_rate_squared_s3_per_m2=1.0) == pytest.approx(rates, rel=1e-8)
