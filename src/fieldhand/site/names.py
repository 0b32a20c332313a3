"""Names from a file, made fit for one line of a message."""

from __future__ import annotations

from collections.abc import Sequence

from fieldhand.hidden_characters import visible
from fieldhand.language import joined, message
from fieldhand.site.feature_kinds import phrase

_MOST = 8
_LONGEST = 40


def listed(names: Sequence[str]) -> str:
    """The first few, and how many more."""
    shown = joined(", ", (short(n) for n in names[:_MOST]))
    if len(names) <= _MOST:
        return shown
    return message("{places} and {count} more", places=shown, count=len(names) - _MOST)


def short(text: str, longest: int = _LONGEST) -> str:
    """Text on one line and not too long."""
    text = visible(text)
    return text if len(text) <= longest else text[: longest - 3] + "..."


def say_block(block: str) -> str:
    """A block: "block B"."""
    return block if is_named_block(block) else message("block {name}", name=block)


def is_named_block(block: str) -> bool:
    """Return True if its name says already that it is a block."""
    return phrase(block).startswith("block ")
