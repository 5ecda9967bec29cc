"""Joint centres as markers: the TRC format of motion capture."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.io.sampling import RATE, STRIDES, Samples
from ergowalk.io.storage import number

Array = NDArray[np.float64]

MM = 1000.0
"""Millimetres in a metre."""

PARTS = {
    "Knee": "knee",
    "Ankle": "ankle",
    "Heel": "heel",
    "Metatarsal": "metatarsal",
    "Toe.Tip": "toe_tip",
}
"""Points of a leg by the name of their marker, behind R. (leg 1) or L. (leg 2)."""


def markers(dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> dict[str, Array]:
    """Positions (n, 2) [m] of the joint centres by marker name: Hip, Trunk (its centre of mass)
    and those of both legs."""
    samples = Samples(dataset, rate, strides)
    hip, lean = samples.hip(), samples.trunk()
    r = samples.body.trunk_com_m
    found = {"Hip": hip, "Trunk": hip + r * np.stack([-np.sin(lean), np.cos(lean)], axis=1)}
    for side, leg in (("R", 1), ("L", 2)):
        points = samples.points(leg)
        for name, attribute in PARTS.items():
            found[f"{side}.{name}"] = np.stack(getattr(points, attribute).position, axis=1)
    return found


def trc(dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> str:
    """Joint centres of a gait as a TRC file in mm: x forward, y up, z = 0.

    Parameters and errors as for :class:`ergowalk.io.Samples`.
    """
    found = markers(dataset, rate, strides)
    frames, count = len(found["Hip"]), len(found)
    hertz = number(rate)
    head = {
        "DataRate": hertz,
        "CameraRate": hertz,
        "NumFrames": frames,
        "NumMarkers": count,
        "Units": "mm",
        "OrigDataRate": hertz,
        "OrigDataStartFrame": 1,
        "OrigNumFrames": frames,
    }
    axes = [f"{axis}{i}" for i in range(1, count + 1) for axis in "XYZ"]
    lines = [
        "PathFileType\t4\t(X/Y/Z)\tmarkers.trc",
        "\t".join(head),
        "\t".join(map(str, head.values())),
        "Frame#\tTime\t" + "\t\t\t".join(found),
        "\t\t" + "\t".join(axes),
        "",
    ]
    flat = np.concatenate([np.column_stack([xy, np.zeros(frames)]) for xy in found.values()], 1)
    for i, row in enumerate(np.round(MM * flat, 6) + 0.0):  # no minus before zero
        cells = (str(i + 1), number(i / rate), *(f"{value:.6f}" for value in row))
        lines.append("\t".join(cells))
    return "\n".join(lines) + "\n"
