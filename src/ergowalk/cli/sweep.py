"""The command ``sweep``: many problems on a cluster, and what became of them."""

from __future__ import annotations

import math
import time
from argparse import Namespace
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ergowalk.cli.output import default_folder
from ergowalk.cli.streams import ProgressLine, emit, emit_json
from ergowalk.errors import OutputError

if TYPE_CHECKING:
    import xarray as xr

    from ergowalk.study import Sweep, Tally

SAY_EVERY_S = 10.0
"""Shortest time between two lines of progress where there is no terminal."""


def run_sweep(arguments: Namespace) -> bool:
    """Run a sweep, store its dataset, print a table; whether a gait is acceptable.

    Raises
    ------
    InputError
        If the sweep file cannot be used, the folder cannot be written, or the cluster is not
        there.
    """
    from ergowalk.study import read_sweep, sweep

    definition = read_sweep(arguments.sweep)
    folder = arguments.output or default_folder(definition.name)
    with ProgressLine(arguments.quiet) as line:
        line.stage(f"sweep {definition.name}: {definition.base.limits.sentence()}")
        found = sweep(
            definition,
            folder,
            workers=arguments.workers,
            scheduler=arguments.scheduler,
            retry=arguments.retry,
            progress=SweepProgress(line),
        )
        stored = _store(found, folder / f"{found.attrs['sweep']}.nc")
    told = _told(definition, found, folder, stored)
    if arguments.json:
        emit_json(told)
    else:
        emit(_table(told))
    return bool((found["acceptable"] == 1).any())


class SweepProgress:
    """Counts, rate, time left and failures on standard error, as the sweep goes on."""

    def __init__(self, line: ProgressLine) -> None:
        self._line, self._said, self._dashboard = line, -math.inf, ""

    def __call__(self, tally: Tally) -> None:
        """Take the state of a sweep."""
        if tally.dashboard and tally.dashboard != self._dashboard:
            self._dashboard = tally.dashboard
            self._line.stage(f"{tally.workers} workers, dashboard {tally.dashboard}")
        text = tally_text(tally)
        if self._line.refresh(text):
            return
        now, over = time.monotonic(), tally.done == tally.total
        if now - self._said >= SAY_EVERY_S or over:
            self._said = now
            self._line.stage(text)


def tally_text(tally: Tally) -> str:
    """One line about where a sweep stands."""
    parts = [f"{tally.done} of {tally.total} {tally.words}", f"{tally.accepted} accepted"]
    if tally.failed:
        parts.append(f"{tally.failed} failed")
    parts.append(f"{tally.running} running")
    if tally.fresh:
        parts.append(f"{tally.per_minute:.3g} a minute")
    if tally.left_s is not None and tally.done < tally.total:
        parts.append(f"{_duration(tally.left_s)} left")
    return ", ".join(parts)


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _store(found: xr.Dataset, path: Path) -> Path:
    draft = path.with_name(f".{path.name}.part")
    try:
        draft.touch()  # the netCDF library does not say what is wrong
        found.to_netcdf(draft, engine="netcdf4", format="NETCDF4")
        draft.replace(path)
    except (OSError, RuntimeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise OutputError(
            f"cannot be written ({reason})", "make room, then start the sweep again", file=str(path)
        ) from None
    finally:
        draft.unlink(missing_ok=True)
    return path


def _told(definition: Sweep, found: xr.Dataset, folder: Path, stored: Path) -> dict[str, Any]:
    status = Counter(str(s) for s in found["status"].to_numpy().ravel())
    told: dict[str, Any] = {
        "sweep": definition.name,
        "folder": str(folder),
        "cases": int(found["status"].size),
        "status": dict(status),
        "limits": definition.base.limits.sentence(),
        "cheapest": None,
        "cpu_s": float(found["cpu_s"].sum()),
        "results": str(stored),
        "index": str(folder / "index.parquet"),
        "failures": _failures(found),
    }
    energy = found["energy_per_metre"].where(found["acceptable"] == 1).to_numpy().ravel()
    if status["accepted"]:
        best = min(range(energy.size), key=lambda i: (math.isnan(energy[i]), energy[i]))
        key = str(found["key"].to_numpy().ravel()[best])
        told["cheapest"] = {
            "energy_per_metre": float(energy[best]),
            "speed_m_s": float(found["speed_m_s"].to_numpy().ravel()[best]),
            "gait": str(folder / "cases" / key[:2] / f"{key}.nc"),
        }
    return told


def _failures(found: xr.Dataset) -> list[dict[str, str]]:
    words = [found[name].to_numpy().ravel() for name in ("status", "key", "reason")]
    return [
        {"status": str(status), "key": str(key), "reason": str(reason)}
        for status, key, reason in zip(*words, strict=True)
        if status not in ("accepted", "rejected")
    ]


SHOWN = 8
"""Failures that the table names."""


def _table(told: dict[str, Any]) -> str:
    status = ", ".join(f"{count} {name}" for name, count in sorted(told["status"].items()))
    rows = [("sweep", told["sweep"]), ("cases", f"{told['cases']}: {status}")]
    if told["cheapest"]:
        best = told["cheapest"]
        rows.append(
            ("cheapest", f"{best['energy_per_metre']:.2f} J/m at {best['speed_m_s']:.3g} m/s")
        )
        rows.append(("", best["gait"]))
    rows.append(("limits", told["limits"]))
    rows.append(("effort", f"{told['cpu_s']:.3g} CPU s"))
    failures = told["failures"]
    rows += [("failed", f"{f['key']}: {f['status']}: {f['reason']}") for f in failures[:SHOWN]]
    if len(failures) > SHOWN:
        rows.append(("", f"and {len(failures) - SHOWN} more, see the index"))
    rows += [("results", told["results"]), ("index", told["index"])]
    return "\n".join(f"{name:<10}{text}" for name, text in rows)
