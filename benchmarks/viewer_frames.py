"""What a frame of the report's film costs in a browser.

``python benchmarks/viewer_frames.py GAIT.nc [--seconds 5]``

Plays the film of a report in the Chromium of the system (extra ``browser``) and prints, for
several numbers of gaits, the time that the script takes for a frame (median and 95th percentile;
a screen of 60 frames a second leaves 16.7 ms for it and for the browser) and the frames a second
that the browser showed. Without a graphics processor the browser draws on the processor too.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright

from ergowalk.solution import Solution
from ergowalk.viewer import report_html

CASES = {"1 gait": (1, False), "1 gait and the human means": (1, True), "4 gaits": (4, False)}
WIDTHS = (1280, 390)

WATCH = """
window.costs = []; window.stamps = [];
const ask = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (draw) => ask((now) => {
  const start = performance.now();
  draw(now);
  window.costs.push(performance.now() - start);
  window.stamps.push(now);
});
"""


def played(browser: Any, page: Path, width: int, seconds: float) -> tuple[list[float], float]:
    """Cost of each frame [ms], and frames a second."""
    context = browser.new_context(viewport={"width": width, "height": 844}, offline=True)
    opened = context.new_page()
    opened.add_init_script(WATCH)
    opened.goto(page.as_uri())
    opened.wait_for_timeout(1000)  # the first frames wait for the page
    opened.evaluate("window.costs.length = window.stamps.length = 0")
    opened.wait_for_timeout(1000 * seconds)
    costs, stamps = opened.evaluate("[window.costs, window.stamps]")
    context.close()
    return costs, 1000 * (len(stamps) - 1) / (stamps[-1] - stamps[0])


def main() -> None:
    """Print a table of all cases."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gait", type=Path, metavar="GAIT.nc")
    parser.add_argument("--seconds", type=float, default=5.0)
    arguments = parser.parse_args()
    solution, program = Solution.load(arguments.gait), shutil.which("chromium")
    if program is None:
        raise SystemExit("chromium is not installed")
    print("| film | width | median | 95th percentile | frames a second |")
    print("| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        # the sandbox of Chromium does not start for root, as in most containers
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        for name, (count, human) in CASES.items():
            page = Path(folder) / f"{count}{human}.html"
            page.write_text(report_html([solution] * count, human=human), "utf-8")
            for width in WIDTHS:
                costs, rate = played(browser, page, width, arguments.seconds)
                late = statistics.quantiles(costs, n=20)[-1]
                middle = statistics.median(costs)
                print(f"| {name} | {width} | {middle:.1f} ms | {late:.1f} ms | {rate:.0f} |")
        browser.close()


if __name__ == "__main__":
    main()
