"""The contact phases of a stored gait over the stride."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from ergowalk.comparison.reading import curve, stride_fraction


@dataclass(frozen=True)
class PhaseSpan:
    """A contact phase of a leg between two stride fractions."""

    name: str
    start: float
    end: float


def contact_phases(dataset: xr.Dataset, leg: int = 1) -> tuple[PhaseSpan, ...]:
    """The contact phases of a leg in time order; those without duration are left out.

    Such is the next heel contact, where the file has it as its last instant.

    Raises
    ------
    GaitFileError
        If ``contact_phase`` is missing.
    """
    s = stride_fraction(dataset)
    codes = curve(dataset, "contact_phase", {"leg": leg})
    names = _phase_names(dataset)
    change = np.flatnonzero(np.diff(codes)) + 1
    starts = np.array([0, *change])
    edges = [*s[starts], 1.0]
    spans = (
        PhaseSpan(names.get(int(code), "?"), float(a), float(b))
        for code, a, b in zip(codes[starts], edges[:-1], edges[1:], strict=True)
    )
    return tuple(span for span in spans if span.end > span.start)


def _phase_names(dataset: xr.Dataset) -> dict[int, str]:
    attributes = dataset["contact_phase"].attrs
    meanings = attributes.get("flag_meanings", "swing heel flat forefoot toe")
    names = meanings.split() if isinstance(meanings, str) else [str(name) for name in meanings]
    values = np.atleast_1d(attributes.get("flag_values", np.arange(len(names))))
    return {int(value): name for value, name in zip(values, names, strict=False)}
