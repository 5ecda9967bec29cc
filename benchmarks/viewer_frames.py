"""What a frame of the report's film costs in a browser.

``python benchmarks/viewer_frames.py GAIT.nc [--seconds 5]``

Plays the film of a report in the Chromium of the system (extra ``browser``) and prints, for
several numbers of gaits, the processor time of a frame: of the script that draws it (median) and of
all that the page's thread does for it, layout and painting included (mean). A screen of 60 frames a
second leaves 16.7 ms. The last column is what the browser showed, which needs a free processor:
without a graphics processor Chromium fills the pixels on it too, in threads of their own.
"""

from __future__ import annotations

import argparse
import json
import shutil
import statistics
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright

from ergowalk.solution import Solution
from ergowalk.viewer import report_html

CASES = {"1 gait": (1, False), "1 gait and the human means": (1, True), "4 gaits": (4, False)}
WIDTHS = (1280, 390)

TRACED = ["devtools.timeline", "disabled-by-default-devtools.timeline"]


@dataclass(frozen=True)
class Cost:
    """Of a frame: processor time of its script and of all the page's thread does; rate shown."""

    script_ms: float
    page_ms: float
    per_second: float


def played(browser: Any, page: Path, width: int, seconds: float) -> Cost:
    """Cost of a frame while the film of a report plays."""
    context = browser.new_context(viewport={"width": width, "height": 844}, offline=True)
    opened = context.new_page()
    opened.goto(page.as_uri())
    opened.wait_for_timeout(1000)  # the first frames wait for the page
    browser.start_tracing(page=opened, categories=TRACED)
    opened.wait_for_timeout(1000 * seconds)
    events = json.loads(browser.stop_tracing())["traceEvents"]
    context.close()
    frames = [e for e in events if e["name"] == "FireAnimationFrame" and "tdur" in e]
    threads = {(e["pid"], e["tid"]) for e in frames}
    tasks = [
        e["tdur"]
        for e in events
        if e["name"] == "RunTask" and (e["pid"], e["tid"]) in threads and "tdur" in e
    ]
    span = (frames[-1]["ts"] - frames[0]["ts"]) / 1e6
    return Cost(
        statistics.median(e["tdur"] for e in frames) / 1000,
        sum(tasks) / len(frames) / 1000,
        (len(frames) - 1) / span,
    )


def main() -> None:
    """Print a table of all cases."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gait", type=Path, metavar="GAIT.nc")
    parser.add_argument("--seconds", type=float, default=5.0)
    arguments = parser.parse_args()
    solution, program = Solution.load(arguments.gait), shutil.which("chromium")
    if program is None:
        raise SystemExit("chromium is not installed")
    print("| film | width | script | page | frames a second |")
    print("| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        # the sandbox of Chromium does not start for root, as in most containers
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        for name, (count, human) in CASES.items():
            page = Path(folder) / f"{count}{human}.html"
            page.write_text(report_html([solution] * count, human=human), "utf-8")
            for width in WIDTHS:
                cost = played(browser, page, width, arguments.seconds)
                print(
                    f"| {name} | {width} | {cost.script_ms:.1f} ms | {cost.page_ms:.1f} ms "
                    f"| {cost.per_second:.0f} |"
                )
        browser.close()


if __name__ == "__main__":
    main()
