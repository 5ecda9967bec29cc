"""The film of a gait: the one place that knows how the app makes one."""

from __future__ import annotations

import json
import os
from importlib.util import find_spec
from pathlib import Path

from ergowalk.app.results import PAYLOAD


def film_name() -> str:
    """What a film is called in the folder of its gait and on its way out."""
    return "film.gif" if find_spec("av") is None else "film.mp4"


def make_film(folder: str | Path, name: str) -> None:
    """Write the film of the gait in a folder beside it.

    Raises
    ------
    InputError
        If it cannot be made.
    """
    from ergowalk.film import FilmOptions, film

    place = Path(folder)
    payload = json.loads((place / PAYLOAD).read_text("utf-8"))
    options = FilmOptions(format=Path(name).suffix[1:])
    draft = place / f"part-{name}"
    draft.write_bytes(film([payload], options))
    os.replace(draft, place / name)
