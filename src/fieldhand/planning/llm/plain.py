"""Text from a model or from a file, made safe to show: visible, on one line, of bounded length."""

from __future__ import annotations

import unicodedata


def visible_line(text: str, longest: int) -> str:
    """The text on one line, without control and other invisible characters, cut to a length.

    Invisible are those of the Unicode categories "other" and "separator": terminal sequences, characters that turn the
    direction of the writing around, joiners without width, private and unassigned ones.
    """
    visible = "".join(" " if unicodedata.category(c).startswith(("C", "Z")) else c for c in text)
    flat = " ".join(visible.split())
    return flat if len(flat) <= longest else flat[:longest] + "..."
