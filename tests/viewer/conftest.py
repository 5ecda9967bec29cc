"""A real browser, with the network off, and a report to open in it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium of the system; the test is skipped where there is none."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    chromium = shutil.which("chromium")
    if chromium is None:
        pytest.skip("chromium is not installed")
    with sync_api.sync_playwright() as playwright:
        # the sandbox of Chromium does not start for root, as in most containers
        opened = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        yield opened
        opened.close()


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
