"""Format names from a file for one line of a message."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.hidden_characters import visible
from fieldhand.language import joined, message
from fieldhand.site.feature_kinds import phrase

_MOST = 8
_LONGEST = 40


def listed(names: Sequence[str]) -> str:
    """Return the first few names and the number of the others."""
    shown = joined(", ", (short(n) for n in names[:_MOST]))
    if len(names) <= _MOST:
        return shown
    return message("{places} and {count} more", places=shown, count=len(names) - _MOST)


def short(text: str, longest: int = _LONGEST) -> str:
    """Return text on one line, cut to a maximum length."""
    text = visible(text)
    return text if len(text) <= longest else text[: longest - 3] + "..."


def say_block(block: str) -> str:
    """Return a block in words: "block B"."""
    return block if is_named_block(block) else message("block {name}", name=block)


def is_named_block(block: str) -> bool:
    """Return True if the name already contains the word "block"."""
    return phrase(block).startswith("block ")
