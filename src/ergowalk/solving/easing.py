"""The search for a gait whose devices leave no room for a moment of the walker's own.

No motion near the human means obeys such a device, so it is fitted step by step: first the gait
without devices, then with them but with the help of the walker, at a price that rises until the
help is hardly worth it, then without.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ergowalk.problem import Design, Devices, GaitProblem
from ergowalk.problem.devices import EasedDevice
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving.stages import SEARCH_BARRIER, OrderSearch, StageResult, Start
from ergowalk.transcription.curves import Guess, Samples
from ergowalk.transcription.guess import with_devices
from ergowalk.transcription.halves import in_phases
from ergowalk.transcription.motion import body_motion, device_moment

Array = NDArray[np.float64]

STEPS = ((1.0, 400.0), (30.0, 1600.0), (1000.0, 6400.0))
"""Prices of the squared help per kg [s3/m2], one search after the other, and the stiffness
[N m/rad] of what stands for a lock."""


def needs_easing(problem: GaitProblem) -> bool:
    """Whether a device leaves no room for an own moment."""
    return any(EasedDevice.needed(device) for device in problem.devices.everything())


def eased(search: OrderSearch, bare: OrderSearch, result: StageResult) -> StageResult:
    """The gait of a phase order on few elements, its devices fitted step by step.

    ``result`` is where it begins: the gait of a search ``bare`` without those devices. Numbers of a
    design are held until the devices are alone.
    """
    problem, stage = search.problem.replace(design=Design()), bare
    for i, (price, stiffness) in enumerate(STEPS):
        if not result.minimum.converged:
            break
        devices, before = helped(problem.devices, price, stiffness), stage
        stage = _search(search, problem.replace(devices=devices))
        mesh, words = result.collocation.mesh, f"devices helped at {price:g}"
        start = Start.at(result.trajectory, fitted(stage, before, result))
        if i == 0:
            solver = Ipopt(tolerance=1e-3, barrier_end=SEARCH_BARRIER)
            result = stage.stage(words, mesh, start, solver)
        else:
            result = stage.stage(words, mesh, start, before=result)
    start = Start.at(result.trajectory, fitted(search, stage, result))
    mesh, design = result.collocation.mesh, search.problem.design
    alone = search.stage("devices alone", mesh, start, held=bool(design))
    return search.free_rhythm(alone) if design and alone.minimum.converged else alone


def without_devices(search: OrderSearch) -> OrderSearch:
    """The same search for a walker without any."""
    return _search(search, search.problem.replace(devices=Devices(), design=Design()))


def helped(devices: Devices, price: float, stiffness: float) -> Devices:
    """The devices with the help of the walker at a price, locks as stiff springs."""
    return devices.changed(lambda device: EasedDevice.of(device, price, stiffness))


def fitted(search: OrderSearch, before: OrderSearch, result: StageResult) -> Guess:
    """The curves of a stage ``before``, its joint moments divided anew for the devices now."""
    curves = result.trajectory.as_guess()
    here, there = (
        [(walker, phase) for _, walker, phase, _ in in_phases(s.halves, result.trajectory)]
        for s in (search, before)
    )

    def guess(i: int, fractions: Array) -> Samples:
        samples, (walker, phase), earlier = curves(i, fractions), here[i], there[i][0]
        motion = body_motion(walker, phase, samples)
        total = dict(samples.control)
        for role, contact in enumerate(phase.legs):
            for joint, _ in earlier.fittings.acting(role, contact):
                name = f"{joint}_{role + 1}"
                device = device_moment(earlier, phase, samples, motion, role, joint)
                total[name] = total.get(name, 0.0) + device
        return with_devices(walker, phase, replace(samples, control=total), motion)

    return guess


def _search(search: OrderSearch, problem: GaitProblem) -> OrderSearch:
    return OrderSearch(
        problem, search.orders, search.walker.smoothing, search.effort, search.report
    )
