"""Marks of the items of a list: numbers ("1.", "2)"), letters ("a)") and dashes at the beginning of lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from string import ascii_lowercase

from fieldhand.planning.english.tokens import Word

#: Signs that begin the items of a list without numbers.
_BULLETS = frozenset("-\N{EN DASH}\N{EM DASH}\N{BULLET}")
#: Signs behind the mark of an item.
_CLOSES = frozenset((":", "-", "\N{EN DASH}", "\N{EM DASH}"))


@dataclass(frozen=True, kw_only=True)
class ListMarks:
    """The marks of the items of a list, by the numbers of their words.

    Attributes:
        marks: Words that are marks.
        ends: Signs behind a mark that separate its item from the one before it.
    """

    marks: frozenset[int] = frozenset()
    ends: frozenset[int] = frozenset()


def list_marks(words: Sequence[Word]) -> ListMarks:
    """Return the marks of a list's items, at least two; none if the words contain no list."""
    bullets = [k for k, word in enumerate(words) if word.text.strip() in _BULLETS and _begins_line(words, k)]
    if len(bullets) > 1:
        return ListMarks(marks=frozenset(bullets))
    for names in ([str(number) for number in range(1, 100)], list(ascii_lowercase)):
        found = list(_in_turn(words, names))
        if len(found) > 1:
            marks = {at for k in found for at in (k, k + 1)} | {
                k - 1 for k in found if k > 0 and words[k - 1].text == "("
            }
            ends = {k + 1 for k in found if (before := _before(k, marks)) >= 0 and words[before].kind != "stop"}
            commas = {before for k in found if (before := _before(k, marks)) >= 0 and words[before].kind == "comma"}
            return ListMarks(marks=frozenset((marks | commas) - ends), ends=frozenset(ends))
    return ListMarks()


def _begins_line(words: Sequence[Word], at: int) -> bool:
    """Return True for a word at the beginning of the text or of a line."""
    return at == 0 or "\n" in words[at - 1].text or "\n" in words[at].text


def _before(at: int, marks: set[int]) -> int:
    """Return the last word before a mark; -1 if there is none."""
    while at in marks:
        at -= 1
    return at


def _in_turn(words: Sequence[Word], names: Sequence[str]) -> Iterator[int]:
    """Yield the words that are the first, second, ... name with a sign behind it that closes a mark."""
    found = 0
    for k, (word, sign) in enumerate(pairwise(words)):
        before = words[k - 1] if k > 0 else None
        begins = before is None or before.kind == "stop" or before.text in (",", ":", "(")
        separate = before is None or before.kind == "stop"
        if sign.text == ")":
            closes = begins or found > 0
        else:
            closes = (begins and sign.text.strip() in _CLOSES) or (separate and sign.text == ".")
        if closes and word.norm == names[found] and word.kind in ("number", "word"):
            yield k
            found += 1
