"""The map of a sweep as one self-contained HTML file; a click shows the gait in the viewer."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Mapping
from html import escape
from importlib import resources
from typing import Any

from ergowalk.viewer.page import json_in_html, viewer_html

# Nothing may be fetched; a frame shows a text that is in the page.
_POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


def map_html(landscape: Mapping[str, Any], gaits: Mapping[str, str], title: str) -> str:
    """The page of a map, as the text of an HTML file that refers to no other.

    Parameters
    ----------
    landscape : mapping
        What is drawn, as plain values: see :func:`ergowalk.study.landscape.payload`.
    gaits : mapping
        By key of the case, what :func:`packed` makes of a gait.
    title : str
    """
    style = "".join(_asset(name) for name in ("viewer.css", "map.css", "page.css"))
    frame = _FRAME.format(policy=escape(_POLICY), style=style, viewer=viewer_html([]))
    return _PAGE.format(
        policy=escape(_POLICY),
        title=escape(title),
        style=style,
        map=_asset("map.html"),
        landscape=json_in_html(landscape),
        gaits=json_in_html(gaits),
        frame=json_in_html(frame),
        script=_asset("map.js"),
    )


def packed(payload: Mapping[str, Any]) -> str:
    """A payload of :func:`ergowalk.viewer.gait_payload`, compressed, as text."""
    text = json.dumps(payload, allow_nan=False, separators=(",", ":"))
    # no time stamp: the same gait, the same text
    return base64.b64encode(gzip.compress(text.encode("utf-8"), mtime=0)).decode("ascii")


def _asset(name: str) -> str:
    return resources.files("ergowalk.viewer").joinpath(name).read_text("utf-8")


_FRAME = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>The gait in motion</title>
<style>
{style}</style>
</head>
<body>
<main>
{viewer}
</main>
</body>
</html>
"""

_PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
<main>
<h1>{title}</h1>
{map}
</main>
<script type="application/json" id="landscape">{landscape}</script>
<script type="application/json" id="gaits">{gaits}</script>
<script type="application/json" id="frame">{frame}</script>
<script>
{script}
const given = (id) => JSON.parse(document.getElementById(id).textContent);
ergowalkMap(document.querySelector(".map"), given("landscape"), given("gaits"), given("frame"));
</script>
</body>
</html>
"""
