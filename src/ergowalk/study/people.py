"""How long people step at a given speed: 43 adults on a treadmill (Fukuchi et al. 2018)."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.errors import InputError

Array = NDArray[np.float64]

TABLE = "data/fukuchi2018/steps.csv"

SOURCE = "Fukuchi et al. 2018"

FEWEST = 10
"""People that a mean takes at least."""


@dataclass(frozen=True)
class StepsOfPeople:
    """Mean and SD between people at some speeds; arrays (n,), NaN where there are too few people.

    Attributes
    ----------
    speed : array [m/s]
    step_length, step_length_sd : arrays [m]
    cadence, cadence_sd : arrays [steps/min]
    people : array
        How many people walked both slower and faster.
    """

    speed: Array
    step_length: Array
    step_length_sd: Array
    cadence: Array
    cadence_sd: Array
    people: NDArray[np.int_]


@dataclass(frozen=True)
class Person:
    """Leg length [m], speeds [m/s], ascending, and step lengths [m] at them (6,)."""

    leg_length: float
    speed: Array
    step_length: Array


def steps_of_people(
    speeds: Sequence[float] | Array, leg_length: float | None = None
) -> StepsOfPeople:
    """Step length and cadence of people at some speeds.

    Each person's step length is interpolated between the speeds at which that person walked, never
    beyond; then mean and SD are taken between people.

    Parameters
    ----------
    speeds : (n,) array [m/s]
    leg_length : float, optional
        Scale people to legs of this length [m] first: lengths by the length of the leg, speeds by
        its square root, as of bodies in dynamic similarity.

    Raises
    ------
    InputError
        For a speed or a leg length that is not positive.
    """
    at = np.asarray(speeds, dtype=float)
    if not np.all(at > 0) or not np.all(np.isfinite(at)):
        raise InputError("must be positive", "give speeds in m/s", field="speeds", value=speeds)
    if leg_length is not None and not 0 < leg_length < np.inf:
        raise InputError(
            "must be positive", "give a length in m", field="leg_length", value=leg_length
        )
    steps = np.array([_at(person, at, leg_length) for person in people()])
    enough = np.isfinite(steps).sum(axis=0) >= FEWEST
    steps = np.where(enough, steps, np.nan)
    cadence = 60 * at / steps
    mean, sd = _mean_sd(steps)
    cadence_mean, cadence_sd = _mean_sd(cadence)
    return StepsOfPeople(at, mean, sd, cadence_mean, cadence_sd, np.isfinite(steps).sum(axis=0))


def leg_length(body: Body) -> float:
    """Hip to sole of a body that stands upright [m]."""
    leg = body.leg(0)
    return leg.thigh_length + leg.shank_length + leg.ankle_height


@cache
def people() -> tuple[Person, ...]:
    """The people of the packaged table."""
    text = resources.files("ergowalk").joinpath(TABLE).read_text("utf-8")
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for row in csv.DictReader(text.splitlines()):
        numbers = (row["speed_m_per_s"], row["step_length_m"], row["leg_length_m"])
        one, two, three = map(float, numbers)
        rows.setdefault(row["subject"], []).append((one, two, three))
    found = []
    for lines in rows.values():
        speed, step, leg = np.array(sorted(lines)).T
        found.append(Person(float(leg[0]), speed, step))
    return tuple(found)


def _at(person: Person, speeds: Array, leg: float | None) -> Array:
    """Step lengths (n,) of a person at some speeds; NaN outside those that were walked."""
    larger = 1.0 if leg is None else leg / person.leg_length
    return np.interp(
        speeds,
        person.speed * np.sqrt(larger),
        person.step_length * larger,
        left=np.nan,
        right=np.nan,
    )


def _mean_sd(values: Array) -> tuple[Array, Array]:
    """Mean and SD (n,) between people (m, n) of what is a number."""
    known = np.isfinite(values)
    count = known.sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = np.where(known, values, 0.0).sum(axis=0) / count
        squares = np.where(known, (values - mean) ** 2, 0.0).sum(axis=0)
        return mean, np.sqrt(squares / np.where(count > 1, count - 1, np.nan))
