"""One line for every mistake: file, field, value, rule and remedy."""

from __future__ import annotations

from typing import Any, Self

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import Field, ValidationError, model_validator

from ergowalk.body import Body
from ergowalk.errors import (
    BodyError,
    CorridorError,
    ErgowalkError,
    GaitFileError,
    InputError,
    OutputError,
    ProblemError,
)
from ergowalk.values import FiniteFloat, PositiveFloat, Value, invalid

LAW = settings(deadline=None, max_examples=50, derandomize=True, database=None)


class Wheel(Value):
    _error = BodyError

    radius_m: PositiveFloat = Field(default=0.3, description="radius in m")
    camber_deg: FiniteFloat | tuple[FiniteFloat, FiniteFloat] = Field(
        default=0.0, description="camber in degrees, or a pair"
    )


class Axle(Value):
    _error = ProblemError

    wheel: Wheel = Field(default=Wheel(), description="the wheel")
    width_m: PositiveFloat = Field(description="track width in m")


class Cart(Value):
    front: Axle = Field(description="front axle")
    length_m: PositiveFloat = Field(default=2.0, description="length in m")

    @model_validator(mode="after")
    def _not_square(self) -> Self:
        if self.length_m <= self.front.width_m:
            raise invalid("length_m", self.length_m, "must exceed the width", "lengthen the cart")
        return self


def written(kind: type[Value], **fields: Any) -> Any:
    """What a file says, nested tables and mistakes included, as a value."""
    return kind(**fields)


def cart(**front: Any) -> Any:
    return written(Cart, front={"width_m": 1.0, **front})


def test_values_are_equal_when_their_fields_are() -> None:
    assert cart() == Cart(front=Axle(width_m=1.0))
    assert hash(cart()) == hash(Cart(front=Axle(width_m=1.0)))
    assert cart() != cart(width_m=1.1)


def test_values_cannot_be_changed() -> None:
    wheel = Wheel()
    with pytest.raises(ValidationError, match="frozen"):
        wheel.__setattr__("radius_m", 1.0)
    assert wheel == Wheel()


def test_replace_changes_a_copy() -> None:
    wheel = Wheel(camber_deg=(1.0, 2.0))
    assert wheel.replace(radius_m=0.5) == Wheel(radius_m=0.5, camber_deg=(1.0, 2.0))
    assert wheel.radius_m == 0.3
    assert cart().replace(length_m=3.0).front == cart().front


def test_replace_validates_anew() -> None:
    with pytest.raises(BodyError, match=r"^radius_m = -1: should be greater than 0; give radius"):
        Wheel().replace(radius_m=-1)
    with pytest.raises(BodyError, match="^radius: unknown key; did you mean 'radius_m'"):
        Wheel().replace(radius=1.0)
    with pytest.raises(InputError, match=r"^length_m = 0\.5: must exceed the width; lengthen the"):
        cart().replace(length_m=0.5)


@pytest.mark.parametrize(
    ("front", "error", "message"),
    [
        ({"wheel": {"radius": 1}}, BodyError, r"wheel\.radius: unknown key; did you mean 'radius"),
        ({"whel": {}}, ProblemError, r"whel: unknown key; did you mean 'wheel'\?$"),
        ({"engine": 1}, ProblemError, r"engine: unknown key; known keys: wheel, width_m$"),
        ({"self": 1}, ProblemError, r"self: unknown key; known keys: wheel, width_m$"),
        ({"str": 1}, ProblemError, r"str: unknown key; known keys: wheel, width_m$"),
        ({"wheel": {"a[0]": 1}}, BodyError, r"wheel\.a\[0\]: unknown key; known keys: radius_m, "),
        ({"width_m": -2}, ProblemError, r"width_m = -2: should be greater than 0; give track wid"),
        ({"wheel": {"radius_m": "1"}}, BodyError, r"wheel\.radius_m = '1': should be a valid num"),
        ({"wheel": 7}, ProblemError, r"wheel = 7: should be a table of keys and values; give the"),
        ({"wheel": {"camber_deg": [1.0, "x"]}}, BodyError, r"wheel\.camber_deg = 'x': should be a"),
        ({"wheel": {"camber_deg": [1.0]}}, BodyError, r"camber_deg = \[1\.0\]: should be one numb"),
    ],
)
def test_nested_mistake_is_told_with_its_path_and_its_kind(
    front: dict[str, Any], error: type[InputError], message: str
) -> None:
    with pytest.raises(error, match=message) as caught:
        cart(**front)
    assert type(caught.value) is error
    assert str(caught.value).startswith("front.")


def test_missing_field_is_named() -> None:
    with pytest.raises(InputError, match="^front: required but missing; add it$"):
        written(Cart, length_m=2.0)
    with pytest.raises(ProblemError, match=r"^front\.width_m: required but missing; add it$"):
        written(Cart, front={})


def test_combination_of_fields_is_told_like_a_single_one() -> None:
    message = r"^length_m = 1\.0: must exceed the width; lengthen the cart$"
    with pytest.raises(InputError, match=message) as caught:
        written(Cart, front={"width_m": 1.5}, length_m=1.0)
    error = caught.value
    assert (error.field, error.value, error.rule) == ("length_m", 1.0, "must exceed the width")
    assert error.remedy == "lengthen the cart"


def test_first_mistake_is_told_alone() -> None:
    with pytest.raises(
        BodyError, match=r"^trunk_mass_kg = -1: should be greater than 0; give [^;]*$"
    ):
        written(Body, trunk_mass_kg=-1, trunk_com_m=-2, nonsense=3)


def test_error_says_file_field_value_rule_and_remedy() -> None:
    error = InputError("must fit", "trim it", field="a.b", value=3, file="x.toml")
    assert str(error) == "x.toml: a.b = 3: must fit; trim it"
    assert str(InputError("must fit", "trim it")) == "must fit; trim it"
    assert str(InputError("must fit", "trim it", field="a")) == "a: must fit; trim it"
    assert str(InputError("must fit", "trim it", file="x")) == "x: must fit; trim it"


def test_file_is_added_where_it_becomes_known_and_the_first_one_stays() -> None:
    error = ProblemError("must fit", "trim it", field="a", value=1)
    assert error.located("walk.toml") is error
    assert str(error) == "walk.toml: a = 1: must fit; trim it"
    assert str(error.located("other.toml")) == "walk.toml: a = 1: must fit; trim it"


def test_false_and_zero_are_values_too() -> None:
    assert str(InputError("r", "m", field="a", value=0)) == "a = 0: r; m"
    assert str(InputError("r", "m", field="a", value=False)) == "a = False: r; m"


def test_long_values_are_cut() -> None:
    text = str(InputError("must fit", "trim it", field="a", value="x" * 500))
    assert "…" in text
    assert len(text) < 100


def test_all_errors_share_one_root_and_are_value_errors() -> None:
    for kind in (BodyError, CorridorError, ProblemError, GaitFileError, OutputError):
        assert issubclass(kind, InputError)
    assert issubclass(InputError, ErgowalkError)
    assert issubclass(InputError, ValueError)


words = st.text(st.sampled_from("aZ_9 .[]()'\n\r\t\x0b\x1c\x85\u2028ü{}"), max_size=12)
"""Anything that a file may hold, line ends of all kinds above all."""


@LAW
@given(words, words, words, words, st.one_of(words, st.lists(words), st.binary(max_size=9)))
def test_every_message_is_one_line(
    rule: str, remedy: str, field: str, file: str, value: object
) -> None:
    error = InputError(rule, remedy, field=field, value=value, file=file)
    assert len(str(error).splitlines()) == 1
    assert len(error.args[0].splitlines()) == 1
    later = InputError(rule, remedy, field=field, value=value).located(file)
    assert len(str(later).splitlines()) == 1


names = words | st.sampled_from(["self", "str", "float", "tuple", "none", "data", "cls", "model"])


@LAW
@given(st.dictionaries(names, st.one_of(words, st.floats(), st.just([1.0, 2.0])), min_size=1))
def test_whatever_is_written_down_gives_one_line_of_ours(table: dict[str, Any]) -> None:
    for build in (lambda: Wheel(**table), lambda: cart(**table), lambda: cart(wheel=table)):
        with pytest.raises(InputError, match="unknown key; ") as caught:
            build()
        assert len(str(caught.value).splitlines()) == 1
