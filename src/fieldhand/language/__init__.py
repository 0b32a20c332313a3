"""What is said to people, as messages that can be said in any language: the catalogues, numbers, the joints of words.

A message is its English text, and remembers the sentence and what fills it. Nothing below the edges of the program
knows a language; whoever prints asks a :class:`Language` for the words.
"""

from fieldhand.language.catalogue import ENGLISH, Language, languages, open_language, spoken
from fieldhand.language.message import (
    LOG,
    Message,
    Number,
    counted,
    joined,
    kept_in_log,
    labelled,
    message,
    named,
    recalled,
    shaped,
)

__all__ = [
    "ENGLISH",
    "LOG",
    "Language",
    "Message",
    "Number",
    "counted",
    "joined",
    "kept_in_log",
    "labelled",
    "languages",
    "message",
    "named",
    "open_language",
    "recalled",
    "shaped",
    "spoken",
]
