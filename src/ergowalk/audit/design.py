"""The line about a design: numbers that were found with the gait, against their bounds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ergowalk.audit import residuals
from ergowalk.audit.record import Record, as_number
from ergowalk.audit.report import AuditLine, Worst

DESIGN = "design"


def design_lines(record: Record) -> Iterator[AuditLine]:
    """Every free number of the stored problem inside its bounds; no line where none is free."""
    if DESIGN not in record.problem:
        return
    line, found = residuals.DESIGN, Worst(0.0, "")
    for path, bounds in record.table(DESIGN).items():
        pair = bounds if isinstance(bounds, list) and len(bounds) == 2 else (None, None)
        value = as_number(_stated(record.problem, path))
        low, high = map(as_number, pair)
        if not np.all(np.isfinite([value, low, high])):
            yield line.cannot_be_judged(f"the stored problem does not state {path} and its bounds")
            return
        size = max(abs(low), abs(high), abs(value)) or 1.0
        outside = max(low - value, value - high) / size
        if outside > found.value:
            found = Worst(outside, f"{path} = {value:g}, bounds {low:g} and {high:g}")
    yield line.judged(found)


def _stated(problem: Mapping[str, Any], path: str) -> Any:
    """What stands at a path of the stored problem; a leg's number at .1 or .2 of its pair."""
    place: Any = problem
    for part in path.split("."):
        if isinstance(place, list):
            place = place[int(part) - 1] if part in ("1", "2") and len(place) == 2 else None
        else:
            place = place.get(part) if isinstance(place, dict) else None
    return place
