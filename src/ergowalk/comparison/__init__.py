"""A gait against human walking: the eight curves of the paper's Figures 3-10, leg 1.

The yardstick is the standard deviation (SD) between people at the same instant of the stride.
Where it nearly vanishes - reactions and ankle moment in swing - a distance in SDs means nothing,
so the SD is never taken below :data:`SD_FLOOR` of its largest value over the stride, and each
answer says for what share of the stride that floor applied.
"""

from ergowalk.comparison.distance import compare, share_within_one, stride_mean
from ergowalk.comparison.phases import PhaseSpan, contact_phases
from ergowalk.comparison.reading import (
    DEFAULT_SOURCE,
    StrideCurves,
    body_of,
    curve,
    heel_contact,
    human_of,
    legs_with_curves,
    stride_curves,
    stride_fraction,
)
from ergowalk.comparison.result import Comparison, Extremes, SignalComparison
from ergowalk.comparison.signals import ANGLE_TOLERANCE_DEG, COMPARED, SD_FLOOR, ComparedSignal

__all__ = [
    "ANGLE_TOLERANCE_DEG",
    "COMPARED",
    "DEFAULT_SOURCE",
    "SD_FLOOR",
    "ComparedSignal",
    "Comparison",
    "Extremes",
    "PhaseSpan",
    "SignalComparison",
    "StrideCurves",
    "body_of",
    "compare",
    "contact_phases",
    "curve",
    "heel_contact",
    "human_of",
    "legs_with_curves",
    "share_within_one",
    "stride_curves",
    "stride_fraction",
    "stride_mean",
]
