"""A pen on a picture of pixels: filled outlines, lines and words, in any plane."""

from __future__ import annotations

import warnings
from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_rgba
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import TextPath
from matplotlib.transforms import Affine2D, Bbox
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Image = NDArray[np.uint8]


class Pen:
    """Draws on a picture of ``width`` x ``height`` pixels.

    Lengths are in the unit of the plane: pixels from the lower left corner until :meth:`place`
    says otherwise. Colours are "#rrggbb" or triples of 0 ... 1.
    """

    def __init__(self, width: int, height: int) -> None:
        self.unit = 1.0  # pixels of a thin line
        self._renderer: Any = RendererAgg(width, height, 72)  # type: ignore[no-untyped-call]
        self._whole = Bbox.from_bounds(0, 0, width, height)
        self._box: Any = None
        self.place()

    def place(self, scale: float = 1.0, x: float = 0.0, y: float = 0.0) -> None:
        """Let the plane's origin lie at a pixel, with ``scale`` pixels to its unit."""
        self.scale = scale
        self._transform = Affine2D().scale(scale).translate(x, y)

    def fill(self, outline: ArrayLike, colour: Any, alpha: float = 1.0) -> None:
        """Fill a polygon (n, 2)."""
        self._draw(Path(np.asarray(outline, dtype=float), closed=False), colour, alpha)

    def stroke(self, line: ArrayLike, colour: Any, pixels: float, closed: bool = False) -> None:
        """Draw a line (n, 2) with round ends and corners."""
        points = np.asarray(line, dtype=float)
        if closed:
            points = np.vstack([points, points[:1]])
        gc = self._renderer.new_gc()
        gc.set_linewidth(pixels)
        gc.set_foreground(to_rgba(colour), isRGBA=True)
        gc.set_capstyle("round")
        gc.set_joinstyle("round")
        self._renderer.draw_path(gc, Path(points, closed=closed), self._transform, None)

    def rectangle(
        self, x: float, y: float, width: float, height: float, colour: Any, alpha: float = 1.0
    ) -> None:
        """Fill a rectangle from its lower left corner."""
        right, top = x + width, y + height
        self.fill([(x, y), (right, y), (right, top), (x, top)], colour, alpha)

    def disc(self, centre: Array, radius: float, colour: Any) -> None:
        """Fill a circle."""
        self.fill(centre + radius * _CIRCLE, colour)

    def limb(self, p: Array, q: Array, radii: tuple[float, float], colour: Any) -> None:
        """Fill a limb between two points, of the first radius at one, the second at the other."""
        back = _half(np.arctan2(*(q - p)[::-1]) + np.pi / 2)
        self.fill(np.concatenate([p + radii[0] * back, q - radii[1] * back]), colour)

    def write(
        self, text: str, x: float, y: float, size: float, colour: Any, align: float = 0.0
    ) -> float:
        """Write words from a baseline point and return their width [pixels].

        ``align`` is the share of the words that stands left of the point.
        """
        if not text.strip():
            return 0.0
        path, width = _words(text, size), words_width(text, size)
        left, base = self._transform.transform((x, y))
        self._draw(path, colour, 1.0, Affine2D().translate(left - align * width, base))
        return width

    def keep(self) -> None:
        """Remember the picture as the ground of every frame."""
        self._box = self._renderer.copy_from_bbox(self._whole)

    def again(self) -> None:
        """Put the remembered picture back."""
        self._renderer.restore_region(self._box)

    def image(self) -> Image:
        """The picture as (height, width, 3) bytes."""
        return np.asarray(self._renderer.buffer_rgba())[:, :, :3].copy()

    def _draw(self, path: Path, colour: Any, alpha: float, transform: Any = None) -> None:
        gc = self._renderer.new_gc()
        gc.set_linewidth(0.0)
        place = self._transform if transform is None else transform
        self._renderer.draw_path(gc, path, place, to_rgba(colour, alpha))


@lru_cache(maxsize=256)
def words_width(text: str, size: float) -> float:
    """Width of words [pixels]."""
    return float(max(_words(text, size).get_extents().x1, 0.0)) if text.strip() else 0.0


@lru_cache(maxsize=256)
def _words(text: str, size: float) -> TextPath:
    plain = text.replace("$", r"\$")  # a name is no formula
    # the font that comes with matplotlib, whatever the user's settings say
    font = FontProperties(family="DejaVu Sans")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a sign that the font lacks, a box is shown
        return TextPath((0.0, 0.0), plain, size=size, prop=font)


_ARC = np.linspace(0.0, np.pi, 12)


def _half(start: float) -> Array:
    """Unit vectors (n, 2) of half a circle that begins at an angle [rad]."""
    return np.stack([np.cos(start + _ARC), np.sin(start + _ARC)], axis=1)


_CIRCLE = np.concatenate([_half(0.0), _half(np.pi)])
