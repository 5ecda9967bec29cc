"""Sweep files: what they say, and what is refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ergowalk.errors import InputError, ProblemError, SweepError
from ergowalk.problem import preset
from ergowalk.study import Sweep, read_sweep
from ergowalk.study.cases import cases_of, changed

GRID = "[grid]\nstep_length_m = {low = 0.7, high = 0.8, count = 3}\nstride_time_s = [1.1, 1.2]\n"


def sweep_of(tmp_path: Path, text: str) -> Sweep:
    path = tmp_path / "sweep.toml"
    path.write_text(text)
    return read_sweep(path)


def test_a_grid_has_all_combinations_the_last_field_fastest(tmp_path: Path) -> None:
    cases = cases_of(sweep_of(tmp_path, GRID))
    points = [tuple(case.values.values()) for case in cases]
    assert points == [(x, t) for x in (0.7, 0.75, 0.8) for t in (1.1, 1.2)]
    assert [c.problem.step_length_m for c in cases if c.problem] == [p[0] for p in points]


def test_any_field_of_a_problem_can_be_swept(tmp_path: Path) -> None:
    fields = (
        'corridors.source = ["winter-slow", "winter-fast"]\n'
        'limits.moment_nm_per_kg.hip = ["off", 1.5]\n'
        "rhythm.heel_end = [0.08, [0.02, 0.2]]\n"
        '"body.toe_length_m" = [0.1]\n'
        'double_support = ["optimal", "linear"]\n'
    )
    cases = cases_of(sweep_of(tmp_path, f"[grid]\n{fields}"))
    assert len(cases) == 16
    problem = cases[-1].problem
    assert problem is not None
    assert problem.corridors.source == "winter-fast"
    assert problem.limits.moment_nm_per_kg.hip == 1.5
    assert problem.rhythm.bounds("heel_end") == (0.02, 0.2)
    assert problem.double_support == "linear"


def test_a_list_fills_in_from_the_base_problem(tmp_path: Path) -> None:
    text = "[[cases]]\nstep_length_m = 0.7\n[[cases]]\nlimits.friction_coefficient = 0.5\n"
    first, second = cases_of(sweep_of(tmp_path, text))
    assert first.values == {"step_length_m": 0.7, "limits.friction_coefficient": 0.6}
    assert second.values == {"step_length_m": 0.76, "limits.friction_coefficient": 0.5}


def test_random_cases_are_a_seeded_latin_hypercube(tmp_path: Path) -> None:
    text = (
        "[random]\ncount = 8\nseed = {}\n"
        "[random.between]\nstep_length_m = [0.6, 1.4]\nstride_time_s = [1.0, 1.8]\n"
    )
    found = [cases_of(sweep_of(tmp_path, text.format(seed))) for seed in (1, 1, 2)]
    values = [[tuple(case.values.values()) for case in cases] for cases in found]
    assert values[0] == values[1] != values[2]
    strata = np.floor((np.array(values[0]) - [0.6, 1.0]) / 0.1)
    assert all(sorted(column) == list(range(8)) for column in strata.T)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("", r"sweep = 'none': must have one of \[grid\], \[\[cases\]\], \[random\]; give exactly"),
        (GRID + "[random]\ncount = 1\nbetween = {}", r"'grid and random': must have one of"),
        ("[grid]\nstep_lenght_m = [1]", r"step_lenght_m: a problem has no such field; use one of"),
        ("[grid]\nlimits.sun = [1]", r"limits.sun: a problem has no such field; use one of limits"),
        ("[grid]\nsun.moon = [1]", r"sun.moon: a problem has no such field; name a key"),
        ("[grid]\nlimits = [1]", r"limits: a problem has no such field"),
        ("[grid]\nfolder = ['x']", r"folder: a problem has no such field"),
        ("[grid]\nstep_length_m = []", r"step_length_m = \[\]: has no values; give at least one"),
        ("[grid]\nstep_length_m = [1, 1.0]", r"step_length_m = 1.0: stands twice; leave out"),
        ("[grid]\nstep_length_m = 0.7", r"grid.step_length_m = 0.7: should be a valid list"),
        ("[grid]", r"grid = 'nothing': must sweep a field; name one and its values"),
        ("grid = 3", r"grid = 3: should be a valid dictionary"),
        (
            "[grid]\nstep_length_m = {low = 0.8, high = 0.7, count = 3}",
            r"grid.step_length_m.high = 0.7: must be above low, 0.8; exchange them",
        ),
        (
            "[grid]\nstep_length_m = {low = 0.8, high = inf, count = 3}",
            r"grid.step_length_m.high = inf: should be a finite number",
        ),
        (
            "[grid]\nstep_length_m = {low = 0.8, count = 3}",
            r"grid.step_length_m.high: required but missing; add it",
        ),
        (
            "[random]\ncount = 2\n[random.between]\nstep_length_m = [0.8, 0.7]",
            r"step_length_m = \[0.8, 0.7\]: must be two numbers, the lower first",
        ),
        (
            "[random]\ncount = 2\nbetween = {}",
            r"random = 'nothing': must sweep a field",
        ),
        (GRID + "[solve]\nstarts = 0", r"solve.starts = 0: should be greater than or equal to 1"),
        (GRID + "[solve]\ntime_limit_s = 0", r"solve.time_limit_s = 0: should be greater than 0"),
        (GRID + "[solve]\nstart = 1", r"solve.start: unknown key; did you mean 'starts'\?"),
        ('name = "../x"\n' + GRID, r"name = '../x': string should match pattern"),
        ('preset = "a"\nproblem = "b"\n' + GRID, r"problem = 'b': contradicts preset; give one"),
        ("preset = 3\n" + GRID, r"preset = 3: should be a string; give a name"),
        ('preset = "moon"\n' + GRID, r"preset = 'moon': no such preset; choose one of"),
        ("base = 3\n" + GRID, r"base: unknown key; name a problem file or a preset"),
        ("workers = 3\n" + GRID, r"workers: unknown key"),
        ("[grid", r"not valid TOML"),
    ],
)
def test_a_file_that_makes_no_sweep_is_one_line(tmp_path: Path, text: str, match: str) -> None:
    with pytest.raises(InputError, match=match) as caught:
        sweep_of(tmp_path, text)
    assert str(caught.value).startswith(f"{tmp_path / 'sweep.toml'}: ")
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(SweepError, match=r"none.toml: cannot be read \(No such file or directory"):
        read_sweep(tmp_path / "none.toml")


def test_too_many_cases_are_refused_before_they_are_made(tmp_path: Path) -> None:
    text = "[grid]\n" + "".join(
        f"{field} = {{low = 0.5, high = 0.9, count = 100}}\n"
        for field in ("step_length_m", "limits.friction_coefficient", "corridors.width_sd")
    )
    with pytest.raises(SweepError, match="grid = 1000000: has more than 100000 cases; take fewer"):
        sweep_of(tmp_path, text)


def test_a_problem_file_is_looked_for_beside_the_sweep(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text("step_length_m = 0.7\nstride_time_s = 1.3\n")
    assert sweep_of(tmp_path, 'problem = "p.toml"\n' + GRID).base.stride_time_s == 1.3
    with pytest.raises(ProblemError, match=r"none.toml: cannot be read"):
        sweep_of(tmp_path, 'problem = "none.toml"\n' + GRID)


# --- keys --------------------------------------------------------------------------------------


def key(**changes: object) -> str:
    """Key of the one case of a sweep."""
    given = {"base": preset("berbyuk2002"), "grid": {"step_length_m": [0.7]}, **changes}
    (case,) = cases_of(Sweep(**given))
    return case.key


def test_a_key_is_made_from_the_content_of_the_problem(tmp_path: Path) -> None:
    base = preset("berbyuk2002")
    assert key() == key(base=base.replace(name="another"), name="other")
    assert key() == key(base=base.replace(step_length_m=0.9))  # is swept
    assert key() == key(grid={"step_length_m": [0.7], "stride_time_s": [1.14]})
    assert key() == key(solve={"time_limit_s": 5.0, "memory_limit_mb": 500.0})
    different = [
        key(),
        key(grid={"step_length_m": [0.7000001]}),
        key(base=base.replace(stride_time_s=1.15)),
        key(solve={"starts": 2}),
        key(solve={"starts": 2, "seed": 1}),
        key(solve={"continuation": False}),
    ]
    assert len(set(different)) == len(different)


def test_a_key_depends_on_the_table_that_the_problem_names_not_on_its_name(tmp_path: Path) -> None:
    def of(name: str, text: str) -> str:
        (tmp_path / name).write_text(text)
        base = preset("berbyuk2002").replace(folder=tmp_path)
        corridors = base.corridors.replace(source=name)
        return key(base=base.replace(corridors=corridors))

    assert of("a.csv", "1") == of("b.csv", "1") != of("c.csv", "2")


def test_a_case_that_contradicts_itself_stays_with_its_reason() -> None:
    sweep = Sweep(base=preset("berbyuk2002"), grid={"step_length_m": [0.7, 3.0]})
    good, bad = cases_of(sweep)
    assert good.refused == ""
    assert bad.problem is None
    assert bad.refused.startswith("step_length_m = 3.0: out of reach: these legs span")


def test_a_sweep_without_any_problem_is_refused() -> None:
    sweep = Sweep(base=preset("berbyuk2002"), grid={"step_length_m": [-1, "x"]})
    with pytest.raises(ProblemError, match="step_length_m = -1: should be greater than 0"):
        cases_of(sweep)


def test_the_same_problem_twice_is_refused() -> None:
    sweep = Sweep(base=preset("berbyuk2002"), cases=[{"step_length_m": 0.7}] * 2)
    with pytest.raises(SweepError, match="case 2 = .*: is the same problem as case 1; leave it"):
        cases_of(sweep)


def test_changing_a_problem_keeps_the_rest() -> None:
    base = preset("winter-slow")
    assert changed(base, {}) == base
    assert changed(base, {"corridors.width_sd": 2.0}).corridors.source == "winter-slow"
