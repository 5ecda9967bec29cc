"""C3D files through ezc3d, at arm's length: the header is checked here, the rest is read by another
process."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import RecordingError
from ergowalk.recording.c3d_header import check_header, check_rate
from ergowalk.recording.recording import UNITS, Plate, Recording, checked, even_time
from ergowalk.recording.text import read_bytes

Array = NDArray[np.float64]

PATIENCE = 30.0
"""Longest time that the reading may take [s]."""

FAINTEST = 1e-9
"""A corner of a plate nearer to the others than this [unit of the file] makes no plate."""


def read_c3d(path: Path) -> Recording:
    """Markers and force plates of a C3D file; a marker that was not seen is NaN.

    Loads are those of the ground on the foot about the origin of the laboratory.

    Raises
    ------
    RecordingError
        If ezc3d is not installed, or the file is damaged, truncated or no C3D file.
    """
    file = str(path)
    check_header(read_bytes(path), file)
    if importlib.util.find_spec("ezc3d") is None:
        raise RecordingError(
            "is a C3D file, which needs the package ezc3d",
            "install it with: pip install 'ergowalk[c3d]'",
            file=file,
        )
    found = _asked(path)
    if found["error"]:
        raise _damaged(str(found["error"]), file)
    try:
        return _recording(found, file)
    except (KeyError, ValueError, IndexError, TypeError) as error:
        if isinstance(error, RecordingError):
            raise
        raise _damaged(str(error), file) from None


def _asked(path: Path) -> dict[str, Any]:
    """What the other process found in the file."""
    with tempfile.TemporaryDirectory(prefix="ergowalk-") as folder:
        target = Path(folder) / "answer.npz"
        command = [sys.executable, "-m", "ergowalk.recording.c3d_child"]
        package = str(Path(__file__).parents[2])
        environment = {**os.environ, "PYTHONPATH": package, "OMP_NUM_THREADS": "1"}
        environment["OPENBLAS_NUM_THREADS"] = "1"
        try:
            done = subprocess.run(
                [*command, str(path.absolute()), str(target)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=PATIENCE,
                env=environment,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise _damaged(f"no answer within {PATIENCE:g} s", str(path)) from None
        return answered(target, done.returncode, str(path))


def answered(target: Path, status: int, file: str) -> dict[str, Any]:
    """The arrays that the other process left.

    Raises
    ------
    RecordingError
        If it left none.
    """
    try:
        with np.load(target, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except (OSError, ValueError, zipfile.BadZipFile, EOFError):
        raise _damaged(f"the reader stopped with status {status}", file) from None


def _recording(found: dict[str, Any], file: str) -> Recording:
    points, labels = found["points"], [str(label).strip() for label in found["labels"]]
    rate = float(found["rate"])
    check_rate(rate, file)
    if not labels or points.shape[0] == 0:
        raise RecordingError("has no markers", "give a trial with markers", file=file)
    # names may carry that of the person, "WM:LHEE"; the first of equal names counts
    names = [label.rsplit(":", 1)[-1] for label in labels[: points.shape[0]]]
    markers = {}
    for name, values in zip(names, points, strict=False):
        if name and name not in markers:
            values[np.isnan(values).any(axis=1) | np.all(values == 0, axis=1)] = np.nan
            markers[name] = values
    unit = str(found["unit"]).strip().lower()
    frames = points.shape[1]
    time = even_time(np.arange(frames) / rate, file, "frames")
    plates = [_plate(found, i, frames / rate, file) for i in range(int(found["platforms"]))]
    return checked(
        Recording(
            file=file,
            time=time,
            markers=markers,
            unit=unit if unit in UNITS else None,
            plates=tuple(plate for plate in plates if plate is not None),
        )
    )


def _plate(found: dict[str, Any], i: int, duration: float, file: str) -> Plate | None:
    """A plate; its moments are about the centre of its surface."""
    force, moment, corners = (found[f"{key}_{i}"].T for key in ("force", "moment", "corners"))
    if len(force) == 0 or not np.any(force):
        return None
    if corners.shape != (4, 3) or np.linalg.norm(corners[0] - corners[2]) < FAINTEST:
        raise RecordingError(
            "has no corners that make a plate",
            "set FORCE_PLATFORM:CORNERS",
            field=f"force plate {i + 1}",
            file=file,
        )
    if not (np.all(np.isfinite(force)) and np.all(np.isfinite(moment))):
        raise RecordingError(
            "has loads that are no numbers", "mend it", field=f"force plate {i + 1}", file=file
        )
    stated = str(found[f"unit_moment_{i}"]).replace(" ", "").lower()
    scale = 1e-3 if "mm" in stated else 1e-2 if "cm" in stated else 1.0
    centre: Array = np.tile(corners.mean(axis=0), (len(force), 1))
    time = np.linspace(0.0, duration, len(force), endpoint=False)
    place = str(found[f"unit_position_{i}"]).strip().lower()
    unit = place if place in UNITS else None
    moment = np.asarray(scale * moment, dtype=float)
    return Plate(f"force plate {i + 1}", time, force, moment, centre, unit)


def _damaged(reason: str, file: str) -> RecordingError:
    return RecordingError(
        f"is damaged, or not C3D throughout ({reason})", "export the trial again", file=file
    )
