"""The one verb: a gait problem becomes a solution."""

from ergowalk.solving.common_design import CommonDesign, design
from ergowalk.solving.path import Waypoint, follow
from ergowalk.solving.spline_options import SplineOptions
from ergowalk.solving.verb import solve

__all__ = ["CommonDesign", "SplineOptions", "Waypoint", "design", "follow", "solve"]
