"""Design with the gait: numbers of devices and body that are free between bounds."""

from __future__ import annotations

import difflib
import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast

from pydantic import Field, GetJsonSchemaHandler, model_serializer, model_validator
from pydantic_core import CoreSchema

from ergowalk.errors import InputError, ProblemError
from ergowalk.values import FiniteFloat, Value, invalid

if TYPE_CHECKING:
    from ergowalk.problem.gait_problem import GaitProblem

TABLES, GIVEN = ("body", "devices"), ("gravity_m_s2",)
"""Tables whose numbers may be free, and numbers in them that may not."""

MOST_CORNERS = 64
"""Corners of the bounds that are looked at before anything is solved."""


class FreeNumber(Value):
    """A number of the problem that is free between two bounds, in its own unit."""

    _error = ProblemError

    path: str
    lowest: FiniteFloat
    highest: FiniteFloat

    @property
    def middle(self) -> float:
        """Half way between the bounds."""
        return (self.lowest + self.highest) / 2

    def inside(self, value: float) -> float:
        """The value, or the bound that it is beyond."""
        return min(max(value, self.lowest), self.highest)


class Design(Value):
    """Numbers that are found together with the gait: ``"path" = [lowest, highest]`` for each."""

    _error = ProblemError

    free: tuple[FreeNumber, ...] = Field(default=(), exclude=True)

    def __bool__(self) -> bool:
        """Whether any number is free."""
        return bool(self.free)

    @property
    def paths(self) -> tuple[str, ...]:
        """Where the free numbers stand in the problem."""
        return tuple(number.path for number in self.free)

    def sentence(self) -> str:
        """The free numbers and their bounds in words."""
        return ", ".join(f"{f.path} from {f.lowest:g} to {f.highest:g}" for f in self.free)

    def held(self, values: Mapping[str, float]) -> Design:
        """The same numbers, their bounds shrunk to these values."""
        free = [FreeNumber(path=p, lowest=values[p], highest=values[p]) for p in self.paths]
        return Design(free=tuple(free))

    @model_validator(mode="before")
    @classmethod
    def _from_table(cls, data: Any) -> Any:
        """A table of bounds by path; paths may be nested tables, as dots in TOML make them."""
        if not isinstance(data, dict) or isinstance(data.get("free"), tuple | list):
            return data
        found = []
        for path, bounds in _flat(data):
            pair = isinstance(bounds, list | tuple) and len(bounds) == 2
            if not pair or not all(map(_is_number, bounds)):
                raise invalid(
                    path,
                    bounds,
                    "should be a pair of numbers",
                    "give the lowest and the highest value, as [50.0, 600.0]",
                )
            lowest, highest = map(float, bounds)
            if lowest > highest:
                raise invalid(
                    path, bounds, "the lowest value comes first", "exchange the two numbers"
                )
            found.append({"path": path, "lowest": lowest, "highest": highest})
        return {"free": found}

    @model_serializer
    def _as_table(self) -> dict[str, tuple[float, float]]:
        return {f.path: (f.lowest, f.highest) for f in self.free}

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """As a problem file has it: pairs of numbers by path."""
        pair = {"items": {"type": "number"}, "maxItems": 2, "minItems": 2, "type": "array"}
        words = (cls.__doc__ or "").split("\n\n", maxsplit=1)[0]
        return {
            "additionalProperties": {"anyOf": [pair, {"type": "object"}]},
            "description": words,
            "title": "Design",
            "type": "object",
        }


def free_values(problem: GaitProblem) -> dict[str, float]:
    """The present values of the free numbers, by path."""
    return {path: value_at(problem, path) for path in problem.design.paths}


def value_at(problem: GaitProblem, path: str) -> Any:
    """What stands at the path of a number, be it an expression; None if nothing does."""
    place: Any = problem
    for part in path.split("."):
        pair = isinstance(place, tuple)
        place = place[int(part) - 1] if pair else getattr(place, part, None)
    return place


def with_values(problem: GaitProblem, values: Mapping[str, float]) -> GaitProblem:
    """The problem with numbers at paths replaced and validated anew, the bounds kept."""
    return cast("GaitProblem", _put(problem, _nested(values), lambda v, c: v.replace(**c)))


def with_symbols(problem: GaitProblem, values: Mapping[str, Any]) -> GaitProblem:
    """A problem that has expressions in place of numbers; nothing is validated.

    The mechanics and the laws of devices take it like any other.
    """
    return cast("GaitProblem", _put(problem, _nested(values), lambda v, c: v.model_copy(update=c)))


def held_at(problem: GaitProblem, values: Mapping[str, float]) -> GaitProblem:
    """The problem with its free numbers held at values: their bounds leave no room."""
    bare = with_values(problem.replace(design=Design()), values)
    return cast("GaitProblem", bare.replace(design=problem.design.held(values)))


def with_bound(problem: GaitProblem, name: str, value: float) -> GaitProblem:
    """The problem with one bound, ``design.PATH.low`` or ``.high``, moved.

    The number itself moves along where the bound would leave it outside.
    """
    path, _, end = name.removeprefix("design.").rpartition(".")
    bounds = {f.path: {"low": f.lowest, "high": f.highest} for f in problem.design.free}
    bounds[path][end] = value
    table = {p: (b["low"], b["high"]) for p, b in bounds.items()}
    moved = max(min(free_values(problem)[path], bounds[path]["high"]), bounds[path]["low"])
    bare = with_values(problem.replace(design=Design()), {path: moved})
    return cast("GaitProblem", bare.replace(design=table))


def bounds_of(problem: GaitProblem) -> Iterator[tuple[str, float]]:
    """(``design.PATH.low`` or ``.high``, value) of every bound."""
    for free in problem.design.free:
        yield f"design.{free.path}.low", free.lowest
        yield f"design.{free.path}.high", free.highest


def designable(problem: Value) -> Iterator[tuple[str, float]]:
    """(path, value) of every number that may be free."""
    for table in TABLES:
        yield from _numbers(getattr(problem, table), table)


def check_design(problem: GaitProblem) -> None:
    """Whether the free numbers exist, start inside their bounds, and every corner can be.

    Raises
    ------
    PydanticCustomError
        As validators do, naming the path, its value, the rule and the remedy.
    """
    if not problem.design:
        return
    known = dict(designable(problem))
    for number in problem.design.free:
        if number.path not in known:
            raise _unknown(number.path, known)
        value = known[number.path]
        if not number.lowest <= value <= number.highest:
            raise invalid(
                f"design.{number.path}",
                [number.lowest, number.highest],
                f"the search starts at the problem's own value, {value:g}, which lies outside",
                f"move {number.path} or the bounds",
            )
    if len(set(problem.design.paths)) < len(problem.design.paths):
        raise invalid("design", list(problem.design.paths), "a path stands twice", "remove one")
    _check_swinging_foot(problem)
    bare = problem.replace(design=Design())
    for corner in _corners(problem.design):
        try:
            with_values(bare, corner)
        except InputError as error:
            at = ", ".join(f"{path} = {value:g}" for path, value in corner.items())
            raise invalid(
                "design",
                None,
                f"with {at} there is no such walker: {error.field}: {error.rule}",
                "narrow the bounds",
            ) from None


def _check_swinging_foot(problem: GaitProblem) -> None:
    """A damper that lets a massless foot go at once leaves nothing that would move it."""
    for free in problem.design.free:
        place, _, name = free.path.rpartition(".")
        if name != "damping_nms_per_rad" or not place.endswith("ankle") or free.lowest > 0:
            continue
        device = value_at(problem, place)
        if not device.own_moment and "swing" in device.active:
            raise invalid(
                f"design.{free.path}",
                [free.lowest, free.highest],
                "must be above 0: this damper moves the massless swinging foot",
                "raise the lowest value",
            )


def _corners(design: Design) -> Iterator[dict[str, float]]:
    """Corners of the bounds; of very many, each bound by itself and both extremes."""
    ends = [(f.lowest, f.highest) for f in design.free]
    if 2 ** len(ends) <= MOST_CORNERS:
        for corner in itertools.product(*ends):
            yield dict(zip(design.paths, corner, strict=True))
        return
    middle = {f.path: f.middle for f in design.free}
    for k in (0, 1):
        yield {f.path: (f.lowest, f.highest)[k] for f in design.free}
        for f in design.free:
            yield {**middle, f.path: (f.lowest, f.highest)[k]}


def _numbers(table: Value, path: str) -> Iterator[tuple[str, float]]:
    for name in type(table).model_fields:
        value = getattr(table, name)
        if isinstance(value, Value):
            yield from _numbers(value, f"{path}.{name}")
        elif isinstance(value, tuple) and value and all(map(_is_number, value)):
            for i, part in enumerate(value, start=1):
                yield f"{path}.{name}.{i}", float(part)
        elif _is_number(value) and name not in GIVEN:
            yield f"{path}.{name}", float(value)


def _unknown(path: str, known: Mapping[str, float]) -> Exception:
    pair = [f"{path}.{leg}" for leg in (1, 2) if f"{path}.{leg}" in known]
    if pair:
        return invalid(
            f"design.{path}", None, "is a pair, one number for each leg", f"use {' or '.join(pair)}"
        )
    near = difflib.get_close_matches(path, known, n=3, cutoff=0.5) or list(known)[:3]
    return invalid(
        f"design.{path}",
        None,
        "the problem has no such number of its body or its devices",
        f"the nearest are {', '.join(near)}",
    )


def _put(
    value: Value, changes: Mapping[str, Any], make: Callable[[Value, dict[str, Any]], Value]
) -> Value:
    """A value with what is in nested tables replaced, all of one table at once."""
    made: dict[str, Any] = {}
    for name, change in changes.items():
        old = getattr(value, name)
        if not isinstance(change, dict):
            made[name] = change
        elif isinstance(old, tuple):
            made[name] = tuple(change.get(str(i), x) for i, x in enumerate(old, start=1))
        else:
            made[name] = _put(old, change, make)
    return make(value, made) if made else value


def _nested(values: Mapping[str, Any]) -> dict[str, Any]:
    """Values by path as nested tables."""
    tree: dict[str, Any] = {}
    for path, value in values.items():
        *within, name = path.split(".")
        place = tree
        for part in within:
            place = place.setdefault(part, {})
        place[name] = value
    return tree


def _flat(table: Mapping[str, Any], within: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{within}{name}.")
        else:
            yield f"{within}{name}", value


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
