"""Runs the commands that README and the tutorial show, and puts what they print into the pages.

``python scripts/readme_figures.py [--folder DIR]``

Blocks ``<!-- output: COMMAND -->`` ... ``<!-- end -->`` get the standard output of the command;
the pictures in docs/assets are those of the first solve. Outputs in DIR are kept and not computed
again, so that an interrupted call can go on. Prints what each command says.
"""

from __future__ import annotations

import argparse
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

from blocks import ROOT, blocks, fenced, pages, publish

ASSETS = ROOT / "docs" / "assets"

PICTURES = {
    "gait/figure_02_cyclogram.png": "cyclogram.png",
    "gait/figure_00_overview.png": "overview.png",
}
"""Figure in the folder of the results, and its name in the documentation."""


def commands() -> list[str]:
    """The commands of all pages, each once, solves first."""
    found = dict.fromkeys(name for page in pages() for name, _ in blocks(page, "output"))
    return sorted(found, key=lambda command: not command.startswith("ergowalk solve"))


def output(command: str, folder: Path) -> str:
    """Standard output of a command run in a folder, or what it was before.

    Raises
    ------
    RuntimeError
        If the command could not use its input.
    """
    kept = folder / f"{'_'.join(shlex.split(command)).replace('/', '_')}.txt"
    if not kept.exists():
        program, *arguments = shlex.split(command)
        assert program == "ergowalk", command
        answer = subprocess.run(
            [sys.executable, "-m", "ergowalk", *arguments],
            cwd=folder, stdout=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
        if answer.returncode not in (0, 1):
            raise RuntimeError(f"{command}: exit status {answer.returncode}")
        kept.write_text(answer.stdout, "utf-8")
    return kept.read_text("utf-8")


def copy_picture(source: Path, target: Path) -> None:
    """A picture in few colours: a third of the size."""
    with Image.open(source) as image:
        image.convert("RGB").quantize(96).save(target, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, help="where results are, or are put and kept")
    folder = parser.parse_args().folder
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) if folder is None else folder
        folder.mkdir(parents=True, exist_ok=True)
        texts = {}
        for command in commands():
            print(f"$ {command}", flush=True)
            text = output(command, folder)
            print(text, flush=True)
            texts[command] = fenced(text)
        for source, target in PICTURES.items():
            copy_picture(folder / source, ASSETS / target)
    publish("output", texts)


if __name__ == "__main__":
    main()
