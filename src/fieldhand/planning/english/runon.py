"""Long sentences without any sign, as they are dictated: ended where the next step begins."""

from __future__ import annotations

import re
from collections.abc import Sequence

from fieldhand.planning.english.tokens import Word

#: A sentence of fewer words is short enough to be one.
_LONG = 25
#: Words with which a step begins that is no part of what an "if" before them decides.
_NEXT = re.compile(
    r"(?:and )?(?:(?:after (?:that|this|all that)|afterwards|finally|lastly|in the end|at the end|from there)"
    r"|(?:when|once) (?:(?:you|it|that|this|all of that|everything)(?: ?'?s| are| is|'re| have| re)? )?(?:all )?"
    r"(?:done|finished|complete|youre done|thats done))"
    r"(?= )|(?:and )?(?:when|once) (?:youre|you're|thats|that's|its|it's) (?:all )?(?:done|finished|complete)(?= )"
)
#: "Then" begins such a step where another place is named behind it.
_THEN = re.compile(
    r"(?:and )?then (?=(?:\S+ ){0,9}(?:another|different|other|farthest|furthest|northernmost|southernmost|easternmost"
    r"|westernmost|middle|corner|return|back|home|tree \d)\b)"
)


def with_stops(words: Sequence[Word]) -> list[Word]:
    """The words, with a full stop where the next step begins in a long sentence that has no sign."""
    made: list[Word] = []
    sentence: list[Word] = []
    for word in words:
        sentence.append(word)
        if word.kind == "stop":
            made += _parted(sentence)
            sentence = []
    return [*made, *_parted(sentence)]


def _parted(sentence: list[Word]) -> list[Word]:
    if len(sentence) < _LONG or any(word.kind == "comma" for word in sentence):
        return sentence
    starts: dict[int, int] = {}
    text = ""
    for index, word in enumerate(sentence):
        starts[len(text)] = index
        text += word.norm + " "
    found = {match.start() for pattern in (_NEXT, _THEN) for match in pattern.finditer(text)}
    breaks = {starts[place] for place in found if place in starts and starts[place] > 0}
    made: list[Word] = []
    for index, word in enumerate(sentence):
        if index in breaks and made and made[-1].kind != "stop":
            made.append(Word(kind="stop", text="", norm=".", start=word.start, end=word.start))
        made.append(word)
    return made
