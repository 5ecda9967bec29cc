"""The one verb: a gait problem becomes a solution."""

from ergowalk.solving.verb import solve

__all__ = ["solve"]
