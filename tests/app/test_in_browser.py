"""The app in a real browser: from the button to the moving walker, and what can go wrong."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from ergowalk.app.results import store
from ergowalk.problem import preset
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution

from .serving import STAND_IN, app, gone

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

WIDTHS, SCHEMES = (1280, 390), ("light", "dark")

expect = sync_api.expect


@pytest.fixture(scope="module")
def found(paper_gait_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the stand-in finds: a solved gait with all that belongs to it."""
    folder = tmp_path_factory.mktemp("found")
    said = store(Solution.load(paper_gait_file), folder, 1) | {"film": "film.mp4"}
    (folder / "said.json").write_text(json.dumps(said), "utf-8")
    return folder


@pytest.fixture(scope="module")
def url(found: Path) -> Iterator[str]:
    with app((*STAND_IN, str(found)), workers=2, grace_s=2.0, upload_limit_kib=4) as address:
        yield address


class Visitor:
    """One person's browser at the app; complains if anything was complained of or asked elsewhere.

    Unless asked otherwise the walkers wait to be started, which spares the processor. ``refusals``
    counts the answers that the page rightly got other than 200.
    """

    def __init__(self, chromium: Any, url: str, **context: Any) -> None:
        self.url, self.refusals = url, 0
        self._context = chromium.new_context(**{"reduced_motion": "reduce"} | context)
        self._complaints: list[str] = []
        self._asked: list[str] = []
        self.page = self.open()

    def open(self) -> Any:
        page = self._context.new_page()
        page.on("console", lambda message: self._complaints.append(message.text))
        page.on("pageerror", lambda error: self._complaints.append(str(error)))
        page.on("request", lambda request: self._asked.append(request.url))
        page.goto(self.url)
        expect(page.locator("#solve")).to_be_enabled()
        return page

    def solve(self, name: str) -> None:
        self.page.get_by_label("Name").fill(name)
        self.page.get_by_role("button", name="Solve").click()

    def leave(self) -> None:
        self._context.close()
        assert {urlsplit(asked).netloc for asked in self._asked} == {urlsplit(self.url).netloc}
        refused = [c for c in self._complaints if c.startswith("Failed to load resource")]
        assert (len(self._complaints), len(refused)) == (self.refusals, self.refusals), (
            self._complaints
        )


@pytest.fixture
def visitor(chromium: Any, url: str) -> Iterator[Visitor]:
    somebody = Visitor(chromium, url, viewport={"width": 1280, "height": 844})
    yield somebody
    somebody.leave()


def pid(page: Any) -> int:
    """The process of the only solve that runs, as the stand-in tells it to the page."""
    expect(page.locator(".words")).to_have_text("begun")
    told = page.evaluate(
        """() => new Promise((resolve) => {
            const events = new EventSource("/events");
            events.addEventListener("state", (event) => {
                events.close();
                resolve(JSON.parse(event.data).find((job) => job.state === "running").progress.pid);
            });
        })"""
    )
    return int(told)


def test_the_default_problem_goes_from_the_button_to_the_moving_walker(chromium: Any) -> None:
    """With the real solver: most of a minute of a processor."""
    with app(None, time_limit_s=900.0) as url:
        visitor = Visitor(chromium, url, reduced_motion="no-preference")
        page = visitor.page
        expect(page.get_by_label("Preset")).to_have_value("berbyuk2002")
        page.get_by_role("button", name="Solve").click()
        words = page.locator(".words")
        expect(words).to_have_text(re.compile(r"rhythm held, \d+ elements"), timeout=180_000)
        expect(page.locator(".iteration")).to_have_text(re.compile(r"^\d+$"))
        expect(page.locator(".energy")).to_have_text(re.compile(r"^\d+\.\d\d J/m$"))
        expect(page.locator(".violation")).to_have_text(re.compile(r"^\d\.\de[+-]\d+$"))
        expect(page.locator(".time")).to_have_text(re.compile(r"^\d+ s$"))
        expect(page).to_have_title(re.compile("Solving"))

        walker = page.locator(".viewer")
        walker.wait_for(timeout=600_000)
        expect(page.locator("#gait-list .name")).to_have_text(
            re.compile(r"^1: berbyuk2002, 0\.76 m, 1\.14 s, E = 4[78]\.\d\d J/m$")
        )
        expect(page.locator("#gait-list .verdict")).to_be_hidden()
        expect(page).to_have_title("ergowalk")
        start = float(walker.get_attribute("data-position"))
        deadline = time.monotonic() + 20
        while float(walker.get_attribute("data-position")) < start + 0.2:
            assert time.monotonic() < deadline, "the walker stands still"
        with page.expect_download() as download:
            page.get_by_role("link", name="gait.nc").click()
        assert download.value.suggested_filename == "gait.nc"
        gait = Solution.load(download.value.path())
        assert gait.acceptable
        assert gait.problem.replace(folder=None) == preset("berbyuk2002")
        visitor.leave()


def test_a_running_solve_is_shown_and_can_be_cancelled(visitor: Visitor) -> None:
    page = visitor.page
    visitor.solve("endless")
    process = pid(page)
    expect(page.locator(".iteration")).to_have_text("1")
    expect(page.locator(".energy")).to_have_text("50.00 J/m")
    expect(page.locator("#open-solves li")).to_be_in_viewport()
    page.get_by_role("button", name="Cancel").click()
    expect(page.locator(".words")).to_have_text("No gait: cancelled.")
    assert gone(process)
    page.get_by_role("button", name="Dismiss").click()
    expect(page.locator("#solves")).to_be_hidden()


def test_a_solve_survives_a_reload_and_not_the_end_of_its_tab(visitor: Visitor) -> None:
    page = visitor.page
    visitor.solve("endless")
    process = pid(page)
    page.reload()
    assert pid(page) == process
    assert not gone(process, within=2.5)  # the grace period is 2 s
    elsewhere = visitor.open()
    page.close()
    assert pid(elsewhere) == process
    assert not gone(process, within=2.5)
    elsewhere.close()
    assert gone(process)


def test_a_gait_found_while_the_page_was_reloaded_is_shown(visitor: Visitor) -> None:
    visitor.solve("short")
    visitor.page.reload()
    visitor.page.locator(".viewer").wait_for()
    expect(visitor.page.locator(".viewer legend + label")).to_contain_text("1: berbyuk2002-rhythm")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"step_length_m = 'far'\nstride_time_s = 1\n", "bad.toml: step_length_m = 'far': should"),
        (b"\x89PNG", "bad.toml: not UTF-8 text (byte 0); save the problem file as UTF-8"),
        (
            b"step_length_m = 0.7\nstride_time_s = 1.1\n[corridors]\nsource = '/etc/passwd'\n",
            "bad.toml: corridors.source = '/etc/passwd': names a file, and the app opens none",
        ),
        (b"#" * 5000, "bad.toml: larger than 4 KiB; give a problem file"),
    ],
    ids=["value", "picture", "path", "size"],
)
def test_a_bad_upload_is_refused_in_the_librarys_sentence(
    visitor: Visitor, content: bytes, sentence: str
) -> None:
    page = visitor.page
    visitor.refusals = int(len(content) <= 4096)  # a larger one is not even sent
    page.get_by_label("or a problem file").set_input_files(
        {"name": "bad.toml", "mimeType": "application/toml", "buffer": content}
    )
    expect(page.locator("#refusal")).to_contain_text(sentence)
    expect(page.get_by_label("Step length")).to_have_value("0.76")  # the form is as it was


def test_an_uploaded_problem_is_what_is_solved(visitor: Visitor) -> None:
    page = visitor.page
    content = problem_to_toml(preset("winter-slow").replace(name="mine")).encode()
    page.get_by_label("or a problem file").set_input_files(
        {"name": "my walk.toml", "mimeType": "application/toml", "buffer": content}
    )
    expect(page.locator("#file-note")).to_have_text("The form has the values of my walk.toml.")
    expect(page.get_by_label("Stride time")).to_have_value("1.4")
    page.get_by_label("Vertical reaction").fill("")
    page.get_by_label("Half width").fill("1,5")
    page.get_by_label("Name").fill("short")
    with page.expect_request("**/solves") as asked:
        page.get_by_role("button", name="Solve").click()
    sent = asked.value.post_data_json["problem"]
    assert sent["limits"]["vertical_reaction_body_weights"] == "off"
    assert (sent["corridors"]["source"], sent["corridors"]["width_sd"]) == ("winter-slow", 1.5)
    page.locator(".viewer").wait_for()
    page.locator("#gait-list summary").click()
    page.get_by_label("Name").fill("another")
    page.get_by_role("button", name="Use this problem").click()
    expect(page.get_by_label("Name")).to_have_value("short")
    expect(page.get_by_label("Half width")).to_have_value("1.5")


def test_a_hostile_name_stays_text(visitor: Visitor) -> None:
    name = "killed </script><img src=x onerror=alert(1)><b>bold</b>"
    visitor.solve(name)
    card = visitor.page.locator("#open-solves li")
    expect(card.locator(".problem-note")).to_be_visible()
    expect(card.locator(".title")).to_contain_text("<img src=x onerror=alert(1)>")
    expect(card.locator("img, b, script")).to_have_count(0)


def test_speed_step_and_time_go_together(visitor: Visitor) -> None:
    page = visitor.page
    expect(page.get_by_label("Speed 2 L / T")).to_have_value("1.333")
    page.get_by_label("Speed 2 L / T").fill("1")
    expect(page.get_by_label("Stride time")).to_have_value("1.52")
    page.get_by_label("Step length").fill("0.5")
    expect(page.get_by_label("Speed 2 L / T")).to_have_value("0.6579")
    page.get_by_label("Preset").select_option("winter-fast")
    expect(page.get_by_label("Speed 2 L / T")).to_have_value("1.691")


def test_a_refused_value_is_marked_and_explained_where_it_stands(visitor: Visitor) -> None:
    page, visitor.refusals = visitor.page, 1
    page.get_by_label("Stride time").fill("soon")
    page.get_by_role("button", name="Solve").click()
    expect(page.locator("#refusal")).to_contain_text(
        "stride_time_s = 'soon': should be a valid number; give stride time T"
    )
    field = page.get_by_label("Stride time")
    expect(field).to_be_focused()
    expect(field).to_have_attribute("aria-invalid", "true")
    field.fill("1.1")
    visitor.solve("short")
    expect(page.locator("#refusal")).to_be_hidden()
    page.locator(".viewer").wait_for()


def test_two_people_at_once_do_not_disturb_each_other(chromium: Any, url: str) -> None:
    ann, bob = Visitor(chromium, url), Visitor(chromium, url)
    ann.solve("endless")
    bob.solve("endless")
    hers, his = pid(ann.page), pid(bob.page)
    assert hers != his
    ann.page.get_by_role("button", name="Cancel").click()
    assert gone(hers)
    expect(bob.page.locator(".words")).to_have_text("begun")
    assert not gone(his, within=0.5)
    ann.solve("short")
    ann.page.locator(".viewer").wait_for()
    expect(bob.page.locator("#gaits-section")).to_be_hidden()
    ann.leave()
    assert not gone(his, within=2.5)
    bob.leave()
    assert gone(his)


def test_gaits_are_laid_over_each_other_and_removed(visitor: Visitor) -> None:
    page = visitor.page
    labels = page.locator(".viewer .gaits label")
    for count in (1, 2):
        visitor.solve("short")
        expect(page.locator("#gait-list li")).to_have_count(count)
        expect(labels).to_have_count(1)
        expect(labels).to_contain_text(f"{count}: ")
    page.locator("#gait-list .show").nth(1).check()
    expect(labels).to_have_count(2)
    expect(page.locator(".plot").first.locator("path[stroke]")).to_have_count(2)
    page.reload()
    expect(labels).to_have_count(2)  # what was shown is shown again
    page.locator("#gait-list summary").first.click()
    page.get_by_role("button", name="Remove").first.click()
    expect(labels).to_have_count(1)
    page.locator("#gait-list .show").uncheck()
    expect(page.locator(".viewer")).to_have_count(0)
    expect(page.locator("#empty")).to_be_visible()


def test_gait_report_problem_and_film_can_be_downloaded(visitor: Visitor) -> None:
    visitor.solve("short")
    for name in ("gait.nc", "report.html", "problem.toml", "film.mp4"):
        with visitor.page.expect_download() as download:
            visitor.page.get_by_role("link", name=name).click()
        assert download.value.suggested_filename == name
        assert download.value.path().stat().st_size > 10


def test_the_keyboard_is_enough(visitor: Visitor) -> None:
    page = visitor.page
    page.get_by_label("Stride time").focus()
    page.keyboard.press("Enter")
    page.locator(".viewer").wait_for()
    page.locator(".viewer .play").focus()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Pause")).to_have_count(1)
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Play")).to_have_count(1)
    page.locator("canvas").focus()
    here = float(page.locator(".viewer").get_attribute("data-position"))
    page.keyboard.press("Shift+ArrowRight")
    expect(page.locator(".viewer")).not_to_have_attribute("data-position", f"{here:.4f}")
    page.locator("body").focus()
    seen = []
    for _ in range(60):
        page.keyboard.press("Tab")
        seen.append(page.evaluate("document.activeElement.outerHTML.slice(0, 80)"))
    for part in ('id="preset"', 'id="file"', 'id="speed"', 'id="solve"', 'class="show"', "gait.nc"):
        assert any(part in element for element in seen), part


@pytest.mark.usefixtures("visitor")
def test_a_server_that_went_away_is_told(chromium: Any) -> None:
    with app(STAND_IN) as url:
        context = chromium.new_context()
        page = context.new_page()
        page.goto(url)
        expect(page.locator("#solve")).to_be_enabled()
    expect(page.locator("#connection")).to_have_text(re.compile("^The server does not answer"))
    page.get_by_role("button", name="Solve").click()
    expect(page.locator("#refusal")).to_have_text(re.compile("^The server does not answer"))
    context.close()


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("width", WIDTHS)
def test_everybody_can_read_every_screen(chromium: Any, url: str, width: int, scheme: str) -> None:
    """No finding of axe-core at all, nothing wider than the screen."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    look = {"viewport": {"width": width, "height": 844}, "color_scheme": scheme}
    visitor = Visitor(chromium, url, **look)
    page = visitor.page

    def check() -> None:
        found = axe.run(page).response
        assert len(found["passes"]) > 20
        assert [(v["id"], v["impact"], v["nodes"]) for v in found["violations"]] == []
        assert page.evaluate("document.documentElement.scrollWidth - window.innerWidth") <= 0

    page.get_by_label("Scale it to a person").check()
    page.locator("form summary").click()
    check()
    visitor.solve("endless")
    pid(page)
    visitor.solve("killed")
    expect(page.locator(".words.problem-note")).to_be_visible()
    visitor.solve("short")
    page.locator("#gait-list summary").click()
    visitor.refusals = 1
    page.get_by_label("Friction coefficient").fill("-1")
    page.get_by_role("button", name="Solve").click()
    expect(page.locator("#refusal")).to_be_visible()
    check()
    visitor.leave()
