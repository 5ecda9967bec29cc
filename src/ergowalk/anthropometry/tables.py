"""The tables of the package: segments after Dempster and de Leva, lengths as parts of height.

Their origin and licence stand in ``data/anthropometry/README.md``.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType

TABLES = ("dempster", "deleva")
"""Tables of segments: Dempster's (via Winter), without sexes, and de Leva's, with them."""


@dataclass(frozen=True)
class Segment:
    """One segment as fractions: ``mass`` of the body's, the others of the segment's length.

    ``com`` is the distance of the centre of mass from the first end, ``gyration`` the radius of
    gyration about the centre of mass for motion in the sagittal plane.
    """

    mass: float
    com: float
    gyration: float


@cache
def length_fractions() -> Mapping[str, float]:
    """Lengths as fractions of body height (Drillis & Contini)."""
    rows = _rows("lengths")
    return MappingProxyType({row["length"]: float(row["fraction_of_body_height"]) for row in rows})


@cache
def segments(table: str, sex: str) -> Mapping[str, Segment]:
    """The segments of one of the :data:`TABLES` by name.

    Parameters
    ----------
    table : {"dempster", "deleva"}
    sex : {"male", "female"}
        Which of de Leva's tables; Dempster's knows no sexes.
    """
    if table == "dempster":
        columns = ("com_from_proximal_fraction", "radius_gyration_com_fraction")
        rows = _rows(table)
    else:
        # about the axis from left to right: de Leva names radii by their axis, not their plane
        columns = ("com_from_origin_fraction", "radius_gyration_transverse_fraction")
        rows = _rows(f"{table}_{sex}")
    return MappingProxyType(
        {
            row["segment"]: Segment(float(row["mass_fraction"]), *(float(row[c]) for c in columns))
            for row in rows
            if all(row[column] for column in columns)
        }
    )


def _rows(name: str) -> list[dict[str, str]]:
    text = resources.files("ergowalk").joinpath(f"data/anthropometry/{name}.csv").read_text("utf-8")
    return list(csv.DictReader(text.splitlines()))
