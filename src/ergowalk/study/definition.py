"""A sweep as a value: which problems, solved how; and the TOML file that says so."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from ergowalk.errors import InputError, SweepError
from ergowalk.problem import DEFAULT_PRESET, GaitProblem, preset
from ergowalk.problem.files import read_problem
from ergowalk.values import FiniteFloat, Value, invalid

MOST_CASES = 100_000
"""Largest number of cases; what stands in the way of more is in "Maps of gaits"."""

Count = Annotated[int, Field(ge=1, le=MOST_CASES, strict=True)]


class SearchOptions(Value):
    """How each case is solved, and when it is given up."""

    _error = SweepError

    continuation: bool = Field(
        default=True, description="whether a case begins at the gait of its neighbour"
    )
    starts: Count = Field(
        default=1,
        description="searches of each case, the best accepted gait is kept: the neighbour's gait, "
        "then the human means, then seeded disturbances of them",
    )
    seed: Annotated[int, Field(ge=0, strict=True)] = Field(
        default=0, description="seed of the disturbances"
    )
    probes: Annotated[int, Field(ge=0, le=MOST_CASES, strict=True)] = Field(
        default=0,
        description="cases, spread over the sweep, that are searched from the human means too",
    )
    second_looks: Annotated[int, Field(ge=0, le=100, strict=True)] = Field(
        default=0,
        description="rounds in which cases are searched again from a neighbour whose gait promises "
        "a cheaper one; the cheapest accepted gait stands for the case",
    )
    time_limit_s: Annotated[float, Field(gt=0, allow_inf_nan=False, strict=True)] = Field(
        default=1800.0, description="time after which a case is given up, in s"
    )
    memory_limit_mb: Annotated[float, Field(ge=64, allow_inf_nan=False, strict=True)] = Field(
        default=4096.0, description="memory that a case may take, in MB (2^20 bytes)"
    )


class Range(Value):
    """``count`` equally spaced numbers, both ends included."""

    _error = SweepError

    low: FiniteFloat = Field(description="the first number")
    high: FiniteFloat = Field(description="the last number, above the first")
    count: Count = Field(description="how many numbers, from 1")

    def numbers(self) -> list[float]:
        """The numbers, to twelve digits: 0.76 and not 0.7600000000000001."""
        if self.count == 1:
            return [self.low]
        step = (self.high - self.low) / (self.count - 1)
        return [float(f"{self.low + i * step:.12g}") for i in range(self.count)]

    @model_validator(mode="after")
    def _ascending(self) -> Self:
        if self.low >= self.high and self.count > 1:
            raise invalid("high", self.high, f"must be above low, {self.low:g}", "exchange them")
        return self


class RandomCases(Value):
    """A seeded Latin hypercube between bounds."""

    _error = SweepError

    count: Count = Field(description="how many cases")
    seed: Annotated[int, Field(ge=0, strict=True)] = Field(default=0, description="seed")
    between: dict[str, Any] = Field(description="lower and upper bound of each swept number")


class Sweep(Value):
    """Problems that differ in some fields: a grid, a list of cases, or random ones.

    Fields are named as in a problem file, with dots: ``step_length_m``,
    ``limits.friction_coefficient``.

    Raises
    ------
    SweepError
        For fields that a problem does not have, values that stand twice, and anything but exactly
        one of grid, cases and random.
    """

    _error = SweepError

    name: str = Field(default="sweep", pattern=r"^[A-Za-z0-9_][A-Za-z0-9_.-]{0,59}$")
    base: GaitProblem = Field(description="the problem whose fields are changed")
    start: Path | None = Field(default=None, description="a gait with which the first case begins")
    solve: SearchOptions = Field(default=SearchOptions())
    grid: dict[str, list[Any]] | None = Field(default=None, description="values of each field")
    cases: list[dict[str, Any]] | None = Field(default=None, description="fields of each case")
    random: RandomCases | None = Field(default=None)

    @property
    def fields(self) -> tuple[str, ...]:
        """The swept fields, in the order in which they are given."""
        if self.grid is not None:
            return tuple(self.grid)
        if self.random is not None:
            return tuple(self.random.between)
        return tuple(dict.fromkeys(name for case in self.cases or () for name in case))

    def value_in_base(self, field: str) -> Any:
        """What the base problem has there, as a problem file would say it."""
        value: Any = self.base
        for part in field.split("."):
            value = getattr(value, part)
        return list(value) if isinstance(value, tuple) else value

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        given = [n for n in ("grid", "cases", "random") if getattr(self, n) is not None]
        if len(given) != 1:
            found = " and ".join(given) or "none"
            raise invalid(
                "sweep", found, "must have one of [grid], [[cases]], [random]", "give exactly one"
            )
        if not self.fields:
            raise invalid(given[0], "nothing", "must sweep a field", "name one and its values")
        return self

    @model_validator(mode="after")
    def _fields_exist(self) -> Self:
        for field in self.fields:
            _check_field(field)
        return self

    @model_validator(mode="after")
    def _values_differ(self) -> Self:
        count = 1
        for field, values in (self.grid or {}).items():
            if not values:
                raise invalid(field, values, "has no values", "give at least one")
            for i, value in enumerate(values):
                if any(same(value, other) for other in values[:i]):
                    raise invalid(field, value, "stands twice", "leave out the second")
            count *= len(values)
        if count > MOST_CASES:
            raise invalid("grid", count, f"has more than {MOST_CASES} cases", "take fewer values")
        for field, ends in (self.random.between if self.random else {}).items():
            if not _is_interval(ends):
                raise invalid(field, ends, "must be two numbers, the lower first", "give [a, b]")
        return self


def same(one: Any, other: Any) -> bool:
    """Whether two values of a problem file are one: 1 is 1.0, but not true."""
    return isinstance(one, bool) == isinstance(other, bool) and bool(one == other)


def read_sweep(path: str | Path) -> Sweep:
    """The sweep of a TOML file.

    ``problem`` is the name of a problem file beside it, or ``preset`` a preset; ``start`` the name
    of a gait file beside it. Tables: ``solve``, and one of ``grid``, ``cases``, ``random``. A field
    of the grid has a list of values, or ``{low = ..., high = ..., count = ...}``.

    Raises
    ------
    SweepError, ProblemError, BodyError, CorridorError
        If the file or its problem cannot be read, or makes no sweep. The message names the file.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise SweepError(
            f"cannot be read ({error.strerror})", "give a sweep file", file=str(path)
        ) from None
    except (ValueError, RecursionError) as error:
        reason = str(error) or "nested too deeply"
        raise SweepError(
            f"not valid TOML: {reason}", "see 'Sweep a problem' in the manual", file=str(path)
        ) from None
    try:
        return _from_data(data, path.absolute().parent)
    except InputError as error:
        raise error.located(str(path)) from None


def _from_data(data: dict[str, Any], folder: Path) -> Sweep:
    data = dict(data)
    if "base" in data:
        raise SweepError("unknown key", "name a problem file or a preset", field="base")
    base = _base(data.pop("problem", None), data.pop("preset", None), folder)
    if isinstance(data.get("grid"), dict):
        data["grid"] = {k: _values(k, v) for k, v in _flat(data["grid"])}
    if isinstance(data.get("cases"), list):
        data["cases"] = [dict(_flat(c)) if isinstance(c, dict) else c for c in data["cases"]]
    random = data.get("random")
    if isinstance(random, dict) and isinstance(random.get("between"), dict):
        data["random"] = {**random, "between": dict(_flat(random["between"]))}
    if isinstance(data.get("start"), str):
        data["start"] = folder / data["start"]
    return Sweep(base=base, **data)


def _base(problem: Any, name: Any, folder: Path) -> GaitProblem:
    if problem is not None and name is not None:
        raise SweepError("contradicts preset", "give one of them", field="problem", value=problem)
    for key, value in (("problem", problem), ("preset", name)):
        if value is not None and not isinstance(value, str):
            raise SweepError("should be a string", "give a name", field=key, value=value)
    if problem is not None:
        return read_problem(folder / problem)
    return preset(name or DEFAULT_PRESET)


def _values(field: str, given: Any) -> Any:
    """A list as it is; a range as its numbers."""
    if isinstance(given, dict):
        try:
            return Range(**given).numbers()
        except InputError as error:
            error.field = f"grid.{field}" + (f".{error.field}" if error.field else "")
            raise
    return given


def _flat(table: Mapping[str, Any], place: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted names and values; a range ``{low, high, count}`` is a value."""
    for key, value in table.items():
        name = f"{place}.{key}" if place else key
        if isinstance(value, dict) and not {"low", "high", "count"} & value.keys():
            yield from _flat(value, name)
        else:
            yield name, value


def _check_field(field: str) -> None:
    model: Any = GaitProblem
    *tables, last = field.split(".")
    for part in tables:
        found = model.model_fields.get(part) if model else None
        inner = found.annotation if found else None
        model = inner if isinstance(inner, type) and issubclass(inner, Value) else None
    known = {n: f for n, f in model.model_fields.items() if not f.exclude} if model else {}
    table = known.get(last) is not None and isinstance(known[last].annotation, type)
    if last not in known or (table and issubclass(known[last].annotation, Value)):
        names = ", ".join(".".join([*tables, name]) for name in known)
        raise invalid(
            field,
            None,
            "a problem has no such field",
            f"use one of {names}" if known else "name a key of a problem file, with dots",
        )


def _is_interval(ends: Any) -> bool:
    return (
        isinstance(ends, list)
        and len(ends) == 2
        and all(isinstance(e, int | float) and not isinstance(e, bool) for e in ends)
        and all(math.isfinite(e) for e in ends)
        and ends[0] < ends[1]
    )
