"""The whole audit, line by line in the order of the contract."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from ergowalk.audit.asked import attribute_line, corridor_lines, finite_line, mesh_line
from ergowalk.audit.bounds import bound_lines, pressure_line
from ergowalk.audit.design import design_lines
from ergowalk.audit.devices import device_lines
from ergowalk.audit.loads import balance_lines, energy_lines
from ergowalk.audit.motion import curve_lines, foot_lines, symmetry_lines
from ergowalk.audit.objective import objective_line
from ergowalk.audit.reading import read_record
from ergowalk.audit.report import AuditReport
from ergowalk.audit.rhythm import grid_lines, phase_line, rhythm_lines


def audit(dataset: xr.Dataset, folder: Path | None = None) -> AuditReport:
    """Recompute every residual of a gait from the curves of its file.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait as ``gait.nc`` holds it.
    folder : Path, optional
        Where a corridor file named in the stored problem may lie: the folder of the gait file.

    Returns
    -------
    AuditReport
        One line per residual with its tolerance; a value that is missing (NaN) fails every line
        that needs it.

    Raises
    ------
    GaitFileError
        If the file cannot be read at all, see :func:`ergowalk.audit.check_readable`.
    """
    record = read_record(dataset)
    with np.errstate(all="ignore"):  # what overflows or is missing fails its line
        lines = [
            *balance_lines(record),
            *curve_lines(record),
            *foot_lines(record),
            *bound_lines(record),
            pressure_line(record),
            *corridor_lines(record, folder),
            *symmetry_lines(record),
            *energy_lines(record),
            objective_line(record),
            *device_lines(record),
            *design_lines(record),
            mesh_line(record),
            *grid_lines(record),
            phase_line(record),
            *rhythm_lines(record),
            attribute_line(record),
            finite_line(record),
        ]
    return AuditReport(tuple(lines))
