"""Meshes: how many elements each phase gets at first, and which of them are cut later."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ergowalk.gait.rhythm import Contact, Phase, PhaseOrder, half_stride_phases
from ergowalk.transcription.layout import Mesh

Array = NDArray[np.float64]

TRANSFER, STANCE, PUSH = 0.0034, 0.0095, 0.0073
"""Element sizes as fractions of T: where the load changes legs, on the flat foot, on the forefoot.

Found by refining one phase at a time: with these the phases share the error of E about evenly.
"""

LAYER, PUSH_OFF = 4, 12
"""Elements over which sizes shrink towards a change of contact, where forces turn sharply, and
before the other heel lands, where the foot turns fast under full load."""


def walking_mesh(
    order: PhaseOrder, times: Mapping[str, float], stride: float, level: float
) -> Mesh:
    """A mesh for given boundary instants [s].

    Most of the error of E sits where the load passes from leg to leg, so elements are small
    there. ``level`` 1 is the mesh of a reported gait, 0.5 has half as many elements.
    """
    return tuple(
        _phase_mesh(phase, (times[phase.end] - times[phase.start]) / stride, level)
        for phase in half_stride_phases(order)
    )


def _phase_mesh(phase: Phase, share: float, level: float) -> Array:
    if phase.legs == (Contact.HEEL, Contact.TOE):
        return graded(_count(share / TRANSFER, level, at_least=4), 0.3, 0.6)
    if phase.double_support or phase.legs[0] is Contact.HEEL:
        return graded(_count(share / TRANSFER, level, at_least=3), 0.6, 0.5)
    if phase.legs[0] is Contact.FLAT:
        return graded(_count(share / STANCE, level, at_least=4), 0.4, 0.2)
    return graded(_count(share / PUSH, level, at_least=6), 0.1, 0.25, PUSH_OFF)


def _count(at_level_one: float, level: float, at_least: int) -> int:
    return max(at_least, math.ceil(level * at_level_one - 1e-9))


def graded(n: int, first: float, last: float, last_layer: int = LAYER) -> Array:
    """Boundaries of ``n`` elements from 0 to 1.

    Elements are equal inside; over a layer at each end they shrink geometrically until the very
    first and last are ``first`` and ``last`` times as large.
    """
    head, tail = min(LAYER, n // 2), min(last_layer, n // 2)
    sizes = np.ones(n)
    if n > 1:
        sizes[:head] *= np.geomspace(first, 1.0, head + 1)[:-1]
        sizes[-tail:] *= np.geomspace(1.0, last, tail + 1)[1:]
    edges = np.concatenate([[0.0], np.cumsum(sizes)])
    mesh: Array = edges / edges[-1]
    return mesh


THRICE = 6.0
"""Error, as a multiple of what is allowed, from which an element is cut in three."""


def cut(mesh: Mesh, errors: Sequence[Array], above: float = 1.0) -> Mesh:
    """The mesh with every element cut in two whose error is ``above`` 1, in three above 6.

    The elements stay nested: on the new mesh the old curves are the same curves, and the solver
    starts next to the solution. Below 1 a threshold spares rounds that cut an element or two.

    Parameters
    ----------
    errors : one array (n_elements,) per phase
        As multiples of what is allowed, from
        :func:`ergowalk.transcription.residuals.mesh_residuals`.
    """
    return tuple(
        _divided(edges, 1 + (error > above).astype(int) + (error > THRICE).astype(int))
        for edges, error in zip(mesh, errors, strict=True)
    )


def finer(mesh: Mesh, errors: Sequence[Array], share: float = 0.25) -> Mesh:
    """The mesh with that ``share`` of its elements halved whose errors are largest."""
    every = np.concatenate(list(errors))
    order = np.argsort(-every, kind="stable")
    chosen = np.zeros(len(every), dtype=int)
    chosen[order[: max(1, math.ceil(share * len(every)))]] = 1
    ends = np.cumsum([len(error) for error in errors])[:-1]
    return tuple(
        _divided(edges, 1 + more) for edges, more in zip(mesh, np.split(chosen, ends), strict=True)
    )


def _divided(edges: Array, pieces: NDArray[np.int64]) -> Array:
    """Each element in as many equal pieces as asked."""
    parts = [
        start + (end - start) * np.arange(n) / n
        for start, end, n in zip(edges[:-1], edges[1:], pieces, strict=True)
    ]
    return np.concatenate([*parts, edges[-1:]])
