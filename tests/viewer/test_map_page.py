"""The page of a map: one file that refers to nothing, and shows a gait when it is clicked."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from ergowalk.comparison import human_of
from ergowalk.viewer import gait_payload, map_html, packed

from .conftest import WIDTHS, shown

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)> & \"quoted\" 'so'"


def landscape(reason: str = "killed after its limit of 3 s") -> dict[str, Any]:
    """A square of four cases, one of them lost."""
    times, lengths = [1.0, 1.0, 1.2, 1.2], [0.6, 0.7, 0.6, 0.7]
    cases = [
        {"key": f"k{i}", "status": "accepted", "reason": "", "cost_of_transport": 0.06}
        | {"human_distance": None}
        for i in range(4)
    ]
    cases[3] |= {"status": "out of time", "reason": reason, "cost_of_transport": None}
    return {
        "x": times,
        "y": lengths,
        "x_name": "stride time T [s]",
        "y_name": "step length L [m]",
        "energy": [40.0, 44.0, 42.0, None],
        "accepted": [True, True, True, False],
        "triangles": [[0, 1, 2]],
        "speed": [2 * x / t for x, t in zip(lengths, times, strict=True)],
        "cadence": [120 / t for t in times],
        "valley": [[1.2, 0.62, 1.03, 40.5, 0.61, 0.64], [1.25, 0.65, 1.04, 41.0, 0.64, 0.66]],
        "people": [[1.1, 105.0, 6.0], [1.3, 112.0, 6.0]],
        "people_name": "people, scaled",
        "plain": [[1.1, 108.0, 6.0], [1.3, 115.0, 6.0]],
        "plain_name": "people",
        "cases": cases,
    }


@pytest.fixture(scope="module")
def gaits(paper_gait: xr.Dataset) -> dict[str, str]:
    """Two of the four gaits."""
    human = human_of(paper_gait)
    return {f"k{i}": packed(gait_payload(paper_gait, human, f"gait {i} < 3")) for i in (0, 1)}


def test_the_page_refers_to_nothing_outside_itself(gaits: dict[str, str]) -> None:
    page = map_html(landscape(), gaits, "A map")
    outside = re.findall(r"https?://[^\s\"']*", page)
    assert set(outside) == {"http://www.w3.org/2000/svg"}  # a name, nothing that is fetched
    assert not re.search(r"url\(|@import|fetch\(|XMLHttpRequest|<link|<img", page)
    assert "default-src &#x27;none&#x27;" in page


def test_no_text_of_a_sweep_ends_its_script(gaits: dict[str, str]) -> None:
    page = map_html(landscape(HOSTILE), gaits, HOSTILE)
    assert "<script>alert(1)" not in page
    assert "<img src=x" not in page
    found = re.findall(r'<script type="application/json" id="(\w+)">(.*?)</script>', page, re.S)
    assert [name for name, _ in found] == ["landscape", "gaits", "frame"]
    texts = {name: json.loads(text) for name, text in found}
    assert texts["landscape"]["cases"][3]["reason"] == HOSTILE


def test_the_same_gait_is_packed_alike(gaits: dict[str, str], paper_gait: xr.Dataset) -> None:
    again = packed(gait_payload(paper_gait, human_of(paper_gait), "gait 0 < 3"))
    assert again == gaits["k0"]
    assert len(again) < 100_000


# --- in a browser -------------------------------------------------------------------------------


@pytest.fixture(params=WIDTHS)
def page(
    chromium: Any, gaits: dict[str, str], tmp_path: Path, request: pytest.FixtureRequest
) -> Iterator[Any]:
    """The page at both widths."""
    path = tmp_path / "map.html"
    path.write_text(map_html(landscape(HOSTILE), gaits, "A map"), "utf-8")
    with shown(chromium, path, request.param) as opened:
        yield opened


def test_a_click_shows_the_gait_and_another_with_shift_lays_one_over_it(page: Any) -> None:
    frame = page.frame_locator(".walk")
    assert page.locator(".walk").is_hidden()
    page.locator(".case").nth(0).click()
    assert frame.locator(".gaits label").inner_text().strip() == "gait 0 < 3"
    start = float(frame.locator(".viewer").get_attribute("data-position"))
    page.wait_for_timeout(300)
    assert float(frame.locator(".viewer").get_attribute("data-position")) != start
    page.locator(".case").nth(1).click(modifiers=["Shift"])
    frame.locator(".gaits label").nth(1).wait_for()
    texts = [text.strip() for text in frame.locator(".gaits label").all_inner_texts()]
    assert texts == ["gait 0 < 3", "gait 1 < 3"]
    assert page.locator(".case.open").count() == 2


def test_the_keyboard_opens_a_gait_too(page: Any) -> None:
    page.locator(".case").nth(1).focus()
    assert "L [m]: 0.7" in page.locator(".told").inner_text()
    page.keyboard.press("Enter")
    label = page.frame_locator(".walk").locator(".gaits label")
    assert label.inner_text().strip() == "gait 1 < 3"


def test_a_case_says_what_is_known_of_it(page: Any) -> None:
    page.locator(".case").nth(2).click()
    told = page.locator(".told").inner_text()
    assert "E = 42.00 J/m" in told
    assert "its gait is not in this page" in told
    assert page.locator(".walk").is_hidden()
    page.locator(".case").nth(3).hover()
    assert HOSTILE in page.locator(".told").inner_text()


def test_both_planes_show_every_case_the_valley_and_what_is_beside_it(page: Any) -> None:
    assert page.locator(".case").count() == 4
    assert page.locator(".case circle").count() == 3
    assert page.locator(".valley-line").count() == 1
    assert page.locator(".isoline").count() >= 2
    page.locator(".plane").select_option("1")
    assert page.locator(".case").count() == 4
    assert page.locator(".people-line").count() == 2
    assert page.locator(".people-band").count() == 1
    assert page.locator(".valley-line").count() == 1
    wide = page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
    assert wide <= 0
