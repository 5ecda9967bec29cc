"""The figures as pages and as files."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from itertools import combinations
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from ergowalk.corridors import HumanGait, human_gait
from ergowalk.errors import CorridorError, GaitFileError, OutputError
from ergowalk.plots import FIGURES, figures, write_figures

from .synthetic import gait

HUMAN = human_gait("winter-natural")
NAMES = [
    "figure_00_overview",
    "figure_02_cyclogram",
    "figure_03_hip_angle",
    "figure_04_knee_angle",
    "figure_05_ankle_angle",
    "figure_06_horizontal_reaction",
    "figure_07_vertical_reaction",
    "figure_08_hip_moment",
    "figure_09_knee_moment",
    "figure_10_ankle_moment",
]


@pytest.fixture(scope="module")
def pages() -> dict[str, Figure]:
    return figures(gait(), HUMAN)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("figures") / "new" / "folder"
    assert len(write_figures(gait(), folder)) == 20
    return folder


def texts(figure: Figure) -> list[Text]:
    return [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip()]


def beyond_the_axes(figure: Figure) -> set[int]:
    """Labels of ticks outside the view, which exist but are not drawn."""
    found = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = axis.get_view_interval()
            ticks = [t for t in axis.get_major_ticks() if not low <= t.get_loc() <= high]
            found |= {id(label) for t in ticks for label in (t.label1, t.label2)}
    return found


def overlapping(figure: Figure) -> list[tuple[str, str]]:
    """Pairs of texts on a page whose boxes cross by more than a pixel, or leave the page."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    width, height = canvas.get_width_height()
    hidden = beyond_the_axes(figure)
    shown = [t for t in texts(figure) if id(t) not in hidden]
    boxes = [(t.get_text(), t.get_window_extent(renderer)) for t in shown]
    boxes = [(text, box) for text, box in boxes if box.width > 0]
    found = [
        (a, b)
        for (a, first), (b, second) in combinations(boxes, 2)
        if min(first.x1, second.x1) - max(first.x0, second.x0) > 1
        and min(first.y1, second.y1) - max(first.y0, second.y0) > 1
    ]
    outside = [
        (text, "the page")
        for text, box in boxes
        if box.x0 < 0 or box.y0 < 0 or box.x1 > width or box.y1 > height
    ]
    return found + outside


def test_there_is_a_page_for_each_figure_of_the_paper(pages):
    assert list(pages) == list(FIGURES) == NAMES


def test_the_overview_states_the_energy_with_its_limits(pages):
    words = " ".join(" ".join(t.get_text() for t in texts(pages["figure_00_overview"])).split())
    assert "E = 100.0 J/m with R_y <= 1.3 body weights, |R_x| <= 0.6 R_y, moment rate" in words


@pytest.mark.parametrize("name", NAMES)
def test_no_two_labels_overlap(pages, name):
    assert overlapping(pages[name]) == []


def test_labels_of_very_short_phases_do_not_overlap():
    dataset = gait()
    s = dataset.time.values / dataset.time.values[-1]
    ends = np.array([0.02, 0.03, 0.5, 0.51])
    dataset["contact_phase"][:, 0] = np.array([1, 2, 3, 4, 0])[np.searchsorted(ends, s)]
    short = figures(dataset, HUMAN)
    assert overlapping(short["figure_00_overview"]) == []
    assert overlapping(short["figure_10_ankle_moment"]) == []


def test_wide_corridors_many_limits_and_long_names_find_room():
    dataset = gait()
    dataset.attrs["limits"] += ", moment <= 2.5 N m/kg at hip, knee, ankle, moment-rate cost 0.01"
    dataset["corridor_lower"] -= 0.2
    dataset["corridor_upper"] += 0.2
    long_name = HumanGait("a/folder/" + "a-very-long-name-of-human-data" * 3 + ".csv", HUMAN.curves)
    wide = figures(dataset, long_name)
    for name in ("figure_00_overview", "figure_05_ankle_angle"):
        assert overlapping(wide[name]) == []
        assert "corridor" in [t.get_text() for t in texts(wide[name])]


def test_every_page_of_a_gait_that_failed_says_so(pages):
    dataset = gait()
    dataset.attrs["acceptable"] = 0
    for name, figure in figures(dataset, HUMAN).items():
        assert "not an acceptable gait" in [t.get_text() for t in texts(figure)]
        assert "not an acceptable gait" not in [t.get_text() for t in texts(pages[name])]
        assert overlapping(figure) == []


def test_human_data_with_angles_only_still_make_all_pages():
    curves = {n: c for n, c in HUMAN.curves.items() if n.endswith("angle")}
    alone = figures(gait(), HumanGait("angles.csv", curves))
    assert list(alone) == NAMES
    assert overlapping(alone["figure_00_overview"]) == []


def test_drawing_leaves_the_settings_of_matplotlib_alone():
    with matplotlib.rc_context({"font.size": 23.0, "axes.grid": True}):
        before = dict(matplotlib.rcParams)
        page = figures(gait(), HUMAN)["figure_03_hip_angle"]
        assert dict(matplotlib.rcParams) == before
    title = page.axes[0].get_title(loc="left")
    assert title == "Hip angle of leg 1, L = 0.76 m, T = 1.14 s"
    assert page.axes[0].yaxis.label.get_fontsize() == 9.0


def test_all_files_are_there_and_nothing_else(folder):
    expected = sorted(f"{name}.{kind}" for name in NAMES for kind in ("png", "svg"))
    assert sorted(path.name for path in folder.iterdir()) == expected


def test_pictures_are_png_of_150_dots_per_inch(folder):
    content = (folder / "figure_03_hip_angle.png").read_bytes()
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    assert int.from_bytes(content[16:20], "big") == int(6.6 * 150)
    assert int.from_bytes(content[20:24], "big") == int(4.2 * 150)


def test_drawings_are_svg_whose_text_is_text(folder):
    root = ElementTree.parse(folder / "figure_08_hip_moment.svg").getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    words = " ".join("".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text"))
    label, mean = "hip moment q/M [N m/kg], flexion +", "human mean (winter-natural)"
    for word in (label, mean, "forefoot"):
        assert word in words
    assert "matplotlib.org" not in (folder / "figure_08_hip_moment.svg").read_text("utf-8")[:500]


def test_the_same_gait_makes_the_same_bytes(folder, tmp_path):
    write_figures(gait(), tmp_path)
    for path in sorted(folder.iterdir()):
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path.name


def test_only_the_formats_asked_for_are_written(tmp_path):
    paths = write_figures(gait(), tmp_path, formats=["svg"], human=HUMAN)
    assert paths == [tmp_path / f"{name}.svg" for name in NAMES]
    assert sorted(tmp_path.iterdir()) == paths


def test_an_interrupted_write_leaves_the_old_picture(tmp_path, monkeypatch):
    old = tmp_path / "figure_00_overview.png"
    old.write_text("old")

    def half(self, path, **options):
        Path(path).write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Figure, "savefig", half)
    with pytest.raises(OutputError, match=r"figure_00_overview.png: cannot be written \(No space"):
        write_figures(gait(), tmp_path)
    assert old.read_text() == "old"
    assert list(tmp_path.iterdir()) == [old]


def test_an_unknown_format_is_refused_before_anything_is_drawn(tmp_path):
    with pytest.raises(OutputError, match="format = 'gif': no such picture format; choose png"):
        write_figures(gait(), tmp_path, formats=("png", "gif"))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"cannot be made .*choose another folder"):
        write_figures(gait(), tmp_path / "file" / "figures")


def test_gaits_that_cannot_be_drawn_are_refused(tmp_path):
    broken = gait()
    broken["segment_angle"][3, 0, 0] = np.nan
    with pytest.raises(GaitFileError, match="segment_angle: must be finite"):
        figures(broken, HUMAN)
    nameless = gait()
    del nameless.attrs["step_length"]
    with pytest.raises(GaitFileError, match="attribute step_length: must be there as a number"):
        figures(nameless, HUMAN)
    lost = gait()
    lost.attrs["problem"] = '[corridors]\nsource = "lost.csv"'
    with pytest.raises(CorridorError, match=r"lost.csv.*cannot be read"):
        write_figures(lost, tmp_path)
