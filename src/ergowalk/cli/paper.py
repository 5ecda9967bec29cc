"""A gait by the paper's method beside what the paper prints of its own."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import xarray as xr

from ergowalk.gait.rhythm import PRINTED_RHYTHM
from ergowalk.problem import preset

if TYPE_CHECKING:
    from ergowalk.comparison import Comparison

PRINTED_ENERGY = 127.0
"""E [J/m] for L = 0.76 m, T = 1.14 s, section 5."""

SYMBOLS = {"heel_end": "tau^h", "heel_off": "tau^m", "toe_tip_start": "tau^t", "toe_off": "tau^s"}
"""The rhythm parameters in the paper's letters."""

FIGURES = "solid curve beside the human domain; 'within reasonable proximity'"
"""What the paper says of its curves."""

WHY = (
    "The paper does not give the length l_h = |HM| of the sole, rho and the number of knots, the "
    "width of the corridors, or the tolerances of the measures G: each of them changes E. Its "
    "curves are printed as pictures without numbers, so peaks stand beside the human mean here. "
    "Tau_2 is tau_1 half a stride later: the printed (0.6, 0.73, -, 0.08) T."
)

RELATIVE, INSTANT = 0.01, 0.0005
"""E within this share, instants within this part of T, count as the same: the digits printed."""


@dataclass(frozen=True)
class Statement:
    """One quantity: as found, as printed, and where they differ why."""

    what: str
    found: str
    printed: str
    why: str = ""


@dataclass(frozen=True)
class BesidePaper:
    """All statements of the paper that a gait can be set beside."""

    statements: tuple[Statement, ...]

    def as_dict(self) -> list[dict[str, str]]:
        """As plain values."""
        return [dict(vars(s)) for s in self.statements]

    def line(self) -> str:
        """The statements with numbers on one line."""
        return "; ".join(
            f"{s.what} {s.found} (printed {s.printed})"
            for s in self.statements
            if s.printed != FIGURES
        )

    def markdown(self) -> str:
        """A section of the report."""
        rows = [("", "here", "the paper", "why they differ")]
        rows += [("---",) * 4]
        rows += [(s.what, s.found, s.printed, s.why) for s in self.statements]
        lines = "\n".join(f"| {' | '.join(row)} |" for row in rows)
        return f"## Beside the paper\n\n{lines}\n\n{WHY}"


def beside_paper(dataset: xr.Dataset, comparison: Comparison | None) -> BesidePaper | None:
    """The statements for a gait by the spline method at the paper's L and T; None for others."""
    attributes, case = dataset.attrs, preset("berbyuk2002-rhythm")
    same = (attributes.get("step_length"), attributes.get("stride_time"))
    if attributes.get("method") != "spline" or same != (case.step_length_m, case.stride_time_s):
        return None
    statements = [_energy(attributes), *_rhythm(attributes)]
    for signal in [] if comparison is None else comparison.signals:
        ends, human = signal.gait, signal.human
        found = (
            f"{ends.min:.2f} to {ends.max:.2f} {signal.unit} (human mean {human.min:.2f} to "
            f"{human.max:.2f}), {signal.inside_1sd:.0%} of the stride within 1 SD"
        )
        why = "" if signal.inside_1sd >= 1 else _why_outside(signal.name, attributes)
        statements.append(Statement(signal.name.replace("_", " "), found, FIGURES, why))
    return BesidePaper(tuple(statements))


def _energy(attributes: dict[str, Any]) -> Statement:
    energy = float(attributes["energy_per_metre"])
    why = ""
    if abs(energy / PRINTED_ENERGY - 1) > RELATIVE:
        cheaper = energy < PRINTED_ENERGY
        why = "l_h, knots and corridors are not given; " + (
            "and here the search went on until it brought nothing more"
            if cheaper
            else "and here more may be asked for"
        )
    return Statement("E", f"{energy:.1f} J/m", f"{PRINTED_ENERGY:.0f} J/m", why)


def _rhythm(attributes: dict[str, Any]) -> list[Statement]:
    found, printed = json.loads(attributes["rhythm"]), PRINTED_RHYTHM.as_dict()
    return [
        Statement(
            f"{SYMBOLS[name]}",
            f"{found[name]:.3g} T",
            f"{value:g} T",
            "" if abs(found[name] - value) <= INSTANT else "the problem bounds it otherwise",
        )
        for name, value in printed.items()
    ]


def _why_outside(name: str, attributes: dict[str, Any]) -> str:
    if name.endswith("angle"):
        return "a measure of (19) may be as large as its tolerance; the corridor may be wider"
    if attributes.get("asked") == "paper":
        return "nothing in (19) bounds forces from above, or how fast moments change"
    return "no corridor is asked of forces and moments"
