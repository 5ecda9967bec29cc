"""Problem A: givens, constraints (2)-(9), objective (10), physical limits, presets."""

from ergowalk.problem.devices import Device, Devices
from ergowalk.problem.gait_problem import (
    JOINTS,
    Corridors,
    DoubleSupport,
    GaitProblem,
    JointBounds,
    Limits,
    RhythmBounds,
)
from ergowalk.problem.objective import Objective
from ergowalk.problem.presets import DEFAULT_PRESET, PRESETS, preset

__all__ = [
    "DEFAULT_PRESET",
    "JOINTS",
    "PRESETS",
    "Corridors",
    "Device",
    "Devices",
    "DoubleSupport",
    "GaitProblem",
    "JointBounds",
    "Limits",
    "Objective",
    "RhythmBounds",
    "preset",
]
