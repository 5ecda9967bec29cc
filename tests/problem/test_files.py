"""Problem files: round trip, and one line for everything that can be wrong with a file."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.body import SYMBOLS, Body
from ergowalk.errors import BodyError, CorridorError, InputError, ProblemError
from ergowalk.problem import (
    PRESETS,
    Corridors,
    DoubleSupport,
    GaitProblem,
    JointBounds,
    Limits,
    Objective,
    RhythmBounds,
    preset,
)
from ergowalk.problem.files import (
    WIDTH,
    json_schema,
    problem_from_toml,
    problem_to_toml,
    read_problem,
)
from ergowalk.problem.legs import LEG_TABLES
from ergowalk.values import Value

MINIMAL = "step_length_m = 0.7\nstride_time_s = 1.1\n"

positive = st.floats(min_value=0, exclude_min=True, allow_infinity=False)
bound = st.just("off") | positive
joint_bounds = st.builds(JointBounds, hip=bound, knee=bound, ankle=bound, metatarsal=bound)


def per_leg(value: float, factor: float) -> st.SearchStrategy[Any]:
    numbers = st.floats(value, factor * value)
    return numbers | numbers.map(lambda x: (x, x))


def bodies() -> st.SearchStrategy[Body]:
    """Bodies around the default one: heavier inertias keep the mass matrix positive definite."""
    fields = {}
    for name in SYMBOLS.values():
        value = getattr(Body(), name)
        if "inertia" in name:
            fields[name] = st.floats(1.2 * value, 3 * value)
        elif name.startswith(("trunk_mass", "gravity")):
            fields[name] = st.floats(0.9 * value, 1.1 * value)
        elif name in ("toe_length_m", "heel_to_metatarsal_m"):
            fields[name] = per_leg(value, 1.2)
    return st.builds(Body, **fields)


def instants(low: float, high: float) -> st.SearchStrategy[Any]:
    fractions = st.floats(low, high)
    return fractions | st.tuples(fractions, fractions).map(lambda pair: tuple(sorted(pair)))


problems = st.builds(
    GaitProblem,
    name=st.text(st.characters(exclude_categories=["Cs"])),
    step_length_m=st.floats(0, 2.5, exclude_min=True),
    stride_time_s=positive,
    double_support=st.sampled_from(DoubleSupport),
    body=bodies(),
    corridors=st.builds(
        Corridors,
        source=st.text(st.characters(exclude_categories=["Cs"])),
        width_sd=positive,
    ),
    rhythm=st.builds(
        RhythmBounds,
        heel_end=instants(0.01, 0.2),
        heel_off=instants(0.21, 0.49),
        toe_off=instants(0.51, 0.7),
    ),
    limits=st.builds(
        Limits,
        vertical_reaction_body_weights=bound,
        friction_coefficient=bound,
        moment_rate_nm_per_kg_s=joint_bounds,
        moment_nm_per_kg=joint_bounds,
    ),
    objective=st.builds(
        Objective,
        positive_work=st.floats(0, 1e6),
        muscle_work=st.floats(0, 1e6),
        regenerated_share=st.floats(0, 1, exclude_max=True),
        moment_rate_squared_s3_per_m2=st.floats(0, 1e6),
    ),
)


@settings(deadline=None)
@given(problem=problems, commented=st.booleans())
def test_reading_what_was_written_gives_the_same_problem_and_the_same_text(problem, commented):
    text = problem_to_toml(problem, commented=commented)
    again = problem_from_toml(text)
    assert again == problem
    assert problem_to_toml(again, commented=commented) == text


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("commented", [False, True])
def test_every_preset_survives_a_file(name, commented, tmp_path):
    path = tmp_path / "problem.toml"
    path.write_text(problem_to_toml(preset(name), commented=commented), "utf-8")
    assert read_problem(path).replace(folder=None) == preset(name)


def test_the_file_has_the_agreed_keys_and_tables_in_order():
    text = problem_to_toml(preset("berbyuk2002"))
    assert re.findall(r"^(?:\w+(?= =)|\[.*\])", text.split("[body]")[0] + "[body]", re.M) == [
        "name",
        "step_length_m",
        "stride_time_s",
        "double_support",
        "[body]",
    ]
    assert re.findall(r"^\[(.*)\]$", text, re.M) == [
        "body",
        "corridors",
        "rhythm",
        "limits",
        "limits.moment_rate_nm_per_kg_s",
        "limits.moment_nm_per_kg",
        "objective",
        "stride",
    ]
    assert tomllib.loads(text)["step_length_m"] == 0.76
    assert tomllib.loads(text)["stride_time_s"] == 1.14


def test_every_default_is_filled_in():
    data = tomllib.loads(problem_to_toml(problem_from_toml(MINIMAL)))
    assert set(data["body"]) == set(SYMBOLS.values())
    # of legs that do not differ nothing is said
    assert set(data["limits"]) | set(LEG_TABLES) == set(Limits.model_fields)
    assert set(data["rhythm"]) | set(LEG_TABLES) == set(RhythmBounds.model_fields)
    assert data["limits"]["moment_nm_per_kg"] == dict.fromkeys(JointBounds.model_fields, "off")


def described(value: Value) -> list[str]:
    """Descriptions of all written fields, tables included."""
    found = []
    for name, field in type(value).model_fields.items():
        inner = getattr(value, name)
        if not field.exclude and inner is not None:
            found.append(field.description or "")
            found += described(inner) if isinstance(inner, Value) else []
    return found


def test_a_commented_file_explains_every_key_once():
    problem = preset("berbyuk2002")
    text = problem_to_toml(problem, commented=True)
    comments = " ".join(line.split("# ", 1)[1] for line in text.splitlines() if "# " in line)
    for description in set(described(problem)):
        assert comments.count(description) == described(problem).count(description)
    assert max(map(len, text.splitlines())) <= WIDTH
    assert "step_length_m and stride_time_s are required" in comments


def test_a_corridor_table_is_looked_for_beside_the_problem_file(tmp_path):
    table = Path(__file__).parents[2] / "src/ergowalk/data/winter1991/slow.csv"
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables/mine.csv").write_bytes(table.read_bytes())
    path = tmp_path / "problem.toml"
    path.write_text(MINIMAL + '[corridors]\nsource = "tables/mine.csv"\n')
    assert read_problem(path).human().curves == preset("winter-slow").human().curves


def test_a_byte_order_mark_is_no_obstacle(tmp_path):
    path = tmp_path / "problem.toml"
    path.write_bytes(b"\xef\xbb\xbf" + MINIMAL.encode())
    assert read_problem(path).step_length_m == 0.7


BAD = [
    ("step_lenght_m = 0.7\n" + MINIMAL, r"step_lenght_m: unknown key; .*'step_length_m'"),
    ("folder = '.'\n" + MINIMAL, "folder: unknown key; remove it"),
    (MINIMAL + "[body]\nthigh_mas_kg = 8\n", r"body\.thigh_mas_kg: unknown key; .*thigh_mass_kg"),
    ("self = 1\n" + MINIMAL, "self: unknown key; known keys: name, step_length_m"),
    (MINIMAL + "[body]\nfloat = 8\n", r"body\.float: unknown key; known keys: trunk_mass_kg"),
    (MINIMAL + "[body]\n'a[0]' = 8\n", r"body\.a\[0\]: unknown key; known keys: trunk_mass"),
    ("stride_time_s = 1.1", "step_length_m: required but missing; add it"),
    ("step_length_m = '0.7'\nstride_time_s = 1.1", r"step_length_m = '0\.7': .*valid number"),
    ("step_length_m = 0.7\nstride_time_s = true", r"stride_time_s = True: .*valid number"),
    ("step_length_m = 0.7\nstride_time_s = 2001-01-01", "stride_time_s = .*valid number"),
    ("step_length_m = 0.7\nstride_time_s = 0", r"stride_time_s = 0: .*greater than 0; give"),
    ("step_length_m = 0.7\nstride_time_s = -1.1", r"stride_time_s = -1\.1: .*greater than 0"),
    ("step_length_m = nan\nstride_time_s = 1.1", "step_length_m = nan: .*finite"),
    ("step_length_m = 0.7\nstride_time_s = inf", "stride_time_s = inf: .*finite"),
    ("step_length_m = 2.7\nstride_time_s = 1.1", r"step_length_m = 2\.7: out of reach"),
    (MINIMAL + "body = 3", "body = 3: .*; "),
    (MINIMAL + "persn = 1", "persn: unknown key; did you mean 'person'"),
    (MINIMAL + "person = 1", "person = 1: should be a table of keys and values; give a person's"),
    (MINIMAL + "[person]\nmass_kg = 70", r"person\.height_m: required but missing; add it"),
    (MINIMAL + "[person]\nheigth_m = 1.7", r"person\.heigth_m: unknown key; .*'height_m'"),
    (
        MINIMAL + "[person]\nheight_m = 170\nmass_kg = 70",
        r"person\.height_m = 170\.0: must lie between 1 and 2\.5; give it in m",
    ),
    (
        MINIMAL + "[person]\nheight_m = 1.7\nmass_kg = 70\n[body]\nthigh_mas_kg = 8",
        r"body\.thigh_mas_kg: unknown key; .*thigh_mass_kg",
    ),
    ("step_lenght_m = 0.7\nstride_time_s = 1.1", "step_lenght_m: unknown key; .*step_length_m"),
    (MINIMAL + "[body]\nthigh_mass_kg = -8", r"body\.thigh_mass_kg = -8: .*greater than 0"),
    (MINIMAL + "[body]\nthigh_mass_kg = [8, 9]\n[stride]\nlegs = 'mirrored'", "the legs differ"),
    (MINIMAL + "[stride]\nstep_time_asymmetry = 0.7", r"stride\.step_time.* between -0\.5 and 0"),
    (MINIMAL + "[stride]\nstep_length_asymmetry = [0.1, -0.1]", "lower bound first"),
    (MINIMAL + "[rhythm.leg_2]\nheel_off = 0.6", r"rhythm.*heel_off = 0\.6: must lie between"),
    (MINIMAL + "[limits.leg_2]\nstrength = 1", r"limits\.leg_2\.strength: unknown key"),
    (MINIMAL + "[devices.leg_3.knee]\nkind = 'free'", r"devices\.leg_3: unknown key"),
    (MINIMAL + "[body]\nheel_to_ankle_m = 0.5", "foot triangle cannot close.*give l_h between"),
    (MINIMAL + "[body]\ntrunk_inertia_kgm2 = 0.1", "mass matrix is not positive definite"),
    (MINIMAL + "[corridors]\nwidth_sd = 0", r"corridors\.width_sd = 0: .*greater than 0"),
    (MINIMAL + "[rhythm]\nheel_end = 0.3\nheel_off = 0.2", r"rhythm\.heel_end = 0\.3: .*before"),
    (MINIMAL + "[rhythm]\nheel_end = [0.2, 0.1]", r"rhythm\.heel_end = .*lower bound first"),
    (MINIMAL + "[rhythm]\ntoe_off = 0.4", r"rhythm\.toe_off = 0\.4: must lie between 0\.5"),
    (MINIMAL + "[rhythm]\norder = 'x'", r"rhythm\.order = 'x': .*'best' to try both"),
    (MINIMAL + "[limits]\nfriction_coefficient = 'of'", "friction_coefficient = 'of': .*'off'"),
    (MINIMAL + "[limits.moment_nm_per_kg]\nhip = nan", r"moment_nm_per_kg\.hip = nan"),
    ("double_support = 'x'\n" + MINIMAL, "double_support = 'x': .*'optimal'.*'linear'"),
    ("step_length_m 0.7", r"not valid TOML: Expected '=' .*line 1, column 15"),
    (MINIMAL + MINIMAL, "not valid TOML: Cannot overwrite a value"),
    ("step_length_m = " + 5000 * "1", "not valid TOML: Exceeds the limit"),
    ("step_length_m = 1" + 400 * "0" + "\nstride_time_s = 1.1", "step_length_m = 1000*"),
    ("a = " + 9999 * "[", "not valid TOML: nested too deeply"),
]


@pytest.mark.parametrize(("text", "match"), BAD, ids=[match[:30] for _, match in BAD])
def test_each_mistake_gets_one_line_that_names_the_file(text, match, tmp_path):
    path = tmp_path / "problem.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=match) as caught:
        read_problem(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message


def test_mistakes_have_the_kind_of_what_is_wrong():
    with pytest.raises(BodyError, match="greater than 0"):
        problem_from_toml(MINIMAL + "[body]\nthigh_mass_kg = -8")
    with pytest.raises(CorridorError, match="greater than 0"):
        problem_from_toml(MINIMAL + "[corridors]\nwidth_sd = -1")
    with pytest.raises(ProblemError, match="not valid TOML"):
        problem_from_toml("=")


def test_unreadable_files_say_why(tmp_path):
    with pytest.raises(ProblemError, match=r"none\.toml: cannot be read \(No such file"):
        read_problem(tmp_path / "none.toml")
    with pytest.raises(ProblemError, match=r"cannot be read \(Is a directory\); give a problem"):
        read_problem(tmp_path)
    with pytest.raises(ProblemError, match=r"cannot be read \(.*null"):
        read_problem("a\0b")
    latin = tmp_path / "latin.toml"
    latin.write_bytes("name = 'é'".encode("latin-1"))
    with pytest.raises(ProblemError, match=r"latin\.toml: not UTF-8 text \(byte 8\); save"):
        read_problem(latin)


@pytest.mark.parametrize(
    ("table", "match"),
    [
        (None, r"problem\.toml: corridors\.source = 'mine\.csv': cannot be read \(No such file"),
        ("percent_stride\n0\n", r"mine\.csv: hip_flexion_angle_mean_deg: column is missing"),
    ],
)
def test_a_table_that_cannot_be_used_is_found_with_the_problem(table, match, tmp_path):
    path = tmp_path / "problem.toml"
    path.write_text(MINIMAL + '[corridors]\nsource = "mine.csv"\n')
    if table is not None:
        (tmp_path / "mine.csv").write_text(table)
    with pytest.raises(CorridorError, match=match):
        read_problem(path)


def test_the_schema_knows_every_key_and_is_json():
    schema = json_schema()
    assert json.loads(json.dumps(schema)) == schema
    written = tomllib.loads(problem_to_toml(preset("berbyuk2002")))
    # a person becomes the body; a file without devices or a design says nothing of them
    assert set(schema["properties"]) == {*written, "person", "devices", "design"}
    assert schema["required"] == ["step_length_m", "stride_time_s"]
    for table, keys in written.items():
        if isinstance(keys, dict):
            definition = schema["properties"][table]["$ref"].rsplit("/", 1)[1]
            properties = set(schema["$defs"][definition]["properties"])
            assert properties - set(LEG_TABLES) == set(keys)


def test_the_schema_takes_every_written_file_and_no_unknown_key():
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    for name in PRESETS:
        jsonschema.validate(tomllib.loads(problem_to_toml(preset(name))), schema)
    person = MINIMAL + "[person]\nheight_m = 1.7\nmass_kg = 70\n"
    jsonschema.validate(tomllib.loads(person), schema)
    for text, match in (
        ("step_lenght_m = 0.7\n" + MINIMAL, "'step_lenght_m' was unexpected"),
        (person + "heigth_m = 2\n", "'heigth_m' was unexpected"),
        (MINIMAL + "[body]\nthigh_mass_kg = -8", "-8 is (less than|not valid)"),
        (MINIMAL + "folder = '.'", "'folder' was unexpected"),
        ("stride_time_s = 1.1", "'step_length_m' is a required property"),
        (MINIMAL + "[limits]\nfriction_coefficient = 'of'", "'off' was expected|'of' is not valid"),
    ):
        with pytest.raises(jsonschema.ValidationError, match=match):
            jsonschema.validate(tomllib.loads(text), schema)


def test_the_schema_describes_every_key_for_the_editor():
    schema = json_schema()
    for part in (schema, *schema["$defs"].values()):
        for name, field in part.get("properties", {}).items():
            assert field.get("description"), name
            assert "null" not in json.dumps(field)
        assert "\n" not in part.get("description", "")


@given(value=st.floats(min_value=0, exclude_min=True, allow_infinity=False))
def test_floats_keep_every_bit(value):
    problem = GaitProblem(step_length_m=0.7, stride_time_s=value)
    stride_time = problem_from_toml(problem_to_toml(problem)).stride_time_s
    assert stride_time.hex() == value.hex()
