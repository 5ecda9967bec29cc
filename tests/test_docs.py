"""The documentation says what the code does: examples run, names exist, lists are complete."""

from __future__ import annotations

import doctest
import importlib
import json
import re
import shlex
from pathlib import Path

import pytest
import xarray as xr

import write_reference
from blocks import blocks, fill, pages
from ergowalk.audit import residuals
from ergowalk.audit.report import Residual
from ergowalk.cli.parser import build_parser
from ergowalk.problem import PRESETS
from ergowalk.problem.files import problem_from_toml
from ergowalk.solving.design_file import read_design
from ergowalk.study import read_sweep
from ergowalk.study.cases import cases_of

ROOT = Path(__file__).parents[1]
PAGES = [*pages(), ROOT / "CONTRIBUTING.md"]
EQUATIONS = ROOT / "docs" / "explanation" / "equations.md"
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
GAIT = "gait/gait.nc"


def fences(page: Path, language: str) -> list[str]:
    """The code blocks of a language on a page."""
    return [text for kind, text in FENCE.findall(page.read_text("utf-8")) if kind == language]


def named(page: Path) -> str:
    """What a page is called in the names of the tests."""
    return page.relative_to(ROOT).as_posix()


def with_any(language: str) -> list[Path]:
    """The pages that have code in a language."""
    return [page for page in PAGES if fences(page, language)]


@pytest.mark.parametrize("page", with_any("pycon"), ids=named)
def test_examples_print_what_the_page_shows(
    page: Path, request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "\n".join(fences(page, "pycon"))
    if GAIT in text:  # a solved gait lies where the page says
        (tmp_path / "gait").mkdir()
        (tmp_path / GAIT).symlink_to(request.getfixturevalue("paper_gait_file"))
    monkeypatch.chdir(tmp_path)
    told: list[str] = []
    example = doctest.DocTestParser().get_doctest(text, {}, page.name, str(page), 0)
    outcome = doctest.DocTestRunner().run(example, out=told.append)
    assert outcome.attempted > 0
    assert outcome.failed == 0, "".join(told)


def modules_with_examples() -> list[str]:
    """Names of the modules whose docstrings show examples."""
    source = ROOT / "src"
    found = [f for f in sorted(source.rglob("*.py")) if ">>>" in f.read_text("utf-8")]
    return [".".join(f.relative_to(source).with_suffix("").parts) for f in found]


@pytest.mark.parametrize("name", modules_with_examples())
def test_examples_in_docstrings_print_what_they_show(name: str) -> None:
    outcome = doctest.testmod(importlib.import_module(name.removesuffix(".__init__")))
    assert outcome.attempted > 0
    assert outcome.failed == 0


@pytest.mark.parametrize("page", with_any("python"), ids=named)
def test_code_that_would_take_minutes_is_at_least_python(page: Path) -> None:
    for text in fences(page, "python"):
        compile(text, str(page), "exec")


@pytest.mark.parametrize("page", with_any("toml"), ids=named)
def test_problem_and_sweep_files_on_the_pages_are_such_files(page: Path, tmp_path: Path) -> None:
    for text in fences(page, "toml"):
        if re.search(r"^\[+(grid|cases|random)\b", text, re.M):
            (tmp_path / "sweep.toml").write_text(text)
            assert cases_of(read_sweep(tmp_path / "sweep.toml"))
        elif "[[point]]" in text:
            (tmp_path / "design.toml").write_text(text)
            assert read_design(tmp_path / "design.toml").problems
        else:
            assert problem_from_toml(text, file=str(page)).step_length_m > 0


def shown_commands(page: Path) -> list[str]:
    """Every ``ergowalk`` command of a page: in shell code, in text, above an output."""
    text = page.read_text("utf-8")
    lines = [line for block in fences(page, "bash") for line in block.splitlines()]
    found = [re.sub(r".*\b(?=ergowalk )", "", line) for line in lines if "ergowalk " in line]
    found += re.findall(r"`(ergowalk [a-z][^`]*)`", text)
    return found + [name for name, _ in blocks(page, "output")]


@pytest.mark.parametrize("page", [p for p in PAGES if shown_commands(p)], ids=named)
def test_commands_on_the_pages_are_commands(page: Path) -> None:
    commands = write_reference.helps()
    for command in shown_commands(page):
        _, name, *rest = shlex.split(re.sub(r"\[(PROBLEM\.toml) \| .*?\]", r"\1", command))
        assert name in commands, command
        if rest:
            arguments = build_parser().parse_args([name, *rest])
            assert getattr(arguments, "preset", None) in (None, *PRESETS), command


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_every_dotted_name_on_the_pages_exists(page: Path) -> None:
    names = set(re.findall(r"\bergowalk(?:\.[A-Za-z_]\w*)+", page.read_text("utf-8")))
    assert [name for name in sorted(names) if not resolves(name)] == []


def resolves(name: str) -> bool:
    """Whether a dotted name leads to a module or to something in one."""
    parts = name.split(".")
    for cut in range(len(parts), 0, -1):
        try:
            thing = importlib.import_module(".".join(parts[:cut]))
        except ModuleNotFoundError:
            continue
        for part in parts[cut:]:
            if not hasattr(thing, part) and part not in getattr(thing, "model_fields", {}):
                return False
            thing = getattr(thing, part, None)
        return True
    return False


def test_a_name_that_does_not_exist_is_noticed() -> None:
    assert resolves("ergowalk.problem.constraints.eq2_exchange")
    assert not resolves("ergowalk.problem.constraints.eq99")
    assert not resolves("ergowalk.nowhere.eq2_exchange")


def equation_rows() -> list[tuple[set[int], list[str]]]:
    """Numbers and cells of the rows of the table of equations."""
    rows = []
    for line in EQUATIONS.read_text("utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        numbers: set[int] = set()
        for first, last in re.findall(r"\((\d+)\)(?:-\((\d+)\))?", cells[0]):
            numbers |= set(range(int(first), int(last or first) + 1))
        if line.startswith("| (") and numbers:
            rows.append((numbers, cells))
    return rows


def test_every_numbered_equation_of_the_paper_has_a_row() -> None:
    assert set().union(*(numbers for numbers, _ in equation_rows())) == set(range(1, 20))


@pytest.mark.parametrize("number", range(1, 11))
def test_equations_of_the_problem_name_a_function_and_an_audit_line(number: int) -> None:
    cells = [cells for numbers, cells in equation_rows() if number in numbers]
    assert all("`ergowalk." in where for _, _, where, _ in cells)
    known = {r.key for r in vars(residuals).values() if isinstance(r, Residual)}
    lines = {key for row in cells for key in re.findall(r"`(\w+)`", row[3])}
    assert lines
    assert lines <= known


def plain_help(text: str) -> str:
    """Help texts as Python 3.13 and later print them, without their line breaks."""
    return " ".join(re.sub(r"(-\w) ([A-Z]+), (--\w+) \2", r"\1, \3 \2", text).split())


def test_generated_blocks_are_what_the_code_says() -> None:
    texts = write_reference.generated()
    shown = {name: text for page in PAGES for name, text in blocks(page, "generated")}
    assert set(shown) == set(texts)
    stale = [name for name, text in texts.items() if plain_help(text) != plain_help(shown[name])]
    assert stale == [], "run python scripts/write_reference.py"
    stored = json.loads(write_reference.SCHEMA.read_text("utf-8"))
    assert stored == json.loads(write_reference.schema())


def test_filling_a_block_replaces_its_text_and_nothing_else(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("a\n<!-- output: x y -->\nold\n<!-- end -->\nb\n", "utf-8")
    assert not fill(page, "output", {"z": "new"})
    assert not fill(page, "study", {"x y": "new"})
    assert fill(page, "output", {"x y": "new\n"})
    assert page.read_text("utf-8") == "a\n<!-- output: x y -->\nnew\n<!-- end -->\nb\n"
    assert list(blocks(page, "output")) == [("x y", "new\n")]


@pytest.mark.parametrize("kind", ["output", "study"])
def test_results_on_the_pages_are_there_and_agree(kind: str) -> None:
    shown: dict[str, str] = {}
    for page in PAGES:
        for name, text in blocks(page, kind):
            assert text.strip(), f"{named(page)}: nothing in the block of {name}"
            assert shown.setdefault(name, text) == text
    assert shown


def test_the_page_on_the_gait_file_lists_its_attributes(paper_gait: xr.Dataset) -> None:
    page = (ROOT / "docs" / "reference" / "gait-file.md").read_text("utf-8")
    table = page[page.index("## Global attributes") :]
    cells = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    listed = {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}
    of_each_leg, of_designs = {"rhythm_leg_2", "step_lengths"}, {"design"}
    assert listed == set(paper_gait.attrs) | of_each_leg | of_designs


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_to_files_and_pictures_come_from_here(page: Path) -> None:
    text = FENCE.sub("", page.read_text("utf-8"))
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
        assert target.startswith("https://") or (page.parent / target).exists(), target
    assert not re.findall(r"!\[[^\]]*\]\(http|<(?:script|img|link|iframe)\b", text)
