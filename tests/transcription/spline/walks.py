"""Programmes and unknowns that the tests of the paper's transcription share."""

from __future__ import annotations

from functools import cache

import numpy as np

import ergowalk
from ergowalk.gait.rhythm import PhaseOrder, Rhythm
from ergowalk.problem import DoubleSupport, GaitProblem
from ergowalk.transcription.spline.programme import SplineProgramme

RHYTHMS = {
    PhaseOrder.TOE_OFF_FIRST: Rhythm(heel_end=0.10, heel_off=0.23, toe_off=0.58),
    PhaseOrder.FLAT_FIRST: Rhythm(heel_end=0.07, heel_off=0.23, toe_off=0.60),
}


def problem(sharing: DoubleSupport = DoubleSupport.OPTIMAL) -> GaitProblem:
    return ergowalk.preset("berbyuk2002").model_copy(update={"double_support": sharing})


@cache
def programme(
    order: PhaseOrder = PhaseOrder.TOE_OFF_FIRST,
    sharing: DoubleSupport = DoubleSupport.OPTIMAL,
    extras: tuple[str, ...] = (),
) -> SplineProgramme:
    return SplineProgramme(problem(sharing), RHYTHMS[order], intervals=9, rho=1e-6, extras=extras)


def unknowns(size: int, seed: int, scale: float) -> np.ndarray:
    return scale * np.random.default_rng(seed).standard_normal(size)
