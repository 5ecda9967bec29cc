"""Films last as long as the strides, close, and show what moves."""

from __future__ import annotations

import importlib.util
import io
import re
import sys
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from ergowalk.errors import InputError
from ergowalk.film import FilmOptions, film
from ergowalk.film.options import MOST_FRAMES
from ergowalk.film.scene import Scene
from ergowalk.film.writing import Pictures
from ergowalk.solution import Solution
from ergowalk.viewer import payloads

from .readers import measured

with_av = pytest.mark.skipif(importlib.util.find_spec("av") is None, reason="PyAV is not installed")
FORMATS = [pytest.param("mp4", marks=with_av), "gif", "webp"]
SMALL = {"width": 240, "height": 160}


@pytest.fixture(scope="module")
def gaits(paper_gait: xr.Dataset) -> list[dict[str, Any]]:
    return payloads([Solution(paper_gait)], human=True)


def options(kind: str, **changes: Any) -> FilmOptions:
    return FilmOptions(**{"format": kind, "fps": 20.0, "strides": 1, **SMALL, **changes})


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize(("strides", "fps"), [(1, 20.0), (2, 30.0), (1, 12.5)])
def test_a_film_is_as_long_and_large_as_asked(gaits: Any, kind: str, strides: int, fps: float):
    asked = options(kind, strides=strides, fps=fps)
    found = measured(film(gaits, asked))
    assert (found.width, found.height) == (240, 160)
    time = strides * gaits[0]["stride_time"]
    assert len(found.delays) == asked.frames(gaits[0]["stride_time"]) == round(time * fps)
    # half a frame, by which a whole number of frames misses the strides, and a tick of the format
    assert float(found.duration) == pytest.approx(time, abs=0.5 / fps + 0.01)
    assert float(found.duration) == pytest.approx(len(found.delays) / fps, abs=0.01)
    assert found.endless == (kind != "mp4")


def test_a_gif_whose_frames_are_no_whole_ticks_keeps_its_time(gaits: Any) -> None:
    found = measured(film(gaits, options("gif", fps=30.0)))
    assert set(found.delays) == {Fraction(3, 100), Fraction(4, 100)}


@pytest.mark.parametrize("kind", FORMATS)
def test_every_frame_differs_from_the_one_before(gaits: Any, kind: str) -> None:
    pictures = decoded(film(gaits, options(kind)), kind)
    assert len(pictures) == round(20 * gaits[0]["stride_time"])
    for i, picture in enumerate(pictures):
        moved = np.abs(picture.astype(int) - pictures[i - 1]).max(axis=2) > 60
        assert 0.002 < moved.mean() < 0.4, i  # the last one before the first too


def decoded(content: bytes, kind: str) -> list[np.ndarray]:
    """The pictures of a film."""
    if kind == "mp4":
        import av

        with av.open(io.BytesIO(content)) as container:
            return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    with Image.open(io.BytesIO(content)) as image:
        pictures = []
        for i in range(image.n_frames):
            image.seek(i)
            pictures.append(np.asarray(image.convert("RGB")))
        return pictures


@pytest.mark.parametrize("kind", FORMATS)
def test_what_is_decoded_is_what_was_drawn(gaits: Any, kind: str) -> None:
    asked = options(kind)
    drawn = list(Pictures(gaits, asked))
    tolerance = {"webp": 0.0, "gif": 3.0, "mp4": 4.0}[kind]  # of 255: palette; half the colours
    for picture, wanted in zip(decoded(film(gaits, asked), kind), drawn, strict=True):
        assert np.abs(picture.astype(int) - wanted).mean() <= tolerance


def test_the_stride_closes(gaits: Any) -> None:
    # forces and powers jump when a heel lands: they are left out here
    unloaded = [{**leg, "pressure": [None] * 301} for leg in gaits[0]["legs"]]
    idle = [{**leg, "power": [[0.0] * 4] * 301} for leg in unloaded]
    scene = Scene([{**gaits[0], "legs": idle}], options("webp"))

    def off(a: float, b: float) -> float:
        walk = int(160 - scene.bottom)  # above the bars, whose cursor goes from end to end
        return float(np.abs(scene.draw(a).astype(int) - scene.draw(b))[:walk].mean())

    step = off(0.5, 0.52)
    assert off(0.0, 1.0 - 1e-6) < 0.01 * step
    assert off(0.25, 0.25 + 1e-6) < 0.01 * step


def test_all_strides_of_a_film_are_the_same_where_the_frames_are(gaits: Any) -> None:
    time = float(gaits[0]["stride_time"])
    pictures = Pictures(gaits, options("webp", strides=3, fps=10 / time))
    assert len(pictures) == 30
    assert pictures[0] is pictures[10] is pictures[20]
    assert not np.array_equal(pictures[0], pictures[5])


def test_half_a_stride_later_the_legs_have_changed_sides(gaits: Any) -> None:
    walker = Scene(gaits, options("webp")).walkers[0]
    for name in ("knee", "ankle", "toe_tip", "reaction", "power"):
        now, later = walker.leg(0, 0.2)[name], walker.leg(1, 0.7)[name]
        shift = [walker.length / 2, 0.0] if name in ("knee", "ankle", "toe_tip") else 0.0
        assert later - shift == pytest.approx(now, abs=2e-3), name


@pytest.mark.parametrize("changes", [{"dark": True}, {"trail": True}, {"speed": 0.5}])
def test_choices_change_the_picture(gaits: Any, changes: dict[str, Any]) -> None:
    plain = Scene(gaits, options("webp")).draw(0.3)
    assert not np.array_equal(Scene(gaits, options("webp", **changes)).draw(0.3), plain)


def test_the_second_gait_and_the_human_walker_are_seen(gaits: Any) -> None:
    alone = Scene(gaits[:1], options("webp")).draw(0.3)
    assert not np.array_equal(Scene(gaits, options("webp")).draw(0.3), alone)


def test_slow_motion_lasts_longer(gaits: Any) -> None:
    slow = measured(film(gaits[:1], options("gif", speed=0.5)))
    assert float(slow.duration) == pytest.approx(2 * gaits[0]["stride_time"], abs=0.06)


def test_hostile_names_stay_words(gaits: Any) -> None:
    for label in (r"$\frac{1}$", "名前 \U0001f6b6", "x" * 5000, ""):
        named = [{**gaits[0], "label": label}]
        assert Scene(named, options("webp")).draw(0.0).shape == (160, 240, 3)


def test_energy_stands_with_its_limits_and_a_refused_gait_is_marked(gaits: Any) -> None:
    refused = {**gaits[0], "acceptable": False}
    for width, height in ((960, 540), (400, 600), (560, 404)):
        said = Scene([gaits[0], refused], options("webp", width=width, height=height)).said
        words = " ".join(line.text for line in said)
        assert words.count(f"with {gaits[0]['limits']}") == 2
        assert [line.mark.strip() for line in said if line.sample] == ["", "not acceptable"]


def test_marks_stay_where_there_is_no_room_for_limits(gaits: Any) -> None:
    said = Scene([{**gaits[0], "acceptable": False}] * 3, options("webp")).said
    assert sum(bool(line.mark) for line in said) == 3


@pytest.mark.parametrize("size", [(160, 120), (400, 120), (160, 640), (1920, 1080)])
def test_every_size_can_be_drawn(gaits: Any, size: tuple[int, int]) -> None:
    width, height = size
    picture = Scene(gaits, options("webp", width=width, height=height)).draw(0.1)
    assert picture.shape == (height, width, 3)
    assert len(np.unique(picture[:, :, 0])) > 20


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"format": "avi"}, "format = 'avi': no such film format; choose mp4, gif, webp"),
        ({"format": "mp4", "width": 241}, "width = 241: must be even in an mp4"),
        ({"width": 10}, "width = 10: should be greater than or equal to 160"),
        ({"height": 10_000}, "height = 10000: should be less than or equal to 2160"),
        ({"fps": float("nan")}, "fps = nan"),
        ({"fps": 60.0}, "fps = 60.0: must be at most 50 in a gif"),
        ({"strides": 0}, "strides = 0: should be greater"),
        ({"speed": 0.0}, "speed = 0.0: should be greater"),
    ],
)
def test_what_no_film_can_be_is_refused(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=re.escape(told)):
        FilmOptions(**{"format": "gif", **changes})


def test_films_too_long_for_anyone_are_refused() -> None:
    with pytest.raises(InputError, match=f"must be 2 to {MOST_FRAMES}"):
        FilmOptions(format="mp4", strides=100, speed=0.1).frames(1.0)
    with pytest.raises(InputError, match="makes a film of 0 frames"):
        FilmOptions(format="gif", fps=1.0).frames(0.2)
    with pytest.raises(InputError, match=r"5000 frames of 960x540, more than memory should hold"):
        FilmOptions(format="webp", strides=100).frames(1.0)


def test_a_walker_that_does_not_walk_is_refused(gaits: Any) -> None:
    with pytest.raises(InputError, match="goes 0 m far or high; must be 0.01 to 100 m"):
        film([{**gaits[0], "stride_length": 0.0}], options("gif"))
    with pytest.raises(InputError, match=r"stands 1e\+300 m far or high"):
        film([{**gaits[0], "trunk_top": [[0.0, 1e300]] * 301}], options("gif"))


@pytest.mark.parametrize("force", [1e3, 1e9, 1e300])
def test_absurd_forces_do_not_stop_a_film(gaits: Any, force: float) -> None:
    legs = [{**leg, "reaction": [[force, -force]] * 301} for leg in gaits[0]["legs"]]
    absurd = [{**leg, "power": [[force] * 4] * 301} for leg in legs]
    assert Scene([{**gaits[0], "legs": absurd}], options("webp")).draw(0.1).max() == 255


def test_without_pyav_an_mp4_says_what_to_install(gaits: Any, monkeypatch: Any) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(
        InputError, match=r"needs the package PyAV; .*pip install 'ergowalk\[film\]'"
    ):
        film(gaits, options("mp4"))
