"""The report in a real browser, opened from disk with the network off."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from .conftest import WIDTHS, shown


@pytest.fixture(params=WIDTHS)
def page(chromium: Any, report: Path, request: pytest.FixtureRequest) -> Iterator[Any]:
    """The report at both widths."""
    with shown(chromium, report, request.param) as opened:
        yield opened


def position(page: Any) -> float:
    return float(page.locator(".viewer").get_attribute("data-position"))


def picture(page: Any) -> bytes:
    return page.locator("canvas").screenshot()


def cursors(page: Any) -> set[float]:
    """Where in its plot or bar each cursor stands on the screen, in whole percent."""
    places = page.locator(".cursor").evaluate_all(
        """all => all.map((c) => {
            const plot = c.parentElement.parentElement;
            const from = plot.getBoundingClientRect().left + plot.clientLeft;
            return (100 * (c.getBoundingClientRect().left + 1 - from)) / plot.clientWidth;
        })"""
    )
    return {float(round(place)) for place in places}


def settle(page: Any) -> None:
    page.evaluate("new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))")


def pause(page: Any) -> None:
    page.get_by_role("button", name="Pause").click()
    settle(page)


def test_the_film_moves_and_every_cursor_goes_with_it(page: Any) -> None:
    start, before = position(page), picture(page)
    page.wait_for_function(
        f"document.querySelector('.viewer').dataset.position > {start + 0.2}", timeout=20_000
    )
    pause(page)
    assert picture(page) != before
    here = 100 * (position(page) % 1)
    assert all(abs(cursor - here) <= 1 for cursor in cursors(page))
    still = picture(page)
    settle(page)
    assert picture(page) == still


def test_keys_play_step_and_pause(page: Any) -> None:
    page.locator("canvas").focus()
    page.keyboard.press("Space")
    settle(page)
    here = position(page)
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Shift+ArrowRight")
    settle(page)
    assert position(page) == pytest.approx(here + 0.11, abs=1e-3)
    page.keyboard.press("ArrowLeft")
    settle(page)
    assert position(page) == pytest.approx(here + 0.10, abs=1e-3)
    assert page.get_by_role("button", name="Play").count() == 1


def test_slider_and_finger_move_through_the_stride(page: Any) -> None:
    pause(page)
    page.locator(".scrub").fill("2.25")
    settle(page)
    assert cursors(page) == {25.0}
    assert "stride 3, 25 %" in page.locator(".clock").inner_text()
    plot = page.locator(".plot").first
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    page.touchscreen.tap(box["x"] + 0.75 * box["width"], box["y"] + box["height"] / 2)
    settle(page)
    assert position(page) == pytest.approx(2.75, abs=0.01)


def test_a_gait_can_be_hidden(page: Any) -> None:
    pause(page)
    lines = page.locator(".plot").first.locator("path[stroke]")
    assert lines.count() == 2
    page.get_by_role("checkbox").nth(1).uncheck()
    assert lines.count() == 1
    page.get_by_role("checkbox").nth(0).uncheck()
    settle(page)
    assert lines.count() == 0


def test_nothing_is_wider_than_the_screen(page: Any) -> None:
    wide = page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
    assert wide <= 0
