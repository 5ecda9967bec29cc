"""Human walking data as smooth periodic functions of the stride, and corridors around it."""

from ergowalk.corridors.human import ANGLES, SIGNALS, HumanGait, Signal
from ergowalk.corridors.periodic import MAX_HARMONICS, Corridor, PeriodicCurve
from ergowalk.corridors.tables import BUILT_IN, human_gait

__all__ = [
    "ANGLES",
    "BUILT_IN",
    "MAX_HARMONICS",
    "SIGNALS",
    "Corridor",
    "HumanGait",
    "PeriodicCurve",
    "Signal",
    "human_gait",
]
