"""A page that refers to no other and fetches nothing, whatever a gait file says."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from ergowalk.viewer.looks import asset

# nothing may be fetched; a frame may show a text that is in the page
_POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


def document(title: str, styles: Iterable[str], main: str, scripts: str = "") -> str:
    """The text of an HTML file.

    Parameters
    ----------
    title : str
        As plain text.
    styles : iterable of str
        Names of the style sheets, files of the viewer.
    main, scripts : str
        What stands in the main element and, if anything, behind it, as HTML.
    """
    return _DOCUMENT.format(
        policy=escape(_POLICY),
        title=escape(title),
        style="".join(map(asset, styles)),
        main=main,
        scripts=scripts,
    )


_DOCUMENT = """\
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
{main}
</main>
{scripts}</body>
</html>
"""
