"""The map of a sweep as one self-contained HTML file; a click shows the gait in the viewer."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Mapping
from html import escape
from typing import Any

from ergowalk.viewer.document import document
from ergowalk.viewer.looks import asset
from ergowalk.viewer.page import json_in_html, viewer_html


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
    scripts = _SCRIPTS.format(
        landscape=json_in_html(landscape),
        gaits=json_in_html(gaits),
        frame=json_in_html(document("The gait in motion", _STYLES, viewer_html([]))),
        script=asset("map.js"),
    )
    return document(title, _STYLES, f"<h1>{escape(title)}</h1>\n{asset('map.html')}", scripts)


def packed(payload: Mapping[str, Any]) -> str:
    """A payload of :func:`ergowalk.viewer.gait_payload`, compressed, as text."""
    text = json.dumps(payload, allow_nan=False, separators=(",", ":"))
    # no time stamp: the same gait, the same text
    return base64.b64encode(gzip.compress(text.encode("utf-8"), mtime=0)).decode("ascii")


_STYLES = ("viewer.css", "map.css", "page.css")

_SCRIPTS = """\
<script type="application/json" id="landscape">{landscape}</script>
<script type="application/json" id="gaits">{gaits}</script>
<script type="application/json" id="frame">{frame}</script>
<script>
{script}
const given = (id) => JSON.parse(document.getElementById(id).textContent);
ergowalkMap(document.querySelector(".map"), given("landscape"), given("gaits"), given("frame"));
</script>
"""
