"""The one verb: a gait problem becomes a solution."""

from ergowalk.solve.verb import solve

__all__ = ["solve"]
