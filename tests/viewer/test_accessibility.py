"""What axe finds in the report: nothing serious, in both colour schemes, at both widths."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

axe = pytest.importorskip(
    "axe_playwright_python.sync_playwright", reason="axe-playwright-python is not installed"
)

GRAVE = ("serious", "critical")


def findings(page: Any) -> list[str]:
    """Serious and critical findings: rule, help, and where."""
    found = axe.Axe().run(page).response["violations"]
    return [
        f"{rule['id']} ({rule['impact']}): {rule['help']}: {node['target']}"
        for rule in found
        if rule["impact"] in GRAVE
        for node in rule["nodes"]
    ]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_axe_finds_nothing_serious(chromium: Any, report: Path, scheme: str, width: int) -> None:
    context = chromium.new_context(
        viewport={"width": width, "height": 844},
        color_scheme=scheme,
        reduced_motion="reduce",
        offline=True,
    )
    page = context.new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(report.as_uri())
    page.locator("summary").first.click()
    assert findings(page) == []
    assert asked == [report.as_uri()]
    context.close()


def test_a_page_that_cannot_be_read_is_noticed(chromium: Any) -> None:
    page = chromium.new_page()
    page.set_content("<p style='color:#bbb'>pale words</p><img src='data:,'><input>")
    found = " ".join(findings(page))
    for rule in ("html-has-lang", "image-alt", "label", "color-contrast"):
        assert rule in found
    page.close()
