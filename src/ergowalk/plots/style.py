"""How every figure looks, and how it becomes a file.

Figures are plain :class:`matplotlib.figure.Figure` objects: no window system, no global state
beyond :func:`styled`, which puts the settings back when it is done.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure

from ergowalk.errors import OutputError
from ergowalk.plots.sheets import SCREEN, Sheet

# Okabe and Ito's palette: told apart with any colour vision
LEG_1 = "#0072B2"
LEG_2 = "#D55E00"
TRUNK = "#7A7A7A"
GAIT = LEG_1
HUMAN = "#404040"
BAND = "#D5D5D5"
CORRIDOR = "#009E73"
WARNING = "#B22222"
FAINT = "#9A9A9A"

DPI = 150
FORMATS = ("png", "svg")
"""Formats for screens."""

PRINTED = ("pdf", "svg")
"""Formats for journals: drawings whose text is text."""

KNOWN = ("png", "svg", "pdf")

_SETTINGS: Any = {
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "lines.solid_capstyle": "round",
    "lines.solid_joinstyle": "round",
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "none",  # text stays text: searchable, small, in the reader's font
    "svg.hashsalt": "ergowalk",  # ids from the content instead of at random
    "pdf.fonttype": 42,  # fonts embedded as outlines that can be edited, not as drawings
}


def _sizes(sheet: Sheet) -> dict[str, float]:
    """Sizes of text on a kind of page."""
    labels = dict.fromkeys(("font.size", "axes.labelsize"), sheet.text)
    return labels | dict.fromkeys(
        ("xtick.labelsize", "ytick.labelsize", "legend.fontsize"), sheet.small
    )


@contextmanager
def styled(sheet: Sheet = SCREEN) -> Iterator[None]:
    """The package's settings on top of matplotlib's defaults, whatever the user's file says."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_SETTINGS | _sizes(sheet))
        yield


_FAST: dict[str, dict[str, Any]] = {"png": {"pil_kwargs": {"compress_level": 3}}}
"""Level 3 takes a third of the time of the default 6, for files a tenth larger."""


_METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
"""Neither the date nor the version of matplotlib: a figure changes only with its content."""


def save(figure: Figure, path: Path) -> Path:
    """Write a figure in the format that the suffix names; the same figure, the same bytes.

    The file is written beside its target and renamed, so there is never half of one.

    Raises
    ------
    OutputError
        If the format is unknown or the file cannot be written.
    """
    kind = path.suffix.lstrip(".")
    check_format(kind)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with styled():
            figure.savefig(
                part, format=kind, dpi=DPI, metadata=_METADATA[kind], **_FAST.get(kind, {})
            )
        os.replace(part, path)
    except OSError as error:
        raise OutputError(
            f"cannot be written ({error.strerror or error})",
            "choose a folder that exists, that you may write to, on a disk with room",
            file=str(path),
        ) from None
    finally:
        with suppress(OSError):
            part.unlink()
    return path


def check_format(kind: str) -> None:
    """Raise OutputError unless figures can be written in this format."""
    if kind not in KNOWN:
        raise OutputError(
            "no such picture format", f"choose {' or '.join(KNOWN)}", field="format", value=kind
        )
