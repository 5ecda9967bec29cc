"""The answer as a labelled dataset, and what it says of itself."""

from ergowalk.solution.progress import Progress
from ergowalk.solution.solution import Solution

__all__ = ["Progress", "Solution"]
