"""OpenSim's storage files (.mot, .sto): a header, a line of labels, columns of numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def storage_text(
    name: str, columns: Mapping[str, Array], in_degrees: bool, remarks: tuple[str, ...] = ()
) -> str:
    """A storage file.

    Parameters
    ----------
    name : str
        First line: what the file holds.
    columns : mapping
        Values (n,) by label; the first is ``time`` [s].
    in_degrees : bool
        Whether angles are in degrees.
    remarks : tuple of str
        Further lines of the header, for people.
    """
    rows = np.column_stack(list(columns.values()))
    head = [
        name,
        "version=1",
        f"nRows={rows.shape[0]}",
        f"nColumns={rows.shape[1]}",
        f"inDegrees={'yes' if in_degrees else 'no'}",
        *remarks,
        "endheader",
        "\t".join(columns),
    ]
    return "\n".join([*head, *("\t".join(map(number, row)) for row in rows)]) + "\n"


def number(value: float) -> str:
    """A number with ten significant digits, without a minus before zero."""
    return f"{value + 0.0:.10g}"
