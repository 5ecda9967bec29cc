"""The film of a gait, where this version can make one: the one place that knows how."""

from __future__ import annotations

import json
import os
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from ergowalk.app.results import PAYLOAD

MAKER = "ergowalk.film"
"""The room that makes films."""


def film_name() -> str:
    """What a film is called in the folder of its gait and on its way out; "" if none is made."""
    if find_spec(MAKER) is None:
        return ""
    return "film.gif" if find_spec("av") is None else "film.mp4"


def make_film(folder: str | Path, name: str) -> None:
    """Write the film of the gait in a folder beside it.

    Raises
    ------
    InputError
        If it cannot be made.
    """
    maker, place = import_module(MAKER), Path(folder)
    payload = json.loads((place / PAYLOAD).read_text("utf-8"))
    options = maker.FilmOptions(format=Path(name).suffix[1:])
    draft = place / f"part-{name}"
    draft.write_bytes(maker.film([payload], options))
    os.replace(draft, place / name)
