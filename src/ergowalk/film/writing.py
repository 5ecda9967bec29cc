"""From pictures to the bytes of a film."""

from __future__ import annotations

import io
import math
import tempfile
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image as Pillow

from ergowalk.errors import InputError
from ergowalk.film.options import FilmOptions
from ergowalk.film.pen import Image
from ergowalk.film.scene import Scene


def film(payloads: Sequence[dict[str, Any]], options: FilmOptions) -> bytes:
    """A film of gaits laid over each other, as the content of a file.

    Parameters
    ----------
    payloads : sequence of dict
        Gaits as ``ergowalk.viewer.payloads`` gives them. The time is that of the first; the
        others are shown at the same fraction of their strides.
    options : FilmOptions
        Format, size and time.

    Raises
    ------
    InputError
        If what writes mp4 is not installed, or the film would be too long or have no length.
    """
    pictures = Pictures(payloads, options)
    return _WRITERS[options.format](pictures, options)


class Pictures:
    """The frames of a film by their number, evenly over its strides, so that it closes.

    The instant of a frame is a quarter of its time after its beginning: forces jump when a heel
    lands, at the very beginning and in the middle of a stride, and no frame should show a peak
    that lasts a millisecond.

    Strides that show the very same frames are drawn once, where memory allows.
    """

    def __init__(self, payloads: Sequence[dict[str, Any]], options: FilmOptions) -> None:
        self._count = options.frames(float(payloads[0]["stride_time"]))
        self._strides = options.count
        self._scene = Scene(payloads, options)
        distinct = self._count // math.gcd(self._count, self._strides)
        self._keep = distinct < self._count and options.pixels(distinct) <= MOST_KEPT
        self._kept: dict[int, Image] = {}

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Image]:
        return (self[number] for number in range(self._count))

    def __getitem__(self, number: int) -> Image:
        place = number * self._strides % self._count
        if place in self._kept:
            return self._kept[place]
        picture = self._scene.draw((place + 0.25) / self._count)
        if self._keep:
            self._kept[place] = picture
        return picture


MOST_KEPT = 150e6
"""Pixels of pictures kept to be shown again: three bytes each."""


def _mp4(pictures: Pictures, options: FilmOptions) -> bytes:
    """H.264 in the colours that every player knows, the index in front."""
    try:
        import av
    except ImportError:
        raise InputError(
            "an mp4 needs the package PyAV",
            "install it with: pip install 'ergowalk[film]', or ask for a gif or webp",
            field="format",
            value="mp4",
        ) from None
    # a file, as the index moves to the front when all is written
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.mp4"
        with av.open(path, "w", options={"movflags": "+faststart"}) as container:
            rate = Fraction(options.fps).limit_denominator(1001)
            stream = container.add_stream("libx264", rate=rate, options=_X264)
            stream.width, stream.height, stream.pix_fmt = options.width, options.height, "yuv420p"
            for picture in pictures:
                container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
            container.mux(stream.encode())
        return path.read_bytes()


_X264 = {"crf": "20", "preset": "fast"}
"""Drawings look clean at this quality; slower presets take twice the time for files as large."""


def _gif(pictures: Pictures, options: FilmOptions) -> bytes:
    palette = _palette([pictures[i] for i in range(0, len(pictures), -(-len(pictures) // 6))])
    frames = [
        Pillow.fromarray(picture).quantize(palette=palette, dither=Pillow.Dither.NONE)
        for picture in pictures
    ]
    durations = 10 * np.diff(options.starts(len(frames), 100))  # ms, in steps of 10
    return _animated(frames, "GIF", durations.tolist(), disposal=1, optimize=False)


def _palette(pictures: Sequence[Image]) -> Pillow.Image:
    """A picture whose palette serves all frames: that of some of them, one under the other."""
    sheet = Pillow.fromarray(np.concatenate(pictures))
    return sheet.quantize(256, method=Pillow.Quantize.MEDIANCUT)


def _webp(pictures: Pictures, options: FilmOptions) -> bytes:
    frames = [Pillow.fromarray(picture) for picture in pictures]
    durations = np.diff(options.starts(len(frames), 1000))
    return _animated(frames, "WEBP", durations.tolist(), lossless=True, quality=50, method=1)


def _animated(
    frames: Sequence[Pillow.Image], kind: str, durations: list[int], **choices: Any
) -> bytes:
    content = io.BytesIO()
    first, *rest = frames
    first.save(
        content, kind, save_all=True, append_images=rest, duration=durations, loop=0, **choices
    )
    return content.getvalue()


_WRITERS: dict[str, Callable[[Pictures, FilmOptions], bytes]] = {
    "mp4": _mp4,
    "gif": _gif,
    "webp": _webp,
}
