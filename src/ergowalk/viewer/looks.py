"""How the viewer draws a walker, read from its own files, so that films look the same."""

from __future__ import annotations

import json
import re
from functools import cache
from importlib import resources
from typing import Any


@cache
def looks() -> dict[str, Any]:
    """Sizes of the walker's parts [m] and shares of mixed colours: ``LOOKS`` of viewer.js."""
    found = re.search(r"^const LOOKS = (\{.*?^\});", asset("viewer.js"), re.M | re.S)
    assert found is not None
    parsed: dict[str, Any] = json.loads(found[1])
    return parsed


@cache
def palette(dark: bool = False) -> dict[str, str]:
    """Colours of the viewer as "#rrggbb" by their names in viewer.css."""
    text = asset("viewer.css")
    light, night = re.findall(r"\.viewer \{(.*?)\}", text, re.S)[:2]
    colours = dict(_COLOUR.findall(light))
    return colours | dict(_COLOUR.findall(night)) if dark else colours


_COLOUR = re.compile(r"--([a-z0-9-]+): (#[0-9a-f]{6});")


@cache
def asset(name: str) -> str:
    """The text of a file of the viewer."""
    return resources.files("ergowalk.viewer").joinpath(name).read_text("utf-8")
