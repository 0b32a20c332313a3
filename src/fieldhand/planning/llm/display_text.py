"""Sanitize text from a model or a file for display: visible, on one line, of bounded length."""

from __future__ import annotations

import unicodedata


def visible_line(text: str, longest: int) -> str:
    """Return the text on one line, without control and other invisible characters, cut to a length.

    The removed characters are those of the Unicode categories "other" and "separator": terminal escape sequences,
    bidirectional controls, zero-width joiners, private-use and unassigned characters.
    """
    visible = "".join(" " if unicodedata.category(c).startswith(("C", "Z")) else c for c in text)
    flat = " ".join(visible.split())
    return flat if len(flat) <= longest else flat[:longest] + "..."
