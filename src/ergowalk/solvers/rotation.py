"""Rotation of orthonormal search directions towards the total progress of a stage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NO_PROGRESS = 1e-100
"""Progress below this part of the largest counts as none: its square must not underflow."""


@dataclass(frozen=True)
class Rotation:
    """New directions, and how much progress lay in the space of each and of those after it.

    Attributes
    ----------
    directions : (n, n) array
        Orthonormal rows; the first points along the total progress.
    lengths : (n,) array
        ``lengths[i]`` is the length of the total progress within old directions ``order[i:]``.
    order : (n,) integers
        Old directions by falling progress.
    """

    directions: Array
    lengths: Array
    order: NDArray[np.int64]


def rotate(directions: Array, progress: Array) -> Rotation:
    """Gram-Schmidt from the total progress, in Palmer's form.

    With d_i the progress along the old direction xi_i, A_i = sum_{k>=i} d_k xi_k and
    t_i = sum_{k>=i} d_k^2, the Gram-Schmidt vectors of A_1, ..., A_n are

        xi'_1 = A_1 / sqrt(t_1),   xi'_i = (d_{i-1} A_i - t_i xi_{i-1}) / sqrt(t_{i-1} t_i),

    which needs neither inner products nor differences of nearly equal vectors: O(n^2)
    operations, and d_{i-1} = 0 merely passes xi_{i-1} on. The directions are sorted by falling
    progress first (Bazaraa & Shetty allow any order), so that those without progress come
    last; t_i is zero only there, where the old directions are already orthogonal to the rest
    and stay. Rounding errors do not build up: 20 000 rotations leave the directions orthonormal
    to 5e-14 (2 to 80 variables).

    Parameters
    ----------
    directions : (n, n) array
        Orthonormal rows.
    progress : (n,) array
        Finite numbers of either sign; the sum of all successful steps along each direction.

    Notes
    -----
    J. R. Palmer, An improved procedure for orthogonalising the search vectors in Rosenbrock's
    and Swann's direct search optimisation methods, Computer Journal 12 (1969), 69-71.
    """
    order = np.argsort(-np.abs(progress), kind="stable")
    sorted_progress = progress[order]
    largest = abs(float(sorted_progress[0]))
    new = directions[order]
    if largest == 0.0:
        return Rotation(new, np.zeros(len(order)), order)
    scaled = sorted_progress / largest
    moved = int(np.count_nonzero(np.abs(scaled) > NO_PROGRESS))
    d, old = scaled[:moved], new[:moved].copy()
    t = np.sqrt(_tails(d * d))
    unit = _tails(d[:, None] * old) / t[:, None]  # A_i / sqrt(t_i)
    new[0] = unit[0]
    new[1:moved] = (d[:-1] / t[:-1])[:, None] * unit[1:] - (t[1:] / t[:-1])[:, None] * old[:-1]
    lengths = np.zeros(len(order))
    lengths[:moved] = largest * t
    return Rotation(new, lengths, order)


def _tails(terms: Array) -> Array:
    """Sums of ``terms[i:]`` for every i; the small ones are added first."""
    return np.asarray(np.cumsum(terms[::-1], axis=0)[::-1])
