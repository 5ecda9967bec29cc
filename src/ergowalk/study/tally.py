"""Where a sweep stands, while it runs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tally:
    """Where a sweep stands.

    Attributes
    ----------
    total, done, accepted, failed, running : int
        Cases: of the sweep, with a record, with an accepted gait, without a gait, under way.
    fresh : int
        Cases that this run has done itself.
    elapsed : float
        Seconds since this run began.
    workers : int
        Threads of the cluster, each of which takes one case.
    dashboard : str
        Address of Dask's own view of the cluster.
    last : str
        Key of the last case that ended, if one has, and its status.
    words : str
        What is counted: cases, or second looks at them.
    """

    total: int
    done: int
    accepted: int
    failed: int
    running: int
    fresh: int
    elapsed: float
    workers: int
    dashboard: str
    last: str = ""
    words: str = "cases"

    @property
    def per_minute(self) -> float:
        """Cases a minute in this run."""
        return 60 * self.fresh / self.elapsed if self.elapsed > 0 else 0.0

    @property
    def left_s(self) -> float | None:
        """Seconds that the rest will take at this rate; None before the first case."""
        return 60 * (self.total - self.done) / self.per_minute if self.fresh else None
