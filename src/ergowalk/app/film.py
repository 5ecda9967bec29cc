"""The film of a gait, where this version can make one: the one place that knows how."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

FILM = "film.mp4"
"""What a film is called in the folder of its gait, and when it is downloaded."""


def film_function() -> Callable[[Path, Path], object] | None:
    """What turns a gait file into a film, or None where there is nothing that does."""
    try:
        from ergowalk.plots import write_film  # type: ignore[attr-defined]
    except ImportError:
        return None
    function: Callable[[Path, Path], object] = write_film
    return function


def make_film(folder: str | Path) -> None:
    """Write the film of the gait in a folder beside it."""
    write = film_function()
    assert write is not None, "the page offers a film only where there is a function"
    draft = Path(folder) / f"part-{FILM}"
    write(Path(folder) / "gait.nc", draft)
    os.replace(draft, Path(folder) / FILM)
