"""A page in a real browser with the network off, and a report to open in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

WIDTHS = (1280, 390)
"""Of a desk and of a hand."""


@contextmanager
def shown(chromium: Any, path: Path, width: int) -> Iterator[Any]:
    """A page opened from disk with the network off; nothing may be complained of or asked for."""
    context = chromium.new_context(
        viewport={"width": width, "height": 844}, offline=True, has_touch=True
    )
    page = context.new_page()
    complaints: list[str] = []
    asked: list[str] = []
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    yield page
    context.close()
    assert complaints == []
    assert asked == [path.as_uri()]


@pytest.fixture(scope="module")
def report(paper_gait_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two gaits, of which one is not acceptable, and the walker of the human means."""
    from ergowalk.solution import Solution
    from ergowalk.viewer import report_html

    solution = Solution.load(paper_gait_file)
    refused = Solution(solution.dataset.assign_attrs(acceptable=0), solution.folder)
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(report_html([solution, refused], human=True), "utf-8")
    return path
