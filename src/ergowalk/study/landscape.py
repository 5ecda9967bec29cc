"""From the dataset of a sweep to what its map shows: surface, valley, people."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ergowalk.errors import SweepError
from ergowalk.plots.maps import Landscape
from ergowalk.study.people import SOURCE, steps_of_people

Array = NDArray[np.float64]

LENGTH, TIME = "step_length_m", "stride_time_s"

NAMES = {LENGTH: "step length L [m]", TIME: "stride time T [s]"}

SAMPLES = 201
"""Samples of a line of constant speed."""

NEIGHBOURS = 60
"""Cases from which E at a point is interpolated."""

ALIKE = 0.005
"""Share of E by which two gaits may differ and be alike: what their meshes leave open."""

SPEED_STEP = 0.02
"""Between the speeds at which the valley is looked for [m/s]."""


def chosen(dataset: xr.Dataset, at: Mapping[str, str]) -> xr.Dataset:
    """The part of a sweep at some values of its fields, given as text.

    Raises
    ------
    SweepError
        If a field was not swept or has no such value.
    """
    fields = json.loads(dataset.attrs["fields"])
    for field, text in at.items():
        if field not in fields:
            raise SweepError(
                "was not swept", f"choose one of {', '.join(fields)}", field="at", value=field
            )
        known = dataset[field].to_numpy()
        fitting = np.flatnonzero([_is(value, text) for value in known])
        if not len(fitting):
            values = ", ".join(dict.fromkeys(f"{v:g}" if _number(v) else str(v) for v in known))
            raise SweepError(
                "has no such value", f"choose one of {values}", field=field, value=text
            )
        if "case" in dataset.dims:
            dataset = dataset.isel(case=fitting)
        else:
            dataset = dataset.isel({field: int(fitting[0])})
    return dataset


def landscape(dataset: xr.Dataset) -> Landscape:
    """What the map of a sweep shows: E over the two numbers that it varies, or over the one.

    Raises
    ------
    SweepError
        If it varies no number, or more than two, or has no accepted gait.
    """
    varied = _varied(dataset)
    dims = dataset["acceptable"].dims  # in this order everything is flattened
    flat = dataset.stack(one=dims) if dims != ("case",) else dataset.rename(case="one")
    columns = {name: flat[name].to_numpy() for name in varied}
    accepted = flat["acceptable"].to_numpy() == 1
    if not accepted.any():
        raise SweepError("has no accepted gait", "see the reasons in index.parquet", field="sweep")
    names = sorted(columns, key=lambda name: (name != TIME, name != LENGTH))
    x, y = columns[names[0]], columns[names[1]] if len(names) > 1 else None
    energy = flat["energy_per_metre"].to_numpy()
    walks = {TIME, LENGTH} <= set(names)
    triangles = _triangles(x, y, accepted)
    valley, people, plain = np.zeros((0, 6)), np.zeros((0, 3)), np.zeros((0, 3))
    legs = float(dataset.attrs["leg_length_m"])
    if walks:
        valley = _valley(columns[LENGTH], columns[TIME], energy, triangles)
        speed = 2 * columns[LENGTH] / columns[TIME]
        people, plain = _people(speed, legs), _people(speed, None)
    return Landscape(
        x=x,
        y=y,
        x_name=NAMES.get(names[0], names[0]),
        y_name=NAMES.get(names[1], names[1]) if len(names) > 1 else "",
        energy=energy,
        accepted=accepted,
        triangles=triangles,
        speed=2 * columns[LENGTH] / columns[TIME] if walks else None,
        cadence=120 / columns[TIME] if walks else None,
        valley=valley,
        people=people,
        people_name=f"people scaled to legs of {legs:.2f} m ± SD",
        plain=plain,
        plain_name=f"the same people as they are ({SOURCE})",
    )


def _varied(dataset: xr.Dataset) -> list[str]:
    """The fields that still have more than one value; all of them must be numbers."""
    fields = [f for f in json.loads(dataset.attrs["fields"]) if np.ndim(dataset[f]) > 0]
    found = [f for f in fields if len(np.unique(dataset[f].to_numpy())) > 1]
    words = [f for f in found if dataset[f].dtype.kind not in "fi"]
    if words or len(found) > 2:
        fixed = words or [f for f in found if f not in (LENGTH, TIME)]
        raise SweepError(
            "a map shows one or two numbers",
            f"choose a value with --at {fixed[-1]}=VALUE",
            field="fields",
            value=", ".join(found),
        )
    if not found:
        raise SweepError("varies no number", "there is nothing to draw", field="sweep")
    return found


def _triangles(x: Array, y: Array | None, accepted: NDArray[np.bool_]) -> NDArray[np.int_]:
    """Delaunay triangles between all cases, without those that touch one that has no gait.

    L and T to speed and cadence is a projective map: triangles stay triangles.
    """
    from scipy.spatial import Delaunay, QhullError

    nothing = np.zeros((0, 3), dtype=int)
    if y is None or len(x) < 3:
        return nothing
    try:
        found = Delaunay(np.stack([x / np.ptp(x), y / np.ptp(y)], axis=1)).simplices
    except QhullError:  # all on one line
        return nothing
    kept: NDArray[np.int_] = found[accepted[found].all(axis=1)]
    return kept


def _valley(length: Array, time: Array, energy: Array, triangles: NDArray[np.int_]) -> Array:
    """Where E along each line of constant speed has its minimum inside the map."""
    from scipy.interpolate import RBFInterpolator

    if not len(triangles):
        return np.zeros((0, 6))
    inside = np.unique(triangles)
    unit = np.array([np.ptp(length[inside]), np.ptp(time[inside])])
    surface = RBFInterpolator(
        np.stack([length[inside], time[inside]], axis=1) / unit,
        energy[inside],
        neighbors=min(NEIGHBOURS, len(inside)),
        kernel="cubic",
    )
    covered = _covering(length, time, triangles)
    speeds = 2 * length[inside] / time[inside]
    found = []
    for speed in np.arange(np.ceil(speeds.min() / SPEED_STEP), speeds.max() / SPEED_STEP):
        speed = speed * SPEED_STEP
        steps = np.linspace(length.min(), length.max(), SAMPLES)
        line = np.stack([steps, 2 * steps / speed], axis=1)
        there = covered(*line.T)
        if there.sum() < 3:
            continue
        e = np.full(SAMPLES, np.inf)
        e[there] = surface(line[there] / unit)
        k = int(np.argmin(e))
        if 0 < k < SAMPLES - 1 and np.isfinite(e[k - 1 : k + 2]).all():
            bend = e[k - 1] - 2 * e[k] + e[k + 1]
            shift = 0.5 * (e[k - 1] - e[k + 1]) / bend if bend > 0 else 0.0
            best = steps[k] + shift * (steps[1] - steps[0])
            alike = steps[_around(k, e <= (1 + ALIKE) * e[k])]
            found.append((speed, best, 2 * best / speed, e[k], alike[0], alike[-1]))
    return np.array(found).reshape(-1, 6)


def _around(k: int, kept: NDArray[np.bool_]) -> slice:
    """The run of kept entries around one of them."""
    lost = np.flatnonzero(~kept)
    before, after = lost[lost < k], lost[lost > k]
    return slice(int(before[-1]) + 1 if len(before) else 0, int(after[0]) if len(after) else None)


def _covering(length: Array, time: Array, triangles: NDArray[np.int_]) -> Any:
    """Whether points lie in one of the triangles."""
    from matplotlib.tri import Triangulation

    finder = Triangulation(length, time, triangles).get_trifinder()
    return lambda steps, times: np.asarray(finder(steps, times)) >= 0


def _people(speeds: Array, legs: float | None) -> Array:
    at = np.arange(speeds.min(), speeds.max(), SPEED_STEP)
    steps = steps_of_people(at, legs)
    known = np.isfinite(steps.cadence)
    rows: Array = np.stack([at, steps.cadence, steps.cadence_sd], axis=1)
    return rows[known]


def _is(value: Any, text: str) -> bool:
    if _number(value):
        try:
            return bool(np.isclose(float(value), float(text), rtol=1e-9))
        except ValueError:
            return False
    return str(value) == text


def _number(value: Any) -> bool:
    return isinstance(value, float | int | np.floating)


def payload(found: Landscape, dataset: xr.Dataset) -> dict[str, Any]:
    """The landscape as plain values for a page, with what is said of each case."""
    keys = dataset["key"].to_numpy().ravel()
    words = {w: dataset[w].to_numpy().ravel() for w in ("key", "status", "reason")}
    numbers = {n: dataset[n].to_numpy().ravel() for n in ("cost_of_transport", "human_distance")}
    cases = [
        {w: str(words[w][i]) for w in words} | {n: _plain(numbers[n][i]) for n in numbers}
        for i in range(len(keys))
    ]
    return {
        "x": _list(found.x),
        "y": None if found.y is None else _list(found.y),
        "x_name": found.x_name,
        "y_name": found.y_name,
        "energy": _list(found.energy),
        "accepted": found.accepted.tolist(),
        "triangles": found.triangles.tolist(),
        "speed": None if found.speed is None else _list(found.speed),
        "cadence": None if found.cadence is None else _list(found.cadence),
        "valley": [_list(row) for row in found.valley],
        "people": [_list(row) for row in found.people],
        "people_name": found.people_name,
        "plain": [_list(row) for row in found.plain],
        "plain_name": found.plain_name,
        "cases": cases,
    }


def _list(values: Sequence[float] | Array) -> list[float | None]:
    return [_plain(value) for value in values]


def _plain(value: float) -> float | None:
    return float(f"{value:.6g}") if np.isfinite(value) else None
