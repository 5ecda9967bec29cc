"""Markers that the walk lacks, by rigid clusters of a static trial; hips from the pelvis."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ergowalk.measured.marker_sets import MarkerSet, PelvisMarkers

Array = NDArray[np.float64]


def rebuilt(
    walk: Mapping[str, Array], static: Mapping[str, Array], marker_set: MarkerSet
) -> dict[str, Array]:
    """The markers of the walk with those of its clusters that only the static trial has.

    Both are (n, 3) by name in one unit. A cluster needs three markers that both trials have.
    """
    markers = dict(walk)
    for cluster in marker_set.clusters:
        common = [name for name in cluster if name in walk and name in static]
        lost = [name for name in cluster if name not in walk and name in static]
        if len(common) < 3 or not lost:
            continue
        model = np.stack([np.nanmean(static[name], axis=0) for name in common])
        seen = np.stack([walk[name] for name in common], axis=1)
        rotation, shift = registration(model, seen)
        for name in lost:
            markers[name] = rotation @ np.nanmean(static[name], axis=0) + shift
    return markers


def registration(model: Array, seen: Array) -> tuple[Array, Array]:
    """Rotation (n, 3, 3) and shift (n, 3) that carry ``model`` (k, 3) nearest to ``seen``
    (n, k, 3), by least squares (Arun, Huang & Blostein 1987); NaN where a point is NaN."""
    centre, centres = model.mean(axis=0), seen.mean(axis=1)
    whole = np.isfinite(seen).all(axis=(1, 2))
    rotation = np.full((len(seen), 3, 3), np.nan)
    spread = np.einsum("ki,nkj->nij", model - centre, seen[whole] - centres[whole, None])
    u, _, v = np.linalg.svd(spread)
    turn = np.ones((len(spread), 3))
    turn[:, 2] = np.sign(np.linalg.det(u) * np.linalg.det(v))  # a rotation, no reflection
    rotation[whole] = np.einsum("nji,nj,nkj->nik", v, turn, u)
    return rotation, centres - rotation @ centre


def hip_centres(markers: Mapping[str, Array], pelvis: PelvisMarkers) -> dict[str, Array]:
    """Centres of both hips (n, 3) [m] by the regression of Harrington et al. (2007).

    From pelvic width (between the anterior spines) and depth (from their middle to the back).
    """
    right, left = markers[pelvis.right_asis], markers[pelvis.left_asis]
    back = np.mean([markers[name] for name in pelvis.back], axis=0)
    middle = (right + left) / 2
    width = float(np.nanmedian(np.linalg.norm(right - left, axis=1)))
    depth = float(np.nanmedian(np.linalg.norm(middle - back, axis=1)))
    lateral = _unit(right - left)
    forward = middle - back
    forward = _unit(forward - np.sum(forward * lateral, axis=1)[:, None] * lateral)
    up = np.cross(lateral, forward)
    base = middle - (0.24 * depth + 0.0099) * forward - (0.30 * width + 0.0109) * up
    aside = (0.33 * width + 0.0073) * lateral
    return {"right": base + aside, "left": base - aside}


def _unit(vector: Array) -> Array:
    unit: Array = vector / np.linalg.norm(vector, axis=1)[:, None]
    return unit
