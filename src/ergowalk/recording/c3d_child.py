"""Reads one C3D file in a process of its own: ``python -m ergowalk.recording.c3d_child IN OUT``.

ezc3d is compiled code. What a damaged file does to it, an endless loop or a crash included, stays
in here: the parent sees an answer, or none.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

MEMORY = 4 << 30
"""Most address space [bytes]."""

SECONDS = 25
"""Most processor time [s]."""


def main(source: str, target: str) -> None:
    """Write the answer to ``target``: an archive of arrays, its text field ``error`` empty if the
    file could be read."""
    limit_resources()
    answer(Path(source), Path(target))


def limit_resources() -> None:
    """Bound memory and time, where the system can."""
    try:
        import resource
    except ImportError:  # not a POSIX system: the parent's clock remains
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def answer(source: Path, target: Path) -> None:
    """As :func:`main`, in this process and without limits."""
    try:
        found = _read(source)
    except (MemoryError, Exception) as error:  # whatever it is, it is told
        found = {"error": np.array(" ".join(f"{type(error).__name__}: {error}".split())[:300])}
    with target.open("wb") as stream:
        np.savez(stream, **found)


def _read(source: Path) -> dict[str, Any]:
    import ezc3d

    try:
        file, why = ezc3d.c3d(str(source), extract_forceplat_data=True), ""
        platforms = file["data"]["platform"]
    except Exception as error:  # the markers may be good though the plates are not
        file, why = ezc3d.c3d(str(source)), f"{type(error).__name__}: {error}"
        platforms = []
    parameters = file["parameters"]
    point, analog = parameters["POINT"], parameters.get("ANALOG", {})
    labels = [label for key in sorted(point, key=_number) for label in _labels(key, point)]
    found: dict[str, Any] = {
        "error": np.array(""),
        "platforms_error": np.array(why[:300]),
        "labels": np.array(labels, dtype=str),
        "points": np.moveaxis(file["data"]["points"][:3], 0, 2),
        "unit": np.array(_first(point, "UNITS", "")),
        "rate": np.array(float(_first(point, "RATE", 0.0))),
        "analog_rate": np.array(float(_first(analog, "RATE", 0.0))),
        "platforms": np.array(len(platforms)),
    }
    for i, platform in enumerate(platforms):
        for key in ("force", "moment", "corners"):
            found[f"{key}_{i}"] = np.asarray(platform[key], dtype=float)
        for key in ("unit_force", "unit_moment", "unit_position"):
            found[f"{key}_{i}"] = np.array(str(platform[key]))
    return found


def _labels(key: str, point: Any) -> list[str]:
    """Names of markers; beyond 255 they go on in LABELS2, LABELS3 ..."""
    return [str(label) for label in point[key]["value"]] if key.startswith("LABELS") else []


def _number(key: str) -> int:
    tail = key.removeprefix("LABELS")
    return int(tail) if key.startswith("LABELS") and tail.isdecimal() else 0


def _first(group: Any, key: str, default: Any) -> Any:
    values = group[key]["value"] if key in group else []
    return values[0] if len(values) else default


if __name__ == "__main__":
    main(*sys.argv[1:])
