"""Frozen, validated values: the base of everything that a user may write down.

Fields are declared once, with type, default and description; validation, problem files and their
schema follow from the declaration. What pydantic finds wrong is told as one
:class:`~ergowalk.errors.InputError` with field, value, rule and remedy.
"""

from __future__ import annotations

import difflib
import math
from typing import Annotated, Any, ClassVar, NoReturn

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError

from ergowalk.errors import InputError

FiniteFloat = Annotated[float, Field(allow_inf_nan=False, strict=True)]
PositiveFloat = Annotated[float, Field(gt=0, allow_inf_nan=False, strict=True)]
NonNegativeFloat = Annotated[float, Field(ge=0, allow_inf_nan=False, strict=True)]

INPUT_ONLY: dict[str, Any] = {"writeOnly": True}
"""``json_schema_extra`` of a field that a file may give and that other fields take over."""


class Value(BaseModel):
    """Immutable value object; equal when all fields are equal."""

    model_config = ConfigDict(frozen=True, extra="forbid", validate_default=True)

    _error: ClassVar[type[InputError]] = InputError

    def __init__(self, /, **data: Any) -> None:  # a key may be called self
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise_input_error(error, type(self))

    def replace(self, **changes: Any) -> Any:
        """A copy with some fields changed, validated anew."""
        fields = {name: getattr(self, name) for name in type(self).model_fields}
        return type(self)(**{**fields, **changes})


def as_json(value: Any) -> Any:
    """The value, plain or made of lists and tables, with None for numbers that JSON lacks."""
    if isinstance(value, dict):
        return {key: as_json(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def is_key(field: FieldInfo) -> bool:
    """Whether a file may give this field."""
    return not field.exclude or field.json_schema_extra == INPUT_ONLY


def invalid(field: str, value: object, rule: str, remedy: str) -> PydanticCustomError:
    """What a validator raises for a combination of fields that cannot be."""
    context = {"field": field, "value": value, "rule": rule, "remedy": remedy}
    return PydanticCustomError("ergowalk", "{rule}; {remedy}", context)


def raise_input_error(error: ValidationError, model: type[Value]) -> NoReturn:
    """Turn the first finding of pydantic into one line for a person."""
    detail = _finding(error.errors(include_url=False))
    place = [str(part) for part in detail["loc"] if not _is_union_tag(part)]
    kind, context = detail["type"], detail.get("ctx", {})
    value = detail.get("input")
    inner = context.get("error")
    if isinstance(inner, InputError):  # found by a nested value: only the place is longer
        inner.field = ".".join([*place, *([inner.field] if inner.field else [])])
        raise inner from None
    if kind == "ergowalk":
        place.append(str(context["field"]))
        value, rule, remedy = context["value"], context["rule"], context["remedy"]
    elif kind == "extra_forbidden":  # the last part is the user's word, whatever it looks like
        *within, key = detail["loc"]
        place = [*(str(part) for part in within if not _is_union_tag(part)), str(key)]
        rule, remedy, value = "unknown key", _nearest(place, model), None
    elif kind in ("missing", "too_long") and isinstance(value, list | tuple):
        rule, remedy = "should be one number or a pair of numbers", _remedy(place, model)
    elif kind == "missing":
        rule, remedy, value = "required but missing", "add it", None
    else:
        rule, remedy = _rule(detail), _remedy(place, model)
    raise model._error(rule, remedy, field=".".join(place) or None, value=value) from None


def _finding(details: list[ErrorDetails]) -> ErrorDetails:
    """The first finding; of a value "one number or a pair" that is a pair, what is wrong in it.

    An unknown key goes before a missing one, which it may be with another spelling.
    """
    unknown = [detail for detail in details if detail["type"] == "extra_forbidden"]
    if unknown and details[0]["type"] == "missing":
        return unknown[0]
    place = details[0]["loc"][:1]
    pairs = [
        detail
        for detail in details
        if detail["loc"][:1] == place
        and any(str(part).startswith("tuple[") for part in detail["loc"])
        and detail["type"] != "tuple_type"
    ]
    return (pairs or details)[0]


def _rule(detail: ErrorDetails) -> str:
    if detail["type"] in ("model_type", "model_attributes_type"):
        return "should be a table of keys and values"
    message = detail["msg"].removeprefix("Input ")
    return message[0].lower() + message[1:]


def _remedy(place: list[str], model: type[Value]) -> str:
    fields = _model_at(place[:-1], model).model_fields if place else {}
    field = fields.get(place[-1]) if place else None
    if field is not None and field.description:
        return f"give {field.description}"
    return "see 'ergowalk init' for a commented example"


def _nearest(place: list[str], model: type[Value]) -> str:
    fields = _model_at(place[:-1], model).model_fields
    known = [name for name, field in fields.items() if is_key(field)]
    close = difflib.get_close_matches(place[-1], known, n=1)
    return f"did you mean '{close[0]}'?" if close else f"known keys: {', '.join(known)}"


def _model_at(place: list[str], model: type[Value]) -> type[Value]:
    for part in place:
        field = model.model_fields.get(part)
        inner = field.annotation if field else None
        if not (isinstance(inner, type) and issubclass(inner, Value)):
            break
        model = inner
    return model


def _is_union_tag(part: object) -> bool:
    """pydantic adds the tried member of a union to the location; a reader does not want it."""
    return isinstance(part, int) or any(c in str(part) for c in "[]()") or str(part) in _TAGS


_TAGS = {"float", "constrained-float", "tuple", "none", "literal", "str"}
