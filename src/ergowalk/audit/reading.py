"""Reading a gait file for an audit: what must be there is checked, the rest is judged later.

Only what makes the file unreadable is an error; a file that can be read but does not hold up
fails lines of the audit.
"""

from __future__ import annotations

import json
import tomllib
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.audit.record import JOINTS, PHASES, RHYTHM, SEGMENTS, UNKNOWN_PHASE, Record, as_number
from ergowalk.audit.walker import Array, Walker
from ergowalk.errors import GaitFileError

_LABELS: dict[str, tuple[Any, ...]] = {
    "leg": (1, 2), "axis": ("x", "y"), "segment": SEGMENTS, "joint": JOINTS,
}  # fmt: skip

VARIABLES: dict[str, tuple[str, ...]] = {
    "hip_position": ("time", "axis"),
    "hip_velocity": ("time", "axis"),
    "hip_acceleration": ("time", "axis"),
    "trunk_angle": ("time",),
    "trunk_angular_velocity": ("time",),
    "trunk_angular_acceleration": ("time",),
    "segment_angle": ("time", "leg", "segment"),
    "segment_angular_velocity": ("time", "leg", "segment"),
    "segment_angular_acceleration": ("time", "leg", "segment"),
    "joint_angle": ("time", "leg", "joint"),
    "joint_moment": ("time", "leg", "joint"),
    "joint_power": ("time", "leg", "joint"),
    "ground_reaction_force": ("time", "leg", "axis"),
    "center_of_pressure": ("time", "leg"),
    "contact_phase": ("time", "leg"),
    "corridor_lower": ("time", "leg", "joint"),
    "corridor_upper": ("time", "leg", "joint"),
}
"""Variables of a gait file and their dimensions."""

OPTIONAL = {"device_moment": ("time", "leg", "joint")}
"""Variables of a gait with devices."""

MAY_BE_MISSING = ("center_of_pressure", "corridor_lower", "corridor_upper")
"""Variables with NaN where they have no meaning."""

_REMEDY = "write the gait again with 'ergowalk solve'"


def check_readable(dataset: xr.Dataset, file: str | None = None) -> None:
    """Refuse a file that no audit can read.

    Parameters
    ----------
    dataset : xarray.Dataset
        A stored gait.
    file : str, optional
        Its name, for the message.

    Raises
    ------
    GaitFileError
        If a variable, dimension, label or attribute is missing or malformed, or if time does
        not run forward. One line: what, the rule, the remedy.
    """
    read_record(dataset, file)


def read_record(dataset: xr.Dataset, file: str | None = None) -> Record:
    """Content of a gait file.

    Raises
    ------
    GaitFileError
        As :func:`check_readable`.
    """
    try:
        return _read(dataset)
    except GaitFileError as error:
        raise (error.located(file) if file else error) from None


def _read(dataset: xr.Dataset) -> Record:
    time = _time(dataset)
    raw = {name: _variable(dataset, name, dims) for name, dims in VARIABLES.items()}
    for name, dims in OPTIONAL.items():
        if name in dataset.variables:
            raw[name] = _variable(dataset, name, dims)
    return Record(
        time=time,
        raw=raw,
        phase=_phases(dataset["contact_phase"], raw["contact_phase"]),
        walker=Walker.from_json(_attribute(dataset, "body_parameters")),
        step_length=_positive(dataset, "step_length"),
        stride_time=_positive(dataset, "stride_time"),
        energy_per_metre=_number(dataset, "energy_per_metre"),
        stated=frozenset(map(str, dataset.attrs)),
        objective_per_metre=as_number(dataset.attrs.get("objective_per_metre")),
        rhythm=_rhythm(dataset, "rhythm"),
        rhythm_leg_2=_rhythm(dataset, "rhythm_leg_2") if _each_leg(dataset) else None,
        step_lengths=_step_lengths(dataset),
        problem=_problem(dataset),
        mesh_history=_mesh_history(dataset),
    )


def _time(dataset: xr.Dataset) -> Array:
    if "time" not in dataset.variables or dataset["time"].dims != ("time",):
        raise GaitFileError("required but missing", _REMEDY, field="time")
    time = _floats(dataset["time"].values, "time")
    bad = ~np.isfinite(time)
    if len(time) < 5 or np.any(bad):
        raise GaitFileError(
            "must hold five finite instants or more", _REMEDY, field="time", value=time[bad][:1]
        )
    back = np.flatnonzero(np.diff(time) < 0)
    if len(back) or time[-1] <= time[0]:
        at = int(back[0]) + 1 if len(back) else len(time) - 1
        raise GaitFileError(
            f"must never decrease, and pass (sample {at})", _REMEDY, field="time",
            value=float(time[at]),
        )  # fmt: skip
    return time


def _variable(dataset: xr.Dataset, name: str, dims: tuple[str, ...]) -> Array:
    if name not in dataset.variables:
        raise GaitFileError("required but missing", _REMEDY, field=name)
    variable = dataset[name]
    if set(variable.dims) != set(dims):
        raise GaitFileError(
            f"must have the dimensions {', '.join(dims)}", _REMEDY, field=name,
            value=tuple(map(str, variable.dims)),
        )  # fmt: skip
    variable = variable.transpose(*dims)
    for dim in dims[1:]:
        variable = variable.isel({dim: _label_order(dataset, name, dim)})
    return _floats(variable.values, name)


def _label_order(dataset: xr.Dataset, name: str, dim: str) -> list[int]:
    """Where each label of a dimension stands; labels may come in any order."""
    if dim not in dataset.coords or dataset[dim].dims != (dim,):
        raise GaitFileError("required but missing", _REMEDY, field=dim)
    stored = dataset[dim].values.tolist()
    wanted = _LABELS[dim]
    if len(stored) != len(wanted) or set(stored) != set(wanted):
        raise GaitFileError(
            f"must hold {', '.join(map(str, wanted))}", _REMEDY, field=dim, value=stored
        )
    return [stored.index(label) for label in wanted]


def _floats(values: Any, name: str) -> Array:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise GaitFileError("must hold numbers", _REMEDY, field=name) from None


def _phases(variable: xr.DataArray, stored: Array) -> NDArray[np.int64]:
    values = np.atleast_1d(variable.attrs.get("flag_values", ()))
    meanings = str(variable.attrs.get("flag_meanings", "")).split()
    if set(meanings) != set(PHASES) or len(values) != len(meanings):
        raise GaitFileError(
            f"flag_values and flag_meanings must name {', '.join(PHASES)}", _REMEDY,
            field="contact_phase", value=" ".join(meanings),
        )  # fmt: skip
    phase = np.full(stored.shape, UNKNOWN_PHASE, dtype=np.int64)
    for value, meaning in zip(values, meanings, strict=True):
        phase[stored == value] = PHASES.index(meaning)
    return phase


def _attribute(dataset: xr.Dataset, name: str) -> Any:
    if name not in dataset.attrs:
        raise GaitFileError("global attribute is missing", _REMEDY, field=name)
    return dataset.attrs[name]


def _number(dataset: xr.Dataset, name: str) -> float:
    value = _attribute(dataset, name)
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = np.nan
    if not np.isfinite(number):
        raise GaitFileError("must be a finite number", _REMEDY, field=name, value=value)
    return number


def _positive(dataset: xr.Dataset, name: str) -> float:
    number = _number(dataset, name)
    if number <= 0:
        raise GaitFileError("must be positive", _REMEDY, field=name, value=number)
    return number


def _each_leg(dataset: xr.Dataset) -> bool:
    """Whether the file tells the rhythm and the steps of each leg."""
    return any(name in dataset.attrs for name in ("rhythm_leg_2", "step_lengths"))


def _step_lengths(dataset: xr.Dataset) -> tuple[float, float]:
    if not _each_leg(dataset):
        length = _positive(dataset, "step_length")
        return length, length
    stored = _json(_attribute(dataset, "step_lengths"))
    numbers = [as_number(x) for x in stored] if isinstance(stored, list) else []
    if len(numbers) != 2 or not all(0 < x < np.inf for x in numbers):
        raise GaitFileError(
            "must be the two lengths of the steps", _REMEDY, field="step_lengths", value=stored
        )
    return numbers[0], numbers[1]


def _rhythm(dataset: xr.Dataset, name: str) -> dict[str, float]:
    text = _attribute(dataset, name)
    stored = _json(text)
    given = stored if isinstance(stored, dict) else {}
    for instant in RHYTHM:
        value = given.get(instant)
        if not isinstance(value, int | float) or isinstance(value, bool) or not 0 < value < 1:
            raise GaitFileError(
                "must be a fraction of the stride time", _REMEDY, field=f"{name}.{instant}",
                value=value,
            )  # fmt: skip
    return {instant: float(given[instant]) for instant in RHYTHM}


def _problem(dataset: xr.Dataset) -> dict[str, Any]:
    text = _attribute(dataset, "problem")
    try:
        return tomllib.loads(text)
    except (TypeError, AttributeError, tomllib.TOMLDecodeError) as error:
        raise GaitFileError(
            f"must be the text of a problem file ({error})", _REMEDY, field="problem"
        ) from None


def _mesh_history(dataset: xr.Dataset) -> tuple[dict[str, Any], ...]:
    """Usable entries only: what is not one cannot vouch for anything."""
    stored = _json(dataset.attrs.get("mesh_history"))
    entries = stored if isinstance(stored, list) else []
    return tuple(e for e in entries if isinstance(e, dict))


def _json(text: Any) -> Any:
    try:
        return json.loads(text)
    except (TypeError, ValueError):
        return None
