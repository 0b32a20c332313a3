"""HTML for notebooks: escaped text, tables and embedded pictures, without external resources."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from html import escape

from fieldhand.hidden_characters import visible


def text_html(value: object) -> str:
    """Return text as HTML; control and bidi characters become visible."""
    return escape(visible(str(value), lines=True))


def element(tag: str, value: object) -> str:
    """Return an HTML element with escaped text."""
    return f"<{tag}>{text_html(value)}</{tag}>"


def table_html(head: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """Return a table of text."""
    top = "".join(element("th", cell) for cell in head)
    body = "".join(f"<tr>{''.join(element('td', cell) for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def list_html(lines: Sequence[object]) -> str:
    """Return a bulleted list; nothing for no lines."""
    return f"<ul>{''.join(element('li', line) for line in lines)}</ul>" if lines else ""


def picture_html(picture: bytes, media_type: str) -> str:
    """Return an image element with the picture embedded as a data URL.

    Args:
        picture: Content of the image file.
        media_type: ``image/png`` or ``image/svg+xml``; scripts in an SVG do not run in an image element.
    """
    data = base64.b64encode(picture).decode()
    return f'<img alt="map" style="max-width: 100%; background: white" src="data:{media_type};base64,{data}">'
