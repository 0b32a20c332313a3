""" "The opposite corner", "the other half": a side that is named by another that was spoken of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from fieldhand.planning.english.tokens import Term

_HEADS = frozenset({"CORNER", "EDGE", "SIDE", "HALF", "QUARTER", "FINISH"})
_OPPOSITE = {"north": "south", "south": "north", "east": "west", "west": "east",
             "ne": "sw", "sw": "ne", "nw": "se", "se": "nw"}  # fmt: skip


def with_opposites(sentences: Iterable[list[Term]]) -> Iterator[list[Term]]:
    """The sentences with a side of the compass in place of "opposite" and "other", where one was spoken of before."""
    last: dict[str, str] = {}  # by what it was said of: the side that was spoken of last
    for sentence in sentences:
        made: list[Term] = []
        for index, term in enumerate(sentence):
            head = sentence[index + 1].kind if index + 1 < len(sentence) else ""
            if term.kind in ("DIR", "MOST") and head in _HEADS:
                last[head] = str(term.value)
            before = sentence[index - 1].text.lower() if index else ""
            other = term.kind == "OTHER" and term.text.lower() == "other" and before == "the" and head != "CORNER"
            side = last.get(head, "")
            if (term.kind == "OPPOSITE" or other) and side in _OPPOSITE and not sentence[index + 1].plural:
                last[head] = _OPPOSITE[side]
                term = replace(term, kind="DIR", value=last[head])
            made.append(term)
        yield made
