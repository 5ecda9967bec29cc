"""Bodies: what can exist, what cannot, and the paper's names for it."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.body import LARGEST, SMALLEST, SYMBOLS, Body
from ergowalk.errors import BodyError

LAW = settings(deadline=None, max_examples=100, derandomize=True, database=None)

LEG_FIELDS = [name for name in Body.model_fields if not name.startswith(("trunk", "gravity"))]

PAIR: dict[str, Any] = {"thigh_mass_kg": (8.0, 9.0), "heel_to_metatarsal_m": (0.2, 0.25)}


def written(**fields: Any) -> Body:
    """What a file says, mistakes included, as a body."""
    return Body(**fields)


def test_defaults_are_the_papers() -> None:
    body = Body()
    assert body.total_mass == pytest.approx(73.18)
    assert body.legs_equal
    assert [body.by_symbol()[k] for k in ("m", "r", "J", "a", "b", "l_m")] == [
        46.7,
        0.39,
        7.096,
        0.47,
        0.53,
        0.1,
    ]


@pytest.mark.parametrize(
    ("l_h", "angle", "height"),
    [(0.2, 36.7292, 0.1017), (0.1660, 41.8284, 0.1134), (0.2544, 23.6701, 0.0683)],
)
def test_foot_triangle_gives_angle_and_height_of_the_ankle(
    l_h: float, angle: float, height: float
) -> None:
    leg = Body(heel_to_metatarsal_m=l_h).leg(0)
    assert math.degrees(leg.foot_angle) == pytest.approx(angle, abs=0.02)
    assert leg.ankle_height == pytest.approx(height, abs=1e-4)


@LAW
@given(st.floats(0.01, 1), st.floats(0.01, 1), st.floats(1e-3, 1 - 1e-3))
def test_every_triangle_that_closes_has_its_angle(
    heel_to_ankle: float, ankle_to_metatarsal: float, where: float
) -> None:
    low, high = abs(heel_to_ankle - ankle_to_metatarsal), heel_to_ankle + ankle_to_metatarsal
    l_h = low + where * (high - low)
    leg = Body(
        heel_to_ankle_m=heel_to_ankle,
        ankle_to_metatarsal_m=ankle_to_metatarsal,
        heel_to_metatarsal_m=l_h,
    ).leg(0)
    phi = leg.foot_angle
    third = math.hypot(l_h * math.cos(phi) - ankle_to_metatarsal, l_h * math.sin(phi))
    assert third == pytest.approx(heel_to_ankle, abs=1e-9)
    assert 0 < leg.ankle_height <= heel_to_ankle + 1e-12


@pytest.mark.parametrize(
    "sides", [(0.078, 0.064, 0.014), (0.166, 0.119, 0.047), (0.1, 0.2, 0.3), (0.12, 0.17, 0.05)]
)
def test_foot_that_is_flat_up_to_rounding_is_refused(sides: tuple[float, float, float]) -> None:
    """0.078 - 0.064 is a hair over 0.014: such a triangle has no angle to compute with."""
    names = ("heel_to_ankle_m", "ankle_to_metatarsal_m", "heel_to_metatarsal_m")
    with pytest.raises(BodyError, match="the foot triangle cannot close"):
        Body(**dict(zip(names, sides, strict=True)))


def test_pair_is_leg_1_and_leg_2() -> None:
    body = Body(**PAIR)
    assert (body.leg(0).thigh_mass, body.leg(1).thigh_mass) == (8.0, 9.0)
    assert (body.leg(0).heel_to_metatarsal, body.leg(1).heel_to_metatarsal) == (0.2, 0.25)
    assert body.leg(0).shank_mass == body.leg(1).shank_mass == 3.51
    assert body.total_mass == pytest.approx(46.7 + 17.0 + 2 * (3.51 + 1.24))
    assert not body.legs_equal
    assert Body(thigh_mass_kg=(8.49, 8.49)).legs_equal


@pytest.mark.parametrize("field", LEG_FIELDS)
def test_every_leg_parameter_may_be_a_pair(field: str) -> None:
    value = getattr(Body(), field)
    pair: dict[str, Any] = {field: (value, 1.02 * value)}
    body = Body(**pair)
    name = field.rsplit("_", 1)[0]
    assert getattr(body.leg(0), name) == value
    assert getattr(body.leg(1), name) == 1.02 * value


def test_every_field_has_a_symbol_and_comes_back_from_it() -> None:
    assert sorted(SYMBOLS.values()) == sorted(Body.model_fields)
    for body in (Body(), Body(**PAIR), Body(trunk_mass_kg=45.0)):
        assert Body.from_symbols(body.by_symbol()) == body
        stored = json.loads(json.dumps(body.by_symbol()))  # a pair is a list there
        assert Body.from_symbols(stored) == body


def test_symbols_must_be_all_there_and_known() -> None:
    symbols = Body().by_symbol()
    with pytest.raises(BodyError, match="m_q: unknown symbol; give exactly m, r, J, m_a"):
        Body.from_symbols({**symbols, "m_q": 1.0})
    for other in (3.0, ["m"], None):
        with pytest.raises(BodyError, match="should map symbols to values; give m, r, J"):
            Body.from_symbols(other)  # type: ignore[arg-type]
    del symbols["l_h"]
    with pytest.raises(BodyError, match="l_h: required but missing; give exactly m, r"):
        Body.from_symbols(symbols)


@pytest.mark.parametrize("field", Body.model_fields)
@pytest.mark.parametrize(
    ("value", "rule"),
    [
        (0.0, r"= 0\.0: should be greater than 0; give "),
        (-1, r"= -1: should be greater than 0; give "),
        (math.nan, r"= nan: should be a finite number; give "),
        (math.inf, r"= inf: should be a finite number; give "),
        (True, r"= True: should be a valid number; give "),
        ("70", r"= '70': should be a valid number; give "),
        (None, r": should be a valid number; give "),
        (1e7, r"= 10000000\.0: must lie between 1e-06 and 1e\+06; give it in SI units"),
        (1e-7, r"= 1e-07: must lie between 1e-06 and 1e\+06; give it in SI units"),
    ],
)
def test_value_that_no_body_has_is_refused(field: str, value: Any, rule: str) -> None:
    with pytest.raises(BodyError, match=f"^{field}\\b.*{rule}"):
        Body(**{field: value})


@pytest.mark.parametrize("field", LEG_FIELDS)
@pytest.mark.parametrize(
    ("pair", "rule"),
    [
        ((1.0, -1.0), r"= -1\.0: should be greater than 0; give "),
        ((0.0, 1.0), r"= 0\.0: should be greater than 0; give "),
        ((1.0, "x"), r"= 'x': should be a valid number; give "),
        ((1.0,), r"= \(1\.0,\): should be one number or a pair of numbers; give "),
        ((1.0, 2.0, 3.0), r"= \(1\.0, 2\.0, 3\.0\): should be one number or a pair of numbers"),
        ([], r"= \[\]: should be one number or a pair of numbers; give "),
        ((0.1, 1e7), r"= 10000000\.0: must lie between 1e-06 and 1e\+06"),
    ],
)
def test_pair_that_no_legs_have_is_refused(field: str, pair: Any, rule: str) -> None:
    with pytest.raises(BodyError, match=f"^{field} {rule}"):
        Body(**{field: pair})


def test_range_of_parameters_keeps_products_finite() -> None:
    assert 0 < SMALLEST**6 < LARGEST**6 < math.inf


def test_pair_for_the_trunk_is_refused() -> None:
    with pytest.raises(
        BodyError, match=r"trunk_mass_kg = \(46\.0, 47\.0\): should be a valid number"
    ):
        written(trunk_mass_kg=(46.0, 47.0))


@pytest.mark.parametrize("l_h", [0.05, 0.04, 0.2901, 0.4, (0.2, 0.4), (0.04, 0.2)])
def test_foot_triangle_that_cannot_close_is_refused(l_h: Any) -> None:
    message = (
        r"^heel_to_metatarsal_m = 0\.\d+: the foot triangle cannot close: .* must be shorter "
        r"than the other two together; give l_h between 0\.05 and 0\.29 m"
    )
    with pytest.raises(BodyError, match=message):
        Body(heel_to_metatarsal_m=l_h)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("trunk_inertia_kgm2", 3.0),
        ("thigh_inertia_kgm2", 0.1),
        ("shank_inertia_kgm2", 0.01),
        ("thigh_inertia_kgm2", (0.57, 0.1)),
        ("shank_inertia_kgm2", (0.01, 0.16)),
    ],
)
def test_inertia_that_makes_the_mass_matrix_indefinite_is_refused_by_name(
    field: str, value: Any
) -> None:
    message = f"^{field} = .*: the mass matrix is not positive definite with these inertias; give"
    with pytest.raises(BodyError, match=message):
        Body(**{field: value})


def test_papers_inertias_under_m_r_squared_are_not_refused() -> None:
    """J - m r^2 = -0.007 and -0.0007 kg m2 for trunk and shank: rounding, not a mistake."""
    body = Body()
    assert body.trunk_inertia_kgm2 < body.trunk_mass_kg * body.trunk_com_m**2
    leg = body.leg(0)
    assert leg.shank_inertia < leg.shank_mass * leg.shank_com**2


def test_unknown_key_is_named_with_the_nearest_one() -> None:
    with pytest.raises(BodyError, match="^thigh_mas_kg: unknown key; did you mean 'thigh_mass_kg'"):
        written(thigh_mas_kg=8.0)
    with pytest.raises(BodyError, match="^colour: unknown key; known keys: trunk_mass_kg, trunk"):
        written(colour=1.0)
