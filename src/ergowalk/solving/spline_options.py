"""Choices of the spline method, and what each does to E."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ergowalk.errors import ProblemError
from ergowalk.transcription.spline.curves import EXTRAS
from ergowalk.transcription.spline.rows import Asked

FEWEST, MOST = 4, 200
"""Knot intervals of the half stride: one for each phase; what a solve can bear."""

DEFAULT_KNOTS = {"rosenbrock": 12, "ipopt": 30}
"""Knot intervals by solver. 12 give Rosenbrock's method 66 unknowns; more than twice that it does
not bring to rest. 30 are the fewest with which all limits of the paper's case can be kept between
the samples too."""

DEFAULT_ASKED = {"rosenbrock": Asked.PAPER, "ipopt": Asked.EVERYTHING}
"""Constraints by solver."""


@dataclass(frozen=True, kw_only=True)
class SplineOptions:
    """How the paper's transcription (11)-(19) makes a problem finite.

    The paper prints none of these numbers, and E depends on the first and the last.

    Attributes
    ----------
    knots : int, optional
        Knot intervals of the half stride, at least 4; by default 12 for Rosenbrock's method and
        30 for IPOPT. They are what keeps the problem finite: each curve has one parameter a
        knot. More knots can only lower E; where nothing bounds the rate of a moment it falls
        with the distance of the knots, since then they alone forbid impulses.
    rho : float
        Freedom of the inner knots in (13) and (17) [s^3], zero to interpolate. For any rho the
        parameters z reach the same curves, so the least E does not depend on it. What changes
        is how far a parameter reaches, and with it the way to the optimum and where Rosenbrock's
        method comes to rest.
    asked : "paper" or "everything", optional
        "paper": the measures of (19) alone and the unknowns of (18) alone. "everything": all
        that the problem asks for, its physical limits too, and as further unknowns what (18)
        holds: slope of the foot at heel contact, swing foot, and the way in which the force
        under the toe tip departs from (12). Limits raise E. By default "paper" for Rosenbrock's
        method, which knows nothing else, and "everything" for IPOPT.
    max_evaluations : int
        Rosenbrock's method stops there, whatever it has reached.
    """

    knots: int | None = None
    rho: float = 1e-6
    asked: str | None = None
    max_evaluations: int = 400_000

    def __post_init__(self) -> None:
        if self.knots is not None and not (
            isinstance(self.knots, int) and FEWEST <= self.knots <= MOST
        ):
            raise ProblemError(
                f"must be a whole number from {FEWEST} to {MOST}",
                "give the knot intervals of half a stride",
                field="knots",
                value=self.knots,
            )
        if not (math.isfinite(self.rho) and self.rho >= 0):
            raise ProblemError(
                "must be a finite number from 0 up",
                "give the freedom of the knots in s^3",
                field="rho",
                value=self.rho,
            )
        if self.asked is not None and self.asked not in list(Asked):
            raise ProblemError(
                f"must be {' or '.join(repr(str(a)) for a in Asked)}",
                "say which constraints are asked for",
                field="asked",
                value=self.asked,
            )
        if not self.max_evaluations >= 1:
            raise ProblemError(
                "must be 1 or more",
                "give a number of evaluations",
                field="max_evaluations",
                value=self.max_evaluations,
            )

    def settled(self, solver: str) -> SplineOptions:
        """With the defaults of a solver filled in.

        Raises
        ------
        ProblemError
            If Rosenbrock's method is to keep more than the measures of (19).
        """
        asked = self.asked or str(DEFAULT_ASKED[solver])
        if solver == "rosenbrock" and asked != Asked.PAPER:
            raise ProblemError(
                "is beyond Rosenbrock's method, whose penalties are the measures of (19)",
                "use asked 'paper' or solver 'ipopt'",
                field="asked",
                value=asked,
            )
        return replace(self, knots=self.knots or DEFAULT_KNOTS[solver], asked=asked)

    @property
    def extras(self) -> tuple[str, ...]:
        """What is unknown beyond (18)."""
        return EXTRAS if self.asked == Asked.EVERYTHING else ()
