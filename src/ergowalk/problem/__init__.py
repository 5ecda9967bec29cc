"""Problem A: givens, constraints (2)-(9), objective (10), physical limits, presets."""

from ergowalk.problem.corridors import Corridors
from ergowalk.problem.design import Design
from ergowalk.problem.devices import Device, Devices
from ergowalk.problem.gait_problem import DoubleSupport, GaitProblem
from ergowalk.problem.limits import JointBounds, Limits
from ergowalk.problem.objective import Objective
from ergowalk.problem.presets import DEFAULT_PRESET, PRESETS, preset
from ergowalk.problem.rhythm import RhythmBounds
from ergowalk.quantities import JOINTS

__all__ = [
    "DEFAULT_PRESET",
    "JOINTS",
    "PRESETS",
    "Corridors",
    "Design",
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
