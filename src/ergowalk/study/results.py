"""All results of a sweep as one labelled dataset over what was swept."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ergowalk.corridors import SIGNALS
from ergowalk.quantities import JOINTS
from ergowalk.study.cases import Record
from ergowalk.study.looks import Looks
from ergowalk.study.measures import AXES, INSTANTS
from ergowalk.study.plan import is_number
from ergowalk.study.store import Store

_NUMBERS = {
    "energy_per_metre": ("J/m", "energy per metre, E of (10)"),
    "energy_error": ("J/m", "how far E may be from that of ever finer meshes"),
    "cost_of_transport": ("1", "cost of transport, E / (M g)"),
    "speed_m_s": ("m/s", "walking speed, 2 L / T"),
    "step_length_m": ("m", "step length, L"),
    "stride_time_s": ("s", "stride time, T"),
    "human_distance": ("1", "r.m.s. distance from human curves in SDs, over all signals"),
    "iterations": ("1", "iterations of the solver"),
    "cpu_s": ("s", "processor time of the case"),
    "wall_s": ("s", "time that the case took"),
    "peak_memory_mb": ("MB", "most memory that the case took (2^20 bytes)"),
}
"""Numbers of a case, their units and what they are."""

_FAMILIES = {
    "energy_by_joint": ("energy_", "joint", JOINTS, "J/m", "part of E of each joint"),
    "rhythm": ("rhythm_", "instant", INSTANTS, "1", "contact instants of leg 1, parts of T"),
    "peak_reaction": ("peak_reaction_", "axis", AXES, "1", "largest reaction, body weights"),
    "peak_moment": ("peak_moment_", "joint", JOINTS, "N m/kg", "largest joint moment"),
    "peak_power": ("peak_power_", "joint", JOINTS, "W/kg", "largest joint power"),
    "human_distance_by_signal": (
        "human_",
        "signal",
        tuple(SIGNALS),
        "1",
        "r.m.s. distance from the human mean in SDs",
    ),
}
"""Numbers of a case that stand side by side along a dimension more."""

_WORDS = {
    "status": "accepted, rejected, refused, error, out of time, out of memory, crashed, missing",
    "reason": "why there is no gait",
    "key": "name of the case: its gait is cases/ab/KEY.nc, ab the first two letters",
    "begun_at": "key of the case at whose gait it began",
    "way": "how the gait was found",
    "phase_order": "order of the contact phases",
}


def collect(folder: str | Path, name: str | None = None) -> xr.Dataset:
    """The results of a sweep.

    Parameters
    ----------
    folder : str or Path
        The folder of the sweep.
    name : str, optional
        Which, if the folder has several; by default the latest.

    Returns
    -------
    xarray.Dataset
        Of a grid over its fields as dimensions, of any other sweep over ``case`` with the fields
        as coordinates; NaN, or "" where there is no text, of cases without a gait. ``acceptable``
        is the verdict of solver and audit. Of a case that was looked at again it is all of the
        best search, but ``cpu_s`` counts all ``searches``.

    Raises
    ------
    SweepError
        If there is no such sweep.
    """
    store = Store(Path(folder))
    definition = store.definition(name)
    cases = definition["cases"]
    looks = Looks(definition, store.done).finished()
    records = [_standing(looks, case["key"]) for case in cases]
    dims, shape, coords = _frame(definition)

    def shaped(values: list[Any], more: tuple[int, ...] = ()) -> Any:
        return np.array(values).reshape(shape + more)

    data: dict[str, Any] = {}
    for number, (unit, words) in _NUMBERS.items():
        if number not in coords:
            values = [_number(record, number) for record in records]
            data[number] = (dims, shaped(values), {"units": unit, "long_name": words})
    for family, (stem, dim, labels, unit, words) in _FAMILIES.items():
        rows = [[_number(record, f"{stem}{label}") for label in labels] for record in records]
        attributes = {"units": unit, "long_name": words}
        data[family] = ((*dims, dim), shaped(rows, (len(labels),)), attributes)
        coords[dim] = list(labels)
    for word, words in _WORDS.items():
        texts = [str(record.get(word) or "") for record in records]
        data[word] = (dims, shaped(texts), {"long_name": words})
    searches = [looks.searches.get(case["key"], 0) for case in cases]
    words = "searches of the case, second looks among them"
    data["searches"] = (dims, shaped(searches), {"long_name": words})
    accepted = [int(record["status"] == "accepted") for record in records]
    data["acceptable"] = (dims, shaped(accepted), {"long_name": "accepted by solver and audit"})
    about = {
        "title": definition["title"],
        "sweep": definition["name"],
        "fields": json.dumps(definition["fields"]),
        "leg_length_m": definition["leg_length_m"],
    }
    return xr.Dataset(data, coords, about)


def _standing(looks: Looks, key: str) -> Record:
    """The record that stands for a case, with the processor time of all its searches."""
    if key not in looks.best:
        return {"key": key, "status": "missing"}
    several = looks.searches[key] > 1
    return looks.best[key] | ({"cpu_s": looks.cpu_s[key]} if several else {})


def _frame(definition: dict[str, Any]) -> tuple[tuple[str, ...], tuple[int, ...], dict[str, Any]]:
    """Dimensions, shape and coordinates."""
    grid, fields = definition["grid"], definition["fields"]
    if grid is not None:
        coords = {field: _column(grid[field]) for field in fields}
        return tuple(fields), tuple(len(grid[field]) for field in fields), coords
    columns = {f: _column([case["values"][f] for case in definition["cases"]]) for f in fields}
    coords = {field: ("case", column) for field, column in columns.items()}
    return ("case",), (len(definition["cases"]),), coords


def _column(values: list[Any]) -> Any:
    """Numbers as they are, anything else as text."""
    if all(is_number(value) for value in values):
        return np.array(values, dtype=float)
    return np.array([v if isinstance(v, str) else json.dumps(v) for v in values])


def _number(record: Record, name: str) -> float:
    value = record.get(name)
    return float(value) if isinstance(value, int | float) else float("nan")
