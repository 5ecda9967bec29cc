"""Where a figure will be seen: on a screen, or in one or two columns of a journal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

MM = 1 / 25.4
"""A millimetre in inches."""


@dataclass(frozen=True)
class Hand:
    """How a curve is drawn: widths of lines and size of the phase names [pt].

    The ordinate is labelled with the signal's name ("full"), without it where a title has it
    ("short"), or with the name on a line of its own ("stacked").
    """

    optimum: float = 1.8
    mean: float = 1.1
    corridor: float = 0.8
    phases: float = 7.5
    label: Literal["full", "short", "stacked"] = "full"


@dataclass(frozen=True)
class Place:
    """Width and height of a page [in]; left, bottom, width, height of its axes in shares of it."""

    width: float
    height: float
    axes: tuple[float, float, float, float]


@dataclass(frozen=True)
class Sheet:
    """A kind of page.

    Attributes
    ----------
    text, small : float
        Size of labels, and of ticks and legends [pt].
    curve, cyclogram : Place
        Pages of Figures 3-10 and of Figure 2.
    hand : Hand
        How curves are drawn.
    sticks : float
        Widths of the cyclogram's lines and size of its words, as multiples of those on a screen.
    captioned : bool
        Whether a caption says what a page shows, as in a journal. Otherwise the page itself does,
        and there is one with all figures.
    columns : int or None
        Most entries of a legend beside each other.
    """

    text: float
    small: float
    curve: Place
    cyclogram: Place
    hand: Hand = Hand()
    sticks: float = 1.0
    captioned: bool = False
    columns: int | None = None


SCREEN = Sheet(
    text=9.0,
    small=8.0,
    curve=Place(6.6, 4.2, (0.115, 0.20, 0.865, 0.66)),
    cyclogram=Place(9.0, 6.6, (0.065, 0.13, 0.92, 0.81)),
)

SINGLE = Sheet(
    text=7.5,
    small=7.0,
    curve=Place(88 * MM, 66 * MM, (0.20, 0.275, 0.765, 0.60)),
    cyclogram=Place(88 * MM, 76 * MM, (0.135, 0.20, 0.85, 0.75)),
    hand=Hand(optimum=1.3, mean=0.9, corridor=0.7, phases=6.5, label="stacked"),
    sticks=0.8,
    captioned=True,
    columns=2,
)

DOUBLE = Sheet(
    text=8.0,
    small=7.5,
    curve=Place(180 * MM, 90 * MM, (0.105, 0.205, 0.875, 0.70)),
    cyclogram=Place(180 * MM, 132 * MM, (0.065, 0.125, 0.92, 0.855)),
    hand=Hand(optimum=1.5, mean=1.0, corridor=0.8, phases=7.0, label="stacked"),
    sticks=0.9,
    captioned=True,
)

JOURNAL = {"single": SINGLE, "double": DOUBLE}
"""Sheets of a journal by the columns that they fill: 88 and 180 mm wide."""
