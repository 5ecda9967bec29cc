"""The formats of an export: their names, files and writers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import xarray as xr

from ergowalk.io import opensim
from ergowalk.io.mjcf import mjcf
from ergowalk.io.sampling import RATE, STRIDES
from ergowalk.io.table import csv_table
from ergowalk.io.trc import trc

Writer = Callable[[xr.Dataset, float, int], str]
"""Gait, rate [Hz] and number of strides to the text of a file."""


@dataclass(frozen=True)
class Format:
    """One file of an export.

    ``name`` is what a user asks for, ``file`` the file's name in a folder, ``sampled`` whether
    rate and strides matter.
    """

    name: str
    file: str
    summary: str
    sampled: bool
    write: Writer

    def text(self, dataset: xr.Dataset, rate: float = RATE, strides: int = STRIDES) -> str:
        """The file of a gait.

        Parameters
        ----------
        dataset : xarray.Dataset
            A gait in the format of ``gait.nc``.
        rate : float
            Samples per second, where that matters.
        strides : int
            Strides, each a stride length further on, where that matters.

        Raises
        ------
        GaitFileError, BodyError, InputError
            If the gait cannot be used, or rate or strides are out of range.
        """
        return self.write(dataset, rate, strides)

    @property
    def suffix(self) -> str:
        """The end of its file names."""
        return "." + self.file.rsplit(".", 1)[1]


FORMATS = {
    f.name: f
    for f in (
        Format(
            "csv",
            "curves.csv",
            "every curve at every instant of the gait",
            False,
            lambda dataset, rate, strides: csv_table(dataset),
        ),
        Format("mot", "angles.mot", "OpenSim coordinates (gait10dof18musc)", True, opensim.angles),
        Format("grf", opensim.REACTIONS_FILE, "OpenSim ground reactions", True, opensim.reactions),
        Format("sto", "moments.sto", "OpenSim joint moments", True, opensim.moments),
        Format("trc", "markers.trc", "joint centres as markers", True, trc),
        Format(
            "mjcf",
            "walker.xml",
            "the body for MuJoCo",
            False,
            lambda dataset, rate, strides: mjcf(dataset),
        ),
        Format(
            "loads",
            "external_loads.xml",
            "OpenSim setup of the ground reactions",
            False,
            lambda dataset, rate, strides: opensim.external_loads(),
        ),
    )
}
"""All formats by name; of those with one suffix the first is meant."""


def format_of(file: str) -> Format | None:
    """The format that a file name asks for, None where it asks for none.

    It ends on the name of the format's own file (``walk_reactions.mot``), or else on its suffix.
    """
    by_name = (f for f in FORMATS.values() if file.lower().endswith(f.file))
    by_suffix = (f for f in FORMATS.values() if file.lower().endswith(f.suffix))
    return next(by_name, None) or next(by_suffix, None)
