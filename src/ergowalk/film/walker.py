"""One gait of a film: where everything is at a fraction of the stride, and its drawing."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from ergowalk.errors import InputError
from ergowalk.film.pen import Pen
from ergowalk.plots.cyclogram import INTERVALS
from ergowalk.viewer.looks import looks
from ergowalk.viewer.payload import POINTS

Array = NDArray[np.float64]
Colours = dict[str, str]

_LINE = ("hip", "knee", "ankle", "heel", "metatarsal", "ankle", "metatarsal", "toe_tip")
_JOINT_POINTS = ("hip", "knee", "ankle", "metatarsal")


SHORTEST, LARGEST = 0.01, 100.0
"""Strides and heights of shoulders [m] that fit into a picture with marks on the ground."""


class Walker:
    """A gait as the viewer has it (``gait_payload``), drawn as the viewer draws it.

    ``length`` is the stride length [m], ``ahead`` how far the hip is ahead of a point that goes
    at the mean speed [m], ``top`` the height of the shoulders, ``strongest`` the largest joint
    power [W/kg].

    Raises
    ------
    InputError
        If the gait does not walk forward.
    """

    def __init__(self, payload: dict[str, Any], index: int, colours: Colours) -> None:
        self.payload, self.colours = payload, colours
        self.human = payload.get("kind") == "human"
        self.own = colours["gait-human" if self.human else f"gait-{index % 6}"]
        legs = payload["legs"]
        self._rows: list[dict[str, Array]] = [
            {"hip": _rows(payload["hip"])}
            | {name: _rows(leg[name]) for name in (*POINTS, "reaction", "pressure", "power")}
            for leg in legs
        ]
        self._top = _rows(payload["trunk_top"])
        self.length = float(payload["stride_length"])
        self.top = float(self._top[:, 1].max())
        for what, size in (("goes", self.length), ("stands", self.top)):
            if not SHORTEST <= size <= LARGEST:
                rule = f"{what} {size:g} m far or high; must be {SHORTEST:g} to {LARGEST:g} m"
                raise InputError(rule, "give a gait that walks", field=str(payload["label"]))
        hip = self._rows[0]["hip"][:, 0]
        way = np.linspace(0.0, self.length, len(hip))
        self.ahead = float(np.mean((hip - way)[:-1]))
        powers = np.abs([r["power"] for r in self._rows])
        self.strongest = float(np.nan_to_num(powers).max())

    def camera(self, fraction: float) -> float:
        """Abscissa [m] in the middle of the picture: every walker goes at its mean speed."""
        return fraction * self.length + self.ahead

    def leg(self, number: int, fraction: float) -> dict[str, Any]:
        """Points, reaction, pressure and powers of leg 0 or 1."""
        return {name: between(rows, fraction) for name, rows in self._rows[number].items()}

    def draw(self, pen: Pen, fraction: float, strongest: float) -> None:
        """Draw the whole walker: far leg, trunk and head, near leg, powers."""
        look, paper = looks(), self.colours["paper"]
        near, far = self.leg(0, fraction), self.leg(1, fraction)
        hip, top = near["hip"], between(self._top, fraction)
        up = (top - hip) / np.hypot(*(top - hip))
        self._limbs(pen, far, mixed(self.own, paper, look["shares"]["far_leg"]))
        head, body = top + look["head"]["above"] * up, self.colours["muted"]
        colour = mixed(self.own, body, look["shares"]["trunk"])
        pen.limb(top, head, look["limbs"]["neck"], colour)
        pen.limb(hip, top, look["limbs"]["trunk"], colour)
        pen.disc(head, look["head"]["radius"], colour)
        self._limbs(pen, near, self.own)
        apart = look["hips_apart"] * np.array([up[1], -up[0]])  # both hips are one point
        self._powers(pen, {**far, "hip": hip - apart}, strongest)
        self._powers(pen, {**near, "hip": hip + apart}, strongest)

    def sticks(self, pen: Pen, fraction: float, strongest: float) -> None:
        """Draw lines alone, so that the walker beneath is seen too."""
        pale = mixed(self.own, self.colours["paper"], looks()["shares"]["far_line"])
        lines = self._lines(fraction)
        for line, colour in zip(lines, (pale, self.own, self.own), strict=True):
            pen.stroke(line, self.colours["paper"], 6 * pen.unit)
            pen.stroke(line, colour, 3.5 * pen.unit)
        for number in (0, 1):
            self._powers(pen, self.leg(number, fraction), strongest)

    def trail(self, pen: Pen, fraction: float, strides: int) -> None:
        """Draw the cyclogram of the strides before, in steps of T/22, behind the walker."""
        pale = [mixed(self.own, self.colours["paper"], share) for share in (0.2, 0.2, 0.35)]
        last = int(np.floor(fraction * INTERVALS))
        for step in range(last - strides * INTERVALS, last + 1):
            whole, part = divmod(step, INTERVALS)
            shift = np.array([whole * self.length, 0.0])
            for line, colour in zip(self._cyclogram[part], pale, strict=True):
                pen.stroke(line + shift, colour, 1.2 * pen.unit)

    def reactions(self, pen: Pen, fraction: float) -> None:
        """Draw each reaction as an arrow that begins at the centre of pressure."""
        look = looks()
        for leg in (self.leg(0, fraction), self.leg(1, fraction)):
            force = look["per_weight"] * leg["reaction"]
            length = float(np.hypot(*force))
            if not length >= 0.02 or np.isnan(leg["pressure"]):
                continue
            foot = np.array([float(leg["pressure"]), 0.0])
            back = np.arctan2(*force[::-1]) + np.pi + look["arrow_head"]["turn"] * np.array([1, -1])
            size = min(look["arrow_head"]["length"], length / 2)
            corners = foot + force + size * np.stack([np.cos(back), np.sin(back)], axis=1)
            for colour, width in (("paper", 5), ("arrow", 2.5)):  # an edge to stand out
                pen.stroke([foot, foot + force], self.colours[colour], width * pen.unit)
                head = [corners[0], foot + force, corners[1]]
                pen.stroke(head, self.colours[colour], width * pen.unit)
            pen.disc(foot, 4 * pen.unit / pen.scale, self.colours["arrow"])

    def prints(self, pen: Pen, fraction: float, strides: int) -> None:
        """Draw where the feet stood flat, now and in the strides before."""
        for number, alpha in ((0, 0.8), (1, 0.4)):
            phases = self.payload["legs"][number]["phases"]
            flat = next((phase for phase in phases if phase["name"] == "flat"), None)
            if flat is None:
                continue
            leg = self.leg(number, flat["start"])
            heel, tip = leg["heel"][0], leg["toe_tip"][0]
            for back in range(0 if fraction >= flat["start"] else 1, strides + 1):
                left = heel - back * self.length
                pen.rectangle(left, -0.022, tip - heel, 0.02, self.colours["muted"], alpha)

    @cached_property
    def _cyclogram(self) -> list[tuple[Array, Array, Array]]:
        return [self._lines(step / INTERVALS) for step in range(INTERVALS)]

    def _lines(self, fraction: float) -> tuple[Array, Array, Array]:
        """Far leg, trunk, near leg as lines."""
        near, far = self.leg(0, fraction), self.leg(1, fraction)
        trunk = np.stack([near["hip"], between(self._top, fraction)])
        return np.stack([far[n] for n in _LINE]), trunk, np.stack([near[n] for n in _LINE])

    def _limbs(self, pen: Pen, leg: dict[str, Any], colour: Any) -> None:
        look = looks()
        pen.limb(leg["hip"], leg["knee"], look["limbs"]["thigh"], colour)
        pen.limb(leg["knee"], leg["ankle"], look["limbs"]["shank"], colour)
        pen.limb(leg["metatarsal"], leg["toe_tip"], look["limbs"]["toes"], colour)
        foot = np.stack([leg["heel"], leg["ankle"], leg["metatarsal"]])
        pen.fill(foot, colour)
        pen.stroke(foot, colour, look["foot_edge"] * pen.scale, closed=True)

    def _powers(self, pen: Pen, leg: dict[str, Any], strongest: float) -> None:
        """Joint power as colour and size of a disc; none where it is not known."""
        look = looks()["joint"]
        for name, power in zip(_JOINT_POINTS, leg["power"], strict=True):
            if np.isnan(power):
                continue
            share = np.sqrt(min(1.0, abs(power) / strongest))
            end = self.colours["power-up" if power > 0 else "power-down"]
            radius = look["least"] + look["more"] * share
            pen.disc(leg[name], radius + 0.5 * pen.unit / pen.scale, self.colours["ink"])
            colour = mixed(end, self.colours["power-none"], share)
            pen.disc(leg[name], radius - 0.5 * pen.unit / pen.scale, colour)


def between(rows: Array, fraction: float) -> Array:
    """A row (...) at a stride fraction, linearly between the even frames (n, ...)."""
    place = fraction * (len(rows) - 1)
    i = min(int(place), len(rows) - 2)
    mixed: Array = rows[i] + (place - i) * (rows[i + 1] - rows[i])
    return mixed


def mixed(first: str, second: str, share: float) -> tuple[float, float, float]:
    """A colour of which ``share`` is the first and the rest the second."""
    a, b = (np.array(to_rgb(colour)) for colour in (first, second))
    red, green, blue = share * a + (1 - share) * b
    return float(red), float(green), float(blue)


def _rows(values: Any) -> Array:
    """Frames of the viewer (n, ...), NaN where it has None."""
    return np.array(values, dtype=float)
