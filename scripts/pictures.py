"""Makes the film and the picture of the report that README shows, from a stored gait.

``python scripts/pictures.py GAIT.nc``

Writes docs/assets/walk.webp and docs/assets/report.png. The report is opened from disk, with the
network off, in the Chromium of the system, which the extra ``browser`` drives.
"""

from __future__ import annotations

import argparse
import io
import shutil
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from blocks import ROOT
from ergowalk.film import FilmOptions, film
from ergowalk.solution import Solution
from ergowalk.viewer import payloads, report_html

ASSETS = ROOT / "docs" / "assets"
FILM = FilmOptions(format="webp", width=560, height=404, fps=20.0, trail=True)
SCREEN = {"width": 1200, "height": 920}
INSTANT = "1.56"
"""Where the film of the report stands: strides from its beginning."""


def photograph(page: str) -> Image.Image:
    """What a screen shows of a page at :data:`INSTANT`.

    Raises
    ------
    SystemExit
        If there is no Chromium.
    """
    program = shutil.which("chromium")
    if program is None:
        raise SystemExit("chromium is not installed")
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        path = Path(folder) / "report.html"
        path.write_text(page, "utf-8")
        # the sandbox of Chromium does not start for root, as in most containers
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        context = browser.new_context(viewport=SCREEN, offline=True, reduced_motion="reduce")
        opened = context.new_page()
        opened.goto(path.as_uri())
        opened.locator(".scrub").fill(INSTANT)
        opened.evaluate("document.activeElement.blur()")
        opened.evaluate("new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))")
        content = opened.screenshot()
        browser.close()
    return Image.open(io.BytesIO(content)).convert("RGB")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("gait", type=Path, metavar="GAIT.nc", help="the paper's case, solved")
    solution = Solution.load(parser.parse_args().gait)
    walk, report = ASSETS / "walk.webp", ASSETS / "report.png"
    walk.write_bytes(film(payloads([solution]), FILM))
    picture = photograph(report_html([solution], human=True))
    picture.save(report, optimize=True)
    for path in (walk, report):
        print(f"wrote {path.relative_to(ROOT)}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
