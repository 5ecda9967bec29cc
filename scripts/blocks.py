"""Blocks of a page that a script fills: ``<!-- KIND: NAME -->`` ... ``<!-- end -->``."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

_BLOCK = re.compile(r"<!-- (?P<kind>[a-z]+): (?P<name>.+?) -->\n(?P<text>.*?)<!-- end -->", re.S)


def pages() -> list[Path]:
    """README and every page of the documentation."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks(page: Path, kind: str) -> Iterator[tuple[str, str]]:
    """Name and present text of every block of a kind, in the order of the page."""
    for match in _BLOCK.finditer(page.read_text("utf-8")):
        if match["kind"] == kind:
            yield match["name"], match["text"]


def fill(page: Path, kind: str, texts: dict[str, str]) -> bool:
    """Put texts into the blocks of their names; whether the page changed."""
    old = page.read_text("utf-8")

    def filled(match: re.Match[str]) -> str:
        if match["kind"] != kind or match["name"] not in texts:
            return match[0]
        text = texts[match["name"]].rstrip("\n")
        return f"<!-- {kind}: {match['name']} -->\n{text}\n<!-- end -->"

    new = _BLOCK.sub(filled, old)
    if new != old:
        page.write_text(new, "utf-8")
    return new != old


def fenced(text: str, language: str = "text") -> str:
    """A code block."""
    return f"```{language}\n{text.rstrip()}\n```"


def table(header: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table in Markdown."""
    lines = [header, tuple("---" for _ in header), *rows]
    cells = (" | ".join(cell.replace("|", "\\|") for cell in line) for line in lines)
    return "\n".join(f"| {line} |" for line in cells)


def publish(kind: str, texts: dict[str, str]) -> None:
    """Put texts into the blocks of their names on every page that has them, and say where."""
    for page in pages():
        if fill(page, kind, texts):
            print(f"wrote {page.relative_to(ROOT)}")


def write_studies(studies: Mapping[str, Callable[[], str]], names: Iterable[str] = ()) -> None:
    """Print the named studies, or all, and put each into the pages that ask for it."""
    for name in list(names) or studies:
        text = studies[name]()
        print(f"{name}\n{text}", flush=True)
        publish("study", {name: text})
