"""The report is one file that refers to nothing, says everything, and trusts no text."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from itertools import pairwise
from typing import Any

import pytest
import xarray as xr

from ergowalk.errors import GaitFileError
from ergowalk.solution import Solution
from ergowalk.viewer import report_html
from ergowalk.viewer.page import json_in_html

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)> & \"quoted\" 'so'"
VOID = {"meta", "input", "br", "img", "link", "hr"}


class Outline(HTMLParser):
    """Elements of a page that must be well nested, and the texts of some."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, list[str]] = {}
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
            self.texts.setdefault(tag, []).append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        for tag in self.open:
            self.texts[tag][-1] += data

    def named(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for found, attributes in self.elements if found == tag]


def gaits_of(page: str) -> Any:
    return json.loads(re.findall(r'<script type="application/json" id="gaits">(.*?)</', page)[0])


@pytest.fixture(scope="module")
def solution(paper_gait: xr.Dataset) -> Solution:
    return Solution(paper_gait)


@pytest.fixture(scope="module")
def page(solution: Solution) -> str:
    return report_html([solution])


def renamed(solution: Solution, name: str) -> Solution:
    text = str(solution.dataset.attrs["problem"])
    old = re.findall(r"^name = .*$", text, re.M)[0]
    problem = text.replace(old, f"name = {json.dumps(name)}")
    return Solution(solution.dataset.assign_attrs(problem=problem))


def test_a_page_refers_to_nothing_outside_itself(page: str) -> None:
    assert not re.search(r"https?://|url\(|@import|fetch\(|XMLHttpRequest", page)
    outline = Outline(page)
    assert [a for _, a in outline.elements if {"src", "href"} & set(a)] == []
    policy = next(a["content"] for a in outline.named("meta") if "http-equiv" in a)
    assert str(policy).startswith("default-src 'none'")


def test_a_page_of_several_gaits_is_under_three_megabytes(solution: Solution) -> None:
    page = report_html([solution] * 4)
    assert len(page.encode()) < 3_000_000
    labels = [gait["label"] for gait in gaits_of(page)]
    assert len(set(labels)) == 4


def test_the_page_can_be_read_by_everyone(page: str) -> None:
    outline = Outline(page)
    assert outline.named("html") == [{"lang": "en"}]
    assert len(outline.named("h1")) == len(outline.named("main")) == 1
    assert outline.texts["title"][0].startswith("Gait report: berbyuk2002-rhythm, E = ")
    (canvas,) = outline.named("canvas")
    assert canvas["role"] == "img"
    assert canvas["aria-label"]
    levels = [int(tag[1]) for tag, _ in outline.elements if re.fullmatch("h[1-6]", tag)]
    assert all(b <= a + 1 for a, b in pairwise(levels))


def test_the_page_says_what_a_reader_asks(page: str, solution: Solution) -> None:
    text = " ".join(Outline(page).texts["main"])
    assert f"{solution.energy_per_metre:.2f} ± {solution.energy_error:.2f} J/m" in text
    for words in (
        solution.problem.limits.sentence(),
        "cost of transport",
        "foot flat 10.0 %",
        "peak moment",
        "positive [J/m]",
        "RMS distance",
        "all 36 lines pass",
        "stride_time_s = 1.14",
        "ergowalk solve problem.toml -o gait",
    ):
        assert words in text, words


def test_a_hostile_name_stays_text(solution: Solution) -> None:
    page = report_html([renamed(solution, HOSTILE)])
    outline = Outline(page)
    assert len(outline.named("script")) == 2
    assert outline.named("img") == []
    assert HOSTILE in outline.texts["h1"][0]
    assert gaits_of(page)[0]["label"].startswith(HOSTILE)


def test_braces_in_a_name_are_no_placeholders(solution: Solution) -> None:
    assert (
        "{viewer} {0}" in Outline(report_html([renamed(solution, "{viewer} {0}")])).texts["h1"][0]
    )


def test_json_in_a_page_ends_no_element() -> None:
    text = json_in_html(["</script>", "<!--", "\u2028"])
    assert "<" not in text
    assert json.loads(text) == ["</script>", "<!--", "\u2028"]


def test_a_gait_that_is_not_acceptable_is_marked(solution: Solution) -> None:
    page = report_html([Solution(solution.dataset.assign_attrs(acceptable=0)), solution])
    outline = Outline(page)
    (warning,) = [p for p in outline.texts["p"] if p.startswith("Not acceptable: ")]
    assert "berbyuk2002-rhythm" in warning
    assert [gait["acceptable"] for gait in gaits_of(page)] == [False, True]
    assert "NOT ACCEPTABLE" in page


def test_a_gait_that_fails_its_audit_is_marked(solution: Solution) -> None:
    wrong = solution.dataset.copy(deep=True)
    wrong["ground_reaction_force"][:] *= 1.01
    text = report_html([Solution(wrong)])
    assert re.search(r"audit lines fail\.</p>", text)
    assert gaits_of(text)[0]["acceptable"] is False


def test_an_unusable_gait_is_named_by_its_file(solution: Solution) -> None:
    bad = Solution(solution.dataset.assign_attrs(body_parameters="{}"))
    with pytest.raises(GaitFileError, match=r"^b\.nc: .*body_parameters"):
        report_html([solution, bad], ["a.nc", "b.nc"])


def test_a_record_of_meshes_that_cannot_be_read_is_refused(solution: Solution) -> None:
    dataset = solution.dataset.assign_attrs(mesh_history="no JSON")
    with pytest.raises(GaitFileError, match="mesh_history"):
        report_html([Solution(dataset)])


@pytest.mark.parametrize("name", ["acceptable", "rhythm", "solver_status"])
def test_a_gait_that_does_not_say_how_it_ended_is_refused(solution: Solution, name: str) -> None:
    dataset = solution.dataset.copy()
    dataset.attrs = {key: v for key, v in dataset.attrs.items() if key != name}
    with pytest.raises(GaitFileError, match=name):
        report_html([Solution(dataset)])
