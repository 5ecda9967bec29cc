"""The one verb: a gait problem becomes a solution."""

from ergowalk.solving.spline_options import SplineOptions
from ergowalk.solving.verb import solve

__all__ = ["SplineOptions", "solve"]
