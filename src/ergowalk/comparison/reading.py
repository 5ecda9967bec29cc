"""What a comparison and the pictures read from a gait: curves of the stride, body, human data."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.comparison.signals import COMPARED
from ergowalk.corridors import HumanGait, human_gait
from ergowalk.errors import GaitFileError
from ergowalk.quantities import DEVICE_MOMENT

Array = NDArray[np.float64]

DEFAULT_SOURCE = "winter-natural"
"""Human data of a problem that names none."""


@dataclass(frozen=True)
class StrideCurves:
    """A leg's curves over its stride: ``fraction`` 0 ... 1 (n,), and (n,) values by signal.

    ``borne`` is the part of moments that devices bear, where there are any.
    """

    fraction: Array
    values: dict[str, Array]
    borne: dict[str, Array] = field(default_factory=dict)


def human_of(dataset: xr.Dataset, folder: Path | None = None) -> HumanGait:
    """The human data named in the gait's problem, ``[corridors] source``.

    ``folder`` is where a relative path starts.

    Raises
    ------
    GaitFileError
        If the attribute ``problem`` is missing or names no human data.
    CorridorError
        If the human data cannot be read.
    """
    try:
        corridors = tomllib.loads(str(dataset.attrs["problem"])).get("corridors", {})
        source = corridors.get("source", DEFAULT_SOURCE)
        if not isinstance(source, str):
            raise TypeError(f"corridors.source = {source!r} is no name")
    except (KeyError, AttributeError, TypeError, tomllib.TOMLDecodeError) as error:
        raise _unusable_attribute("problem", "TOML text with a table [corridors]", error) from None
    return human_gait(source, folder)


def body_of(dataset: xr.Dataset) -> Body:
    """The body of a gait, from the attribute ``body_parameters``.

    Raises
    ------
    GaitFileError
        If the attribute is missing, no JSON object of the paper's symbols, or no possible body.
    """
    try:
        symbols = json.loads(str(dataset.attrs["body_parameters"]))
        return Body.from_symbols(symbols)
    except (KeyError, AttributeError, ValueError) as error:
        rule = "a JSON object of the paper's symbols that make a possible body"
        raise _unusable_attribute("body_parameters", rule, error) from None


def legs_with_curves(dataset: xr.Dataset) -> tuple[int, ...]:
    """The legs whose curves are not told by the other's: 1, or 1 and 2."""
    return (1, 2) if "rhythm_leg_2" in dataset.attrs else (1,)


def stride_curves(dataset: xr.Dataset, leg: int = 1) -> StrideCurves:
    """The eight signals of a leg in degrees, N/kg and N m/kg, in the paper's signs.

    They begin with the heel contact of that leg.

    Raises
    ------
    GaitFileError
        If a variable is missing or not finite, or the times do not run forward from 0.
    """
    mass = body_of(dataset).total_mass
    values, borne = {}, {}
    for signal in COMPARED:
        if signal.name.startswith("reaction"):
            axis = signal.name[-1]
            force = curve(dataset, "ground_reaction_force", {"leg": leg, "axis": axis})
            values[signal.name] = force / mass
        else:
            joint, kind = signal.name.split("_")
            raw = curve(dataset, f"joint_{kind}", {"leg": leg, "joint": joint})
            values[signal.name] = np.degrees(raw) if kind == "angle" else raw / mass
            if kind == "moment" and DEVICE_MOMENT in dataset:
                part = curve(dataset, DEVICE_MOMENT, {"leg": leg, "joint": joint}) / mass
                if np.any(part):
                    borne[signal.name] = part
    fraction = stride_fraction(dataset)
    if leg == 1:
        return StrideCurves(fraction, values, borne)
    contact = heel_contact(dataset)
    first = int(np.searchsorted(fraction, contact + _SAME, "right")) - 1  # the side after it
    later = np.concatenate([fraction[first:] - contact, fraction[: first + 1] + 1 - contact])
    later[[0, -1]] = 0.0, 1.0

    def turned(curves: dict[str, Array]) -> dict[str, Array]:
        return {n: np.concatenate([v[first:], v[: first + 1]]) for n, v in curves.items()}

    return StrideCurves(later, turned(values), turned(borne))


def heel_contact(dataset: xr.Dataset) -> float:
    """Heel contact of leg 2 as a fraction of the stride of leg 1.

    Raises
    ------
    GaitFileError
        If the attribute ``rhythm`` does not tell.
    """
    try:
        return float(json.loads(str(dataset.attrs["rhythm"]))["toe_tip_start"])
    except (KeyError, TypeError, ValueError) as error:
        raise _unusable_attribute("rhythm", "a JSON object with toe_tip_start", error) from None


def curve(
    dataset: xr.Dataset, variable: str, labels: Mapping[str, int | str] = {}, gaps: bool = False
) -> Array:
    """A variable's samples (n,) over time at coordinate ``labels``, such as {"leg": 1}.

    Raises
    ------
    GaitFileError
        If it is missing, does not run over time alone, or, unless it may have ``gaps``, is not
        finite everywhere.
    """
    try:
        array = dataset[variable].sel(labels)
        if array.dims != ("time",):
            raise ValueError(f"has dimensions {array.dims}")
        values = np.asarray(array.values, dtype=float)
    except (KeyError, ValueError, TypeError):
        where = "".join(f", {dim} = {label}" for dim, label in labels.items())
        rule = f"must be there as numbers over time{where}"
        raise GaitFileError(rule, _REMEDY, field=variable) from None
    if not gaps and not np.all(np.isfinite(values)):
        raise GaitFileError("must be finite at every instant", _REMEDY, field=variable)
    return values


def stride_fraction(dataset: xr.Dataset) -> Array:
    """Times over the stride time, (n,), from 0 to 1.

    Raises
    ------
    GaitFileError
        If the times do not run forward from 0.
    """
    time = curve(dataset, "time")
    if len(time) < 2 or time[0] != 0 or time[-1] <= 0 or np.any(np.diff(time) < 0):
        raise GaitFileError(
            "must run from 0 to the stride time and never decrease", _REMEDY, field="time"
        )
    fraction: Array = time / time[-1]
    return fraction


_SAME = 1e-9
"""Fractions closer than this are one instant."""


def _unusable_attribute(name: str, rule: str, error: Exception) -> GaitFileError:
    reason = f"missing or unknown: {error}" if isinstance(error, KeyError) else str(error)
    return GaitFileError(f"must be {rule} ({reason})", _REMEDY, field=f"attribute {name}")


_REMEDY = "give a file written by 'ergowalk solve'"
