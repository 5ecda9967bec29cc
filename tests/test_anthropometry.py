"""Bodies from height and mass: the tables as they are, and bodies that can exist."""

from __future__ import annotations

import csv
import hashlib
import inspect
import math
from importlib import resources
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.anthropometry import MEASURED, TABLES, Person, length_fractions, segments
from ergowalk.body import Body
from ergowalk.errors import BodyError
from ergowalk.mechanics.dynamics import coefficients, mass_matrix, motion_of

FOLDER = resources.files("ergowalk").joinpath("data/anthropometry")

FILES = ("dempster.csv", "deleva_female.csv", "deleva_male.csv", "lengths.csv")

LAW = settings(deadline=None, max_examples=150, derandomize=True, database=None)

ROUNDED = 2e-5
"""Relative: parameters have six significant digits."""


def rows(file: str) -> dict[str, dict[str, str]]:
    """A table by its first column, read here without the package's own reader."""
    lines = FOLDER.joinpath(file).read_text("utf-8").splitlines()
    return {next(iter(row.values())): row for row in csv.DictReader(lines)}


def test_files_are_those_of_the_checksums() -> None:
    lines = FOLDER.joinpath("SHA256SUMS").read_text("utf-8").splitlines()
    sums = {name: digest for digest, name in (line.split() for line in lines)}
    assert set(sums) == set(FILES)
    for name, digest in sums.items():
        assert hashlib.sha256(FOLDER.joinpath(name).read_bytes()).hexdigest() == digest


def test_the_origin_and_the_licence_are_told() -> None:
    readme = FOLDER.joinpath("README.md").read_text("utf-8")
    assert all(f"`{name}`" in readme for name in FILES)
    assert "CC BY 4.0" in readme
    assert "BMClab/BMC" in readme


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("sex", ["male", "female"])
def test_masses_of_a_table_are_the_whole_body(table: str, sex: str) -> None:
    found = segments(table, sex)
    if table == "dempster":
        whole = found["hat"].mass + 2 * found["total_leg"].mass
    else:
        double = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
        whole = found["head"].mass + found["trunk"].mass + 2 * sum(found[s].mass for s in double)
    assert whole == pytest.approx(1.0, abs=1.5e-4)  # four decimals of each segment


@pytest.mark.parametrize("sex", ["male", "female"])
def test_radius_of_gyration_is_that_of_motion_in_the_sagittal_plane(sex: str) -> None:
    """About the axis from left to right: less than about that from back to front, for a trunk is
    wider than deep; and more than about the long axis."""
    trunk = rows(f"deleva_{sex}.csv")["trunk_3"]
    found = segments("deleva", sex)["trunk_3"].gyration
    assert found < float(trunk["radius_gyration_sagittal_fraction"])
    assert found > float(trunk["radius_gyration_longitudinal_fraction"])


def test_dempsters_radii_about_both_ends_belong_to_one_body() -> None:
    """rho_proximal^2 = com^2 + rho^2, to three decimals: which column is which."""
    found, table = segments("dempster", "male"), rows("dempster.csv")
    for name in ("thigh", "leg", "hat"):
        proximal = float(table[name]["radius_gyration_proximal_fraction"])
        assert math.hypot(found[name].com, found[name].gyration) == pytest.approx(
            proximal, abs=1.5e-3
        )


def test_lengths_of_the_leg_add_up_to_the_height_of_the_hip() -> None:
    parts = ("thigh_hip_to_knee", "shank_knee_to_ankle", "ankle_height")
    fractions = length_fractions()
    assert sum(fractions[p] for p in parts) == pytest.approx(fractions["hip_height"], abs=1e-12)
    assert Person(height_m=1.8, mass_kg=70).leg_length_m == pytest.approx(0.53 * 1.8)


def test_dempsters_body_is_the_table_worked_by_hand() -> None:
    """75 kg, 1.80 m: fractions of Winter's table 4.1, lengths of his figure 4.1."""
    body = Body.from_height_mass(1.80, 75.0)
    leg = body.leg(0)
    expected = {
        body.trunk_mass_kg: 0.678 * 75,
        body.trunk_com_m: 0.626 * 0.288 * 1.80,
        body.trunk_inertia_kgm2: 0.678 * 75 * (0.626**2 + 0.496**2) * (0.288 * 1.80) ** 2,
        leg.thigh_mass: 0.1 * 75,
        leg.thigh_length: 0.245 * 1.80,
        leg.thigh_com: 0.433 * 0.245 * 1.80,
        leg.thigh_inertia: 0.1 * 75 * (0.433**2 + 0.323**2) * (0.245 * 1.80) ** 2,
        leg.shank_mass: 0.0465 * 75,
        leg.shank_length: 0.246 * 1.80,
        leg.shank_com: 0.433 * 0.246 * 1.80,
        leg.shank_inertia: 0.0465 * 75 * (0.433**2 + 0.302**2) * (0.246 * 1.80) ** 2,
        leg.foot_mass: 0.0145 * 75,
        leg.ankle_height: 0.039 * 1.80,
        leg.heel_to_metatarsal + leg.toe_length: 0.152 * 1.80,
    }
    for found, value in expected.items():
        assert found == pytest.approx(value, rel=ROUNDED)


@pytest.mark.parametrize("sex", ["male", "female"])
def test_de_levas_legs_are_the_rows_of_the_sex(sex: str) -> None:
    leg, table = Body.from_height_mass(1.7, 60.0, sex).leg(0), rows(f"deleva_{sex}.csv")
    for name, length in (("thigh", leg.thigh_length), ("shank", leg.shank_length)):
        row = table[name]
        mass, com = getattr(leg, f"{name}_mass"), getattr(leg, f"{name}_com")
        # de Leva's female masses add up to 0.9999
        assert mass / 60 == pytest.approx(float(row["mass_fraction"]), rel=2e-4)
        assert com / length == pytest.approx(float(row["com_from_origin_fraction"]), rel=ROUNDED)
        central = getattr(leg, f"{name}_inertia") - mass * com**2
        radius = math.sqrt(central / mass) / length
        tabulated = float(row["radius_gyration_transverse_fraction"])
        assert radius == pytest.approx(tabulated, rel=1e-3)  # of a difference


def test_trunks_of_both_tables_agree_with_each_other() -> None:
    """Two sources, one of cadavers and one of the living: centre of mass within 2 % and radius of
    gyration about the hip within 4 % for men, though the shoulder, neck and arms are found quite
    differently."""
    dempster, deleva = (Body.from_height_mass(1.75, 73.0, "male", table) for table in TABLES)
    assert deleva.trunk_com_m == pytest.approx(dempster.trunk_com_m, rel=0.02)
    radii = [math.sqrt(b.trunk_inertia_kgm2 / b.trunk_mass_kg) for b in (dempster, deleva)]
    assert radii[1] == pytest.approx(radii[0], rel=0.04)


def test_the_papers_masses_lie_between_the_tables() -> None:
    """M = 73.18 kg of Berbyuk et al. (2002): trunk and thigh lie between Dempster's and de Leva's,
    shank and foot are 6 % heavier than Dempster's."""
    paper, (dempster, deleva) = (
        Body(),
        [Body.from_height_mass(1.75, 73.18, "male", table) for table in TABLES],
    )
    assert [dempster.total_mass, deleva.total_mass] == pytest.approx([73.18, 73.18], abs=1e-9)
    assert deleva.trunk_mass_kg < paper.trunk_mass_kg < dempster.trunk_mass_kg
    thighs = [body.leg(0).thigh_mass for body in (dempster, paper, deleva)]
    assert thighs == sorted(thighs)
    lower = [body.leg(0).shank_mass + body.leg(0).foot_mass for body in (paper, dempster)]
    assert lower[0] / lower[1] == pytest.approx(1.06, abs=0.01)


heights = st.floats(1.0, 2.5)
masses = st.floats(20.0, 300.0)
sexes = st.sampled_from([None, "male", "female"])
tables = st.sampled_from([None, *TABLES])
factors = st.fixed_dictionaries(
    {},
    optional={
        field: st.floats(0.78, 1.28)
        for field in MEASURED.values()
        if field not in ("heel_to_ball_m", "ankle_ahead_of_heel_m")
    },
)
poses = st.lists(st.floats(-math.pi, math.pi), min_size=5, max_size=5)


@st.composite
def bodies(draw: st.DrawFn) -> tuple[Person, Body]:
    """A person with some lengths measured, and the body that follows."""
    height, mass = draw(heights), draw(masses)
    usual = Person(height_m=height, mass_kg=mass)
    lengths = {f: usual.length(n) for n, f in MEASURED.items()}
    measured = {field: factor * lengths[field] for field, factor in draw(factors).items()}
    given: dict[str, Any] = {"sex": draw(sexes), "table": draw(tables), **measured}
    person = Person(height_m=height, mass_kg=mass, **given)
    return person, Body.from_height_mass(height, mass, **given)


@LAW
@given(made=bodies())
def test_every_scaled_body_is_physically_sound(made: tuple[Person, Body]) -> None:
    person, body = made
    assert body.total_mass == pytest.approx(person.mass_kg, abs=1e-9)  # kg, rounding of decimals
    assert all(value > 0 for value in person.parameters().values())
    leg = body.leg(0)
    rods = [
        (body.trunk_mass_kg, body.trunk_com_m, body.trunk_inertia_kgm2, 0.47 * person.height_m),
        (leg.thigh_mass, leg.thigh_com, leg.thigh_inertia, leg.thigh_length),
        (leg.shank_mass, leg.shank_com, leg.shank_inertia, leg.shank_length),
    ]
    for mass, com, inertia, length in rods:
        central = inertia - mass * com**2
        assert 0 < com < length
        # between a point and two points at the ends of the segment
        assert 0.15 * length < math.sqrt(central / mass) < 0.5 * length
    hip = leg.thigh_length + leg.shank_length + leg.ankle_height
    assert hip == pytest.approx(person.leg_length_m, rel=ROUNDED)
    assert 0.4 * person.height_m < hip < 0.7 * person.height_m
    assert leg.heel_to_metatarsal + leg.toe_length == pytest.approx(
        person.length("foot_length"), rel=ROUNDED
    )
    assert leg.ankle_height == pytest.approx(person.length("ankle_height"), rel=1e-4)


@LAW
@given(made=bodies(), pose=poses)
def test_mass_matrix_of_a_scaled_body_is_positive_definite(
    made: tuple[Person, Body], pose: list[float]
) -> None:
    _, body = made
    matrix = np.array(mass_matrix(coefficients(body), motion_of([0.0, 0.0, *pose])), dtype=float)
    eigenvalues = np.linalg.eigvalsh(matrix)
    assert eigenvalues[0] > 1e-4 * body.total_mass  # kg m2 for 1 m tall: 0.002 of 20 kg


@given(height=heights, mass=masses, sex=sexes, table=tables, factor=st.floats(1.01, 1.5))
def test_masses_go_with_mass_and_lengths_with_height(
    height: float, mass: float, sex: str | None, table: str | None, factor: float
) -> None:
    height, mass = min(height, 2.5 / factor), min(mass, 300 / factor)
    given_: dict[str, Any] = {"sex": sex, "table": table}
    small = Body.from_height_mass(height, mass, **given_)
    heavy = Body.from_height_mass(height, factor * mass, **given_)
    tall = Body.from_height_mass(factor * height, mass, **given_)
    for field in Body.model_fields:
        kind = field.rsplit("_", 1)[1]
        powers = {"kg": (1, 0), "m": (0, 1), "kgm2": (1, 2), "s2": (0, 0)}[kind]
        for body, power in zip((heavy, tall), powers, strict=True):
            assert getattr(body, field) == pytest.approx(
                factor**power * getattr(small, field), rel=2 * ROUNDED
            )


@pytest.mark.parametrize("name", MEASURED)
def test_a_measured_length_takes_the_place_of_the_fraction(name: str) -> None:
    usual = Person(height_m=1.75, mass_kg=72)
    field, value = MEASURED[name], 1.1 * usual.length(name)
    given_: dict[str, Any] = {field: value}
    person = Person(height_m=1.75, mass_kg=72, **given_)
    assert person.length(name) == value
    changed = {k for k, v in person.parameters().items() if v != usual.parameters()[k]}
    foot = {"heel_to_ankle_m", "ankle_to_metatarsal_m", "heel_to_metatarsal_m", "toe_length_m"}
    expected = {
        "thigh_length_m": {"thigh_length_m", "thigh_com_m", "thigh_inertia_kgm2"},
        "shank_length_m": {"shank_length_m", "shank_com_m", "shank_inertia_kgm2"},
        "hip_to_shoulder_m": {"trunk_com_m", "trunk_inertia_kgm2"},
        "ankle_height_m": {"heel_to_ankle_m", "ankle_to_metatarsal_m"},
        "foot_length_m": foot,
        "heel_to_ball_m": foot - {"heel_to_ankle_m"},
        "ankle_ahead_of_heel_m": {"heel_to_ankle_m", "ankle_to_metatarsal_m"},
    }
    assert changed == expected[field]


def test_fractions_in_the_descriptions_are_those_of_the_tables() -> None:
    usual = Person(height_m=1.0, mass_kg=50)
    for name, field in MEASURED.items():
        description = Person.model_fields[field].description or ""
        of_foot = name in ("heel_to_ball", "ankle_ahead_of_heel")
        fraction = usual.length(name) / (usual.length("foot_length") if of_foot else 1)
        assert f"{fraction:.3f}".rstrip("0") in description.replace("0.70", "0.7")


def test_the_table_follows_the_sex_unless_it_is_said() -> None:
    plain, male = Body.from_height_mass(1.7, 60), Body.from_height_mass(1.7, 60, "male")
    assert plain == Body.from_height_mass(1.7, 60, table="dempster")
    assert plain == Body.from_height_mass(1.7, 60, "female", "dempster")
    assert male == Body.from_height_mass(1.7, 60, table="deleva") != plain
    assert male == Body.from_height_mass(1.7, 60, "male", "deleva")
    assert male != Body.from_height_mass(1.7, 60, "female")


def test_the_docstring_names_every_measured_length() -> None:
    told = inspect.getdoc(Body.from_height_mass) or ""
    assert all(field in told for field in MEASURED.values())


BAD: list[tuple[dict[str, Any], str]] = [
    ({"height_m": 175}, r"height_m = 175\.0: must lie between 1 and 2\.5; give it in m"),
    ({"height_m": -1}, "height_m = -1: should be greater than 0; give body height in m"),
    ({"height_m": "tall"}, "height_m = 'tall': should be a valid number"),
    ({"height_m": math.nan}, "height_m = nan: should be a finite number"),
    ({"mass_kg": 72000}, r"mass_kg = 72000\.0: must lie between 20 and 300; give it in kg"),
    ({"sex": "f"}, "sex = 'f': should be 'male' or 'female'"),
    ({"table": "winter"}, "table = 'winter': should be 'dempster' or 'deleva'"),
    ({"thigh_lenght_m": 0.4}, "thigh_lenght_m: unknown key; did you mean 'thigh_length_m'"),
    (
        {"thigh_length_m": 43.0},
        r"thigh_length_m = 43\.0: is far from the 0\.429 m that a person of 1\.75 m has; "
        r"give m, between 0\.268 and 0\.686",
    ),
    ({"hip_to_shoulder_m": 0.7}, r"hip_to_shoulder_m = 0\.7: is far from the 0\.504 m"),
    ({"ankle_height_m": 0.0}, r"ankle_height_m = 0\.0: should be greater than 0"),
    (
        {"foot_length_m": 0.18, "heel_to_ball_m": 0.2},
        r"heel_to_ball_m = 0\.2: must lie between the ankle at 0\.045 m and the toe tip at 0\.180",
    ),
]


@pytest.mark.parametrize(("changes", "match"), BAD, ids=[match[:25] for _, match in BAD])
def test_what_no_adult_has_is_refused_in_one_line(changes: dict[str, Any], match: str) -> None:
    with pytest.raises(BodyError, match=f"^{match}") as caught:
        Body.from_height_mass(**{"height_m": 1.75, "mass_kg": 72, **changes})
    assert "\n" not in str(caught.value)


def test_words_say_the_person() -> None:
    person = Person(height_m=1.55, mass_kg=50, sex="female", foot_length_m=0.23)
    assert person.words == ("1.55 m, 50 kg, de Leva's female table; measured: foot_length_m 0.23")
    assert Person(height_m=1.8, mass_kg=75).words == "1.8 m, 75 kg, Dempster's table"
