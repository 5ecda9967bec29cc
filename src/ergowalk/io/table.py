"""Every curve of a gait as a comma-separated table."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from ergowalk.comparison import curve, stride_fraction
from ergowalk.errors import GaitFileError
from ergowalk.quantities import QUANTITIES, Quantity

LABELS = {"leg": "leg", "axis": "", "segment": "", "joint": ""}
"""What stands before the label of each dimension in the name of a column."""

UNITS = {"m/s": "m_s", "m/s2": "m_s2", "rad/s": "rad_s", "rad/s2": "rad_s2", "N m": "Nm"}
"""Units as they stand in names; others stand as they are."""


def csv_table(dataset: xr.Dataset) -> str:
    """All variables of a gait at all its instants, every digit kept.

    One row for each instant of the file; where curves jump, an instant stands twice. A column is
    called like its variable, with leg, joint, segment or axis, and the unit:
    ``joint_moment_leg1_hip_Nm``. ``contact_phase_leg1`` is a word. What is not a number (the
    centre of pressure in the air) is empty.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.

    Raises
    ------
    GaitFileError
        If a variable is missing or not usable.
    """
    stride_fraction(dataset)
    columns: dict[str, list[str]] = {}
    for quantity in QUANTITIES.values():
        for labels in _labels(dataset, quantity):
            values = curve(dataset, quantity.name, labels, gaps=True)
            name = "_".join([quantity.name, *(f"{LABELS[d]}{v}" for d, v in labels.items())])
            if quantity.name == "contact_phase":
                columns[name] = _words(dataset, values.astype(int).tolist())
            else:
                unit = UNITS.get(quantity.units, quantity.units)
                columns[f"{name}_{unit}"] = [_cell(value) for value in values.tolist()]
    lines = [",".join(columns), *map(",".join, zip(*columns.values(), strict=True))]
    return "\n".join(lines) + "\n"


def _labels(dataset: xr.Dataset, quantity: Quantity) -> list[dict[str, int | str]]:
    found: list[dict[str, int | str]] = [{}]
    for dim in quantity.dims[1:]:
        if dim not in dataset.coords:
            raise GaitFileError("required but missing", _REMEDY, field=dim)
        found = [{**one, dim: label} for one in found for label in dataset[dim].values.tolist()]
    return found


def _words(dataset: xr.Dataset, values: list[int]) -> list[str]:
    attributes = dataset["contact_phase"].attrs
    flags = np.atleast_1d(attributes.get("flag_values", ())).tolist()
    words = dict(zip(flags, str(attributes.get("flag_meanings", "")).split(), strict=False))
    return [words.get(value, str(value)) for value in values]


def _cell(value: float) -> str:
    return "" if math.isnan(value) else repr(value)


_REMEDY = "give a file written by 'ergowalk solve'"
