"""The picture of a film: walkers on the ground, their names, contact phases, what signs mean."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ergowalk.film.options import FilmOptions
from ergowalk.film.pen import Image, Pen, words_width
from ergowalk.film.walker import Walker, mixed
from ergowalk.plots.style import WARNING
from ergowalk.viewer.looks import looks, palette

MARKS = 4
"""Marks on the ground in a stride: it moves, and is as it was when a stride is over."""

MOST_BEHIND = 20
"""Strides whose traces are seen behind the walker, if the picture is so wide."""

_REFUSED = "  not acceptable"
_RED = {False: WARNING, True: "#ff8a80"}  # on light and on dark

_MOST_BARS = 3  # gaits whose contact phases find room


class Scene:
    """Draws any instant of some gaits laid over each other.

    Parameters
    ----------
    payloads : sequence of dict
        Gaits as the viewer has them; the first is drawn whole, the others as lines.
    options : FilmOptions
        Size and colours.
    """

    def __init__(self, payloads: Sequence[dict[str, Any]], options: FilmOptions) -> None:
        self.width, self.height = options.width, options.height
        self.options, self.colours = options, palette(options.dark)
        self.walkers = [Walker(p, i, self.colours) for i, p in enumerate(payloads)]
        self.strongest = max([0.1, *(w.strongest for w in self.walkers)])
        self.pen = Pen(self.width, self.height)
        self.pen.unit = max(min(self.height / 540, self.width / 720), 0.6)
        self.text = 14 * self.pen.unit
        self._layout()
        self._background()

    def draw(self, fraction: float) -> Image:
        """The picture (height, width, 3) at a fraction 0 ... 1 of the stride."""
        pen, (first, *others) = self.pen, self.walkers
        pen.again()
        strides = min(int(self.width / 2 / self.scale / first.length) + 1, MOST_BEHIND)
        if self.options.trail:
            self._place(first, fraction)
            first.trail(pen, fraction, strides)
        self._place(first, fraction)
        first.draw(pen, fraction, self.strongest)
        for walker in others:
            self._place(walker, fraction)
            walker.sticks(pen, fraction, self.strongest)
        self._place(first, fraction)
        self._ground(first, fraction)
        first.prints(pen, fraction, strides)
        for walker in self.walkers:
            self._place(walker, fraction)
            walker.reactions(pen, fraction)
        self._cursor(fraction)
        return pen.image()

    def _layout(self) -> None:
        """Rows of pixels: names at the top, the walk, bars of contact phases, what signs mean."""
        self.row = 1.5 * self.text
        bars = [w for w in self.walkers if w.payload["legs"][0]["phases"]][:_MOST_BARS]
        self.said = self._said()
        self.names = self.row * (0.3 + len(self.said))
        self.bars = bars if self.row * 2 * len(bars) < self.height / 4 else []
        keys = self._keys_width() < self.width - 2 * self.text
        self.keys = self.row if keys else 0.3 * self.row
        self.bottom = self.keys + self.row * (2 * len(self.bars) + 0.3)
        look = looks()
        tall = max(w.top for w in self.walkers) + look["head"]["above"] + look["head"]["radius"]
        tall += look["above"]
        self.scale = (self.height - self.bottom - self.names) / (tall + look["below"])
        self.below = look["below"]

    def _place(self, walker: Walker, fraction: float) -> None:
        x = self.width / 2 - self.scale * walker.camera(fraction)
        self.pen.place(self.scale, x, self.bottom + self.scale * self.below)

    def _background(self) -> None:
        pen, colour = self.pen, self.colours
        pen.place()
        pen.rectangle(0, 0, self.width, self.height, colour["paper"])
        self._names()
        for k, (walker, number) in enumerate((w, n) for w in reversed(self.bars) for n in (1, 0)):
            self._bar(walker, number, self.keys + self.row * (k + 0.3))
        if self.keys >= self.row:
            self._keys()
        ground = self.scale * self.below
        pen.rectangle(0, self.bottom, self.width, ground, colour["ground"])
        pen.rectangle(0, self.bottom + ground - pen.unit, self.width, pen.unit, colour["muted"])
        pen.keep()

    def _said(self) -> list[_Line]:
        """Names of the gaits, what their energy was found under, and the speed of the film."""
        found = []
        for walker in self.walkers:
            mark = "" if walker.payload["acceptable"] else _REFUSED
            room = self.width - 4 * self.text - words_width(mark, self.text)
            label = wrapped(walker.payload["label"], self.text, room)
            found += [_Line(text, self.text, "ink") for text in label]
            found[-len(label)] = _Line(label[0], self.text, "ink", walker.own, mark)
            if under := walker.payload.get("limits"):
                limits = wrapped(f"with {under}", 0.8 * self.text, room)
                found += [_Line(text, 0.8 * self.text, "muted") for text in limits]
        if self.options.speed != 1:
            found.append(_Line(f"speed {self.options.speed:g}", 0.8 * self.text, "muted"))
        most = max(1, int(self.height / 2.5 / self.row))
        if len(found) > most:  # no room for many words; whether a gait is acceptable comes first
            found = [line for line in found if line.colour != "muted"]
        return found[:most]

    def _names(self) -> None:
        pen, y = self.pen, self.height - self.row
        for line in self.said:
            if line.sample:
                sample = (self.text, y + 0.25 * self.text, 2 * self.text, 0.25 * self.text)
                pen.rectangle(*sample, line.sample)
            left = 3.5 * self.text
            left += pen.write(line.text, left, y, line.size, self.colours[line.colour])
            pen.write(line.mark, left, y, self.text, _RED[self.options.dark])
            y -= self.row

    def _ends(self) -> tuple[float, float]:
        """Left and right end of the bars [pixels]."""
        return 4.5 * self.text, self.width - self.text

    def _bar(self, walker: Walker, number: int, y: float) -> None:
        """The contact phases of a leg over the stride."""
        pen, colours, size = self.pen, self.colours, 0.8 * self.text
        left, right = self._ends()
        height, base = 0.86 * self.row, y + 0.3 * self.row
        own = mixed(walker.own, colours["paper"], 1.0 if number == 0 else 0.45)
        pen.rectangle(self.text, y, 0.3 * self.text, height, own)
        pen.write(f"leg {number + 1}", 1.6 * self.text, base, size, colours["ink"])
        pale = mixed(colours["phase"], colours["paper"], 0.22)
        for phase in walker.payload["legs"][number]["phases"]:
            start, end = (left + phase[k] * (right - left) for k in ("start", "end"))
            flat, swing = phase["name"] == "flat", phase["name"] == "swing"
            fill = colours["phase"] if flat else colours["paper"] if swing else pale
            ink = colours["paper"] if flat else colours["muted"] if swing else colours["ink"]
            pen.rectangle(start, y, end - start, height, fill)
            pen.rectangle(start, y, pen.unit, height, colours["paper"])
            if words_width(phase["name"], size) < end - start - 2 * pen.unit:
                pen.write(phase["name"], (start + end) / 2, base, size, ink, 0.5)
        frame = [(left, y), (right, y), (right, y + height), (left, y + height)]
        pen.stroke(frame, colours["line"], pen.unit, closed=True)

    def _cursor(self, fraction: float) -> None:
        if not self.bars:
            return
        self.pen.place()
        left, right = self._ends()
        x, bottom = left + fraction % 1.0 * (right - left), self.keys + 0.3 * self.row
        top = self.row * (2 * len(self.bars) - 0.14)
        self.pen.rectangle(x - self.pen.unit, bottom, 2 * self.pen.unit, top, self.colours["ink"])

    _KEYS = ("reaction of the ground", "joint power: into the walker", "taken up", "none")

    def _keys_width(self) -> float:
        return sum(words_width(t, 0.8 * self.text) + 2.6 * self.text for t in self._KEYS)

    def _keys(self) -> None:
        """One line on what arrows and discs mean."""
        pen, size, x, y = self.pen, 0.8 * self.text, self.text, 0.5 * self.row
        radius = 0.4 * self.text
        for text, name in zip(
            self._KEYS, ("arrow", "power-up", "power-down", "power-none"), strict=True
        ):
            middle, colour = y + 0.28 * self.text, self.colours[name]
            if name == "arrow":
                tip = (x + 1.2 * self.text, middle)
                pen.stroke([(x, middle), tip], colour, 2.5 * pen.unit)
                back = [(tip[0] - radius, middle + k * radius) for k in (0.6, -0.6)]
                pen.stroke([back[0], tip, back[1]], colour, 2.5 * pen.unit)
            else:
                centre = np.array([x + 0.8 * self.text, middle])
                pen.disc(centre, radius + 0.5 * pen.unit, self.colours["ink"])
                pen.disc(centre, radius - 0.5 * pen.unit, colour)
            x += 1.6 * self.text
            x += pen.write(text, x, y, size, self.colours["ink"]) + self.text

    def _ground(self, first: Walker, fraction: float) -> None:
        """Marks on the ground, and how long half a metre is."""
        pen, half = self.pen, self.width / self.scale / 2
        step, middle = first.length / MARKS, first.camera(fraction)
        low, high = int((middle - half) // step), int((middle + half) // step) + 1
        thick = 1.5 * pen.unit / self.scale
        for k in range(low, high + 1) if high - low < 2 * MARKS * MOST_BEHIND else ():
            pen.rectangle(k * step, -0.05, thick, 0.05, self.colours["muted"])
        left = middle - half + 2 * self.text / self.scale
        for x, width, height in (
            (left, 0.5, thick),
            (left, thick, 0.03),
            (left + 0.5, thick, 0.03),
        ):
            pen.rectangle(x, -0.13, width, height, self.colours["ink"])
        pen.write("0.5 m", left + 0.54, -0.13, 0.8 * self.text, self.colours["ink"])


@dataclass(frozen=True)
class _Line:
    """Words at the top: size [pixels], colour, a sample of the gait's colour, a mark."""

    text: str
    size: float
    colour: str
    sample: str = ""
    mark: str = ""


def wrapped(text: str, size: float, room: float) -> list[str]:
    """Words in lines that fit into some pixels, at least one; a longer word is cut."""
    lines = [""]
    for word in text.split()[:_MOST_WORDS]:
        longer = f"{lines[-1]} {word}".strip()
        if words_width(longer, size) <= room:
            lines[-1] = longer
        else:
            lines += [shortened(word, size, room)]
    return [line for line in lines if line] or [""]


_MOST_WORDS = 60


def shortened(text: str, size: float, room: float) -> str:
    """Words that fit into some pixels, with dots where some were left out."""
    text = " ".join(text.split())[: 2 + int(4 * room / size)]  # letters are wider than a quarter
    if words_width(text, size) <= room:
        return text
    lengths = range(len(text))
    fits = bisect_left(lengths, True, key=lambda n: words_width(text[:n] + "…", size) > room)
    return text[: max(fits - 1, 0)] + "…"
