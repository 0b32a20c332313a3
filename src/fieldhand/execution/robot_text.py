"""Text of a robot's messages, before anything else of the program gets it.

A message may hold control characters, characters that reverse the direction of writing, or megabytes. Here they become
visible and short, so that events, journal, report and terminal have only text that a person sees as it is.
"""

from __future__ import annotations

import re

from fieldhand.hidden_characters import visible

#: Characters of a text that are kept.
MOST = 500
_SPACE = re.compile(r"[ \t\r\n]+")


def robot_text(text: str, most: int = MOST) -> str:
    r"""Return a text on one line, with hidden characters as ``\u{001b}``, cut if it is long.

    A text without any is returned as it is, so that a message keeps its translations.
    """
    if len(text) > most:
        text = f"{text[:most]}…"
    if visible(text) == text:
        return text
    return visible(_SPACE.sub(" ", text).strip())


def robot_text_or_none(text: str | None) -> str | None:
    """Return :func:`robot_text`; None for None."""
    return None if text is None else robot_text(text)
