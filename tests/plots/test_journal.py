"""Figures for a journal: as wide as a column, text that is text, fonts inside, colours apart."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D

from ergowalk.corridors import human_gait
from ergowalk.plots import JOURNAL, figures, style, write_figures
from ergowalk.plots.pages import names_on

from .synthetic import gait
from .test_pages import overlapping, texts

pypdf = pytest.importorskip("pypdf", reason="pypdf is not installed")

HUMAN = human_gait("winter-natural")
WIDTHS = {"single": 88.0, "double": 180.0}  # mm
SMALLEST = 6.5  # pt: journals ask for 6 to 7 and more
WORDS = {
    "figure_02_cyclogram": "distance x [m]",
    "figure_06_horizontal_reaction": "Rx/M [N/kg], forward +",
    "figure_10_ankle_moment": "human mean (winter-natural)",
}


@pytest.fixture(scope="module", params=list(JOURNAL))
def column(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def folder(column: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp(column)
    paths = write_figures(gait(), folder, style.PRINTED, HUMAN, JOURNAL[column])
    assert len(paths) == 18
    return folder


@pytest.fixture(scope="module")
def pages(column: str) -> dict[str, Any]:
    return figures(gait(), HUMAN, JOURNAL[column])


def test_there_are_figures_2_to_10_and_no_overview(folder: Path, column: str) -> None:
    numbers = [name.split("_")[1] for name in names_on(JOURNAL[column])]
    assert numbers == [f"{k:02}" for k in range(2, 11)]
    assert {p.suffix for p in folder.iterdir()} == {".pdf", ".svg"}


def test_pages_are_as_wide_as_the_column(folder: Path, column: str) -> None:
    for path in folder.glob("*.pdf"):
        (page,) = pypdf.PdfReader(path).pages
        assert float(page.mediabox.width) / 72 * 25.4 == pytest.approx(WIDTHS[column], abs=0.01)
    for path in folder.glob("*.svg"):
        width = ElementTree.parse(path).getroot().attrib["width"]
        assert width.endswith("pt")
        assert float(width[:-2]) / 72 * 25.4 == pytest.approx(WIDTHS[column], abs=0.01)


@pytest.mark.parametrize("name", WORDS)
def test_text_is_text_in_both_formats(folder: Path, name: str) -> None:
    told = pypdf.PdfReader(folder / f"{name}.pdf").pages[0].extract_text()
    assert WORDS[name] in " ".join(told.split())
    root = ElementTree.parse(folder / f"{name}.svg").getroot()
    words = ["".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text")]
    assert any(WORDS[name] in word for word in words)


def test_every_font_is_embedded_as_outlines(folder: Path) -> None:
    for path in folder.glob("*.pdf"):
        resources = pypdf.PdfReader(path).pages[0]["/Resources"]
        fonts = [font.get_object() for font in resources["/Font"].values()]
        assert fonts
        for font in fonts:
            assert font["/Subtype"] in ("/Type0", "/TrueType")  # not /Type3, which is drawings
            whole = [font, *(f.get_object() for f in font.get("/DescendantFonts", []))]
            assert any("/FontFile2" in f.get("/FontDescriptor", {}) for f in whole)
        assert "/XObject" not in resources or not any(
            image.get_object().get("/Subtype") == "/Image"
            for image in resources["/XObject"].values()
        )


def test_words_can_be_read_and_stand_apart(pages: dict[str, Any]) -> None:
    for name, figure in pages.items():
        assert overlapping(figure) == [], name
        assert min(text.get_fontsize() for text in texts(figure)) >= SMALLEST - 0.11, name
        assert min(line.get_linewidth() for line in figure.findobj(Line2D)) >= 0.5, name


def test_a_gait_that_failed_says_so_where_there_is_room(column: str) -> None:
    dataset = gait()
    dataset.attrs["acceptable"] = 0
    for name, figure in figures(dataset, HUMAN, JOURNAL[column]).items():
        assert "not an acceptable gait" in [t.get_text() for t in texts(figure)]
        assert overlapping(figure) == [], name


def test_the_caption_says_what_a_title_says_on_a_screen(pages: dict[str, Any]) -> None:
    titles = {axes.get_title(loc="left") for figure in pages.values() for axes in figure.axes}
    assert titles == {""}


def test_the_same_gait_makes_the_same_bytes(folder: Path, column: str, tmp_path: Path) -> None:
    write_figures(gait(), tmp_path, style.PRINTED, HUMAN, JOURNAL[column])
    for path in sorted(folder.iterdir()):
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path.name


# Linear sRGB as seen without one kind of cones, severity 1: Machado, Oliveira, Fernandes (2009),
# "A physiologically-based model for simulation of color vision deficiency", table of matrices.
VISION = {
    "all cones": np.eye(3),
    "no long": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "no middle": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "no short": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
TOGETHER = {
    "cyclogram": (style.LEG_1, style.LEG_2, style.TRUNK),
    "curve": (style.GAIT, style.HUMAN, style.CORRIDOR, style.BAND),
}


@pytest.mark.parametrize("vision", VISION)
@pytest.mark.parametrize("kind", TOGETHER)
def test_colours_are_told_apart_with_any_cones(kind: str, vision: str) -> None:
    for one, two in combinations(TOGETHER[kind], 2):
        # 2.3 is just noticeable side by side; lines apart from each other need several times that
        assert distance(one, two, np.array(VISION[vision])) > 12, (one, two)


@pytest.mark.parametrize("colour", [style.LEG_1, style.LEG_2, style.TRUNK, style.HUMAN])
def test_lines_stand_out_from_the_paper(colour: str) -> None:
    light = linear(colour) @ [0.2126, 0.7152, 0.0722]
    assert 1.05 / (light + 0.05) >= 3.0  # contrast that WCAG 2 asks of graphics


def linear(colour: str) -> np.ndarray:
    value = np.array(to_rgb(colour))
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def distance(one: str, two: str, cones: np.ndarray) -> float:
    """Distance of two colours in CIE L*a*b* (1976)."""
    a, b = (lab(np.clip(cones @ linear(c), 0, 1)) for c in (one, two))
    return float(np.linalg.norm(a - b))


def lab(rgb: np.ndarray) -> np.ndarray:
    xyz = (
        np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
        @ rgb
        / [0.9505, 1.0, 1.089]
    )
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])
