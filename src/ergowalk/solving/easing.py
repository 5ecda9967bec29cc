"""The search for a gait whose devices leave no room for a moment of the walker's own.

No motion near the human means obeys such a device, so it is fitted step by step: first the gait
without devices, then with them but with the help of the walker, at a price that rises until the
help is hardly worth it, then without.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.rhythm import half_stride_phases
from ergowalk.problem import Design, Devices, GaitProblem
from ergowalk.problem.devices import EasedDevice
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving.stages import SEARCH_BARRIER, OrderSearch, StageResult, Start
from ergowalk.transcription.curves import Guess, Samples
from ergowalk.transcription.guess import with_devices
from ergowalk.transcription.motion import body_motion, device_moment
from ergowalk.transcription.perturbation import Perturbation

Array = NDArray[np.float64]

PRICES = (1.0, 30.0, 1000.0)
"""Prices of the squared help per kg [s3/m2], one search after the other."""


def needs_easing(problem: GaitProblem) -> bool:
    """Whether a device leaves no room for an own moment."""
    return any(isinstance(d, EasedDevice) for _, d in problem.devices.eased().items())


def eased(search: OrderSearch, perturbation: Perturbation | None = None) -> StageResult:
    """The gait of a phase order on few elements, its devices fitted step by step."""
    problem = search.problem.replace(design=Design())
    bare = _search(search, problem.replace(devices=Devices()))
    result = bare.fixed_rhythm(bare.fit(), perturbation)
    for i, price in enumerate(PRICES):
        helped = {
            joint: d.replace(help_price=price) if isinstance(d, EasedDevice) else d
            for joint, d in problem.devices.eased().items()
        }
        stage = _search(search, problem.replace(devices=problem.devices.replace(**helped)))
        mesh, words = result.collocation.mesh, f"devices helped at {price:g}"
        if i == 0:
            start = Start(fitted(stage, bare, result), result.trajectory.times)
            solver = Ipopt(tolerance=1e-3, barrier_end=SEARCH_BARRIER)
            result = stage.stage(words, mesh, start, solver)
        else:
            result = stage.stage(words, mesh, Start.at(result.trajectory), before=result)
        if not result.minimum.converged:
            break
    start = Start(fitted(search, stage, result), result.trajectory.times)
    mesh, design = result.collocation.mesh, search.problem.design
    alone = search.stage("devices alone", mesh, start, held=bool(design))
    return search.free_rhythm(alone) if design and alone.minimum.converged else alone


def fitted(search: OrderSearch, before: OrderSearch, result: StageResult) -> Guess:
    """The curves of a stage ``before``, its joint moments divided anew for the devices now."""
    phases, curves = half_stride_phases(search.order), result.trajectory.as_guess()

    def guess(i: int, fractions: Array) -> Samples:
        samples, phase = curves(i, fractions), phases[i]
        motion = body_motion(search.walker, phase, samples)
        total = dict(samples.control)
        for role, contact in enumerate(phase.legs):
            for joint, _ in before.walker.fittings.acting(role, contact):
                name = f"{joint}_{role + 1}"
                device = device_moment(before.walker, phase, samples, motion, role, joint)
                total[name] = total.get(name, 0.0) + device
        return with_devices(search.walker, phase, replace(samples, control=total), motion)

    return guess


def _search(search: OrderSearch, problem: GaitProblem) -> OrderSearch:
    return OrderSearch(problem, search.order, search.walker.smoothing, search.effort, search.report)
