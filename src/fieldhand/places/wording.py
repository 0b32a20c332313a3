"""Selectors in words that a grower would sign: the one wording of places, for messages, read-back and the map.

A selector is said from the inside out. What only keeps trees (an attribute, a zone, a half of the site, a row) gathers
around one noun: "the yellow trees of row 3 in the northern half". What picks (the northernmost, the 3 nearest) closes
the phrase: "the 3 northernmost of the yellow trees"; whatever keeps among those then starts a new one. The words of
each selector stand in its file (:meth:`~fieldhand.places.selector.Selector.phrase`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from fieldhand.language import joined, message
from fieldhand.language.words import listed
from fieldhand.places.noun_phrase import NounPhrase

if TYPE_CHECKING:
    from fieldhand.places.selector import Selector

Names = Mapping[str, str]


class SelectorWording:
    """The phrases so far, since a group is often said again, and what labels are called.

    Args:
        names: What a label is called.
    """

    def __init__(self, names: Names) -> None:
        self.names = names
        self._known: dict[str, NounPhrase] = {}

    def phrase(self, selector: Selector) -> NounPhrase:
        """Return the phrase of a selector."""
        key = repr(selector)
        if key not in self._known:
            self._known[key] = selector.phrase(self)
        return self._known[key]


def say_selector(selector: Selector, names: Names | None = None, count: int | None = None) -> str:
    """Return a selector in words.

    Args:
        selector: What to say.
        names: What a label is called ("the tree of step 3"); else it is quoted.
        count: How many places it gives, said where the phrase does not say it itself.
    """
    return SelectorWording(names or {}).phrase(selector).say(count)


def say_selectors(selectors: Iterable[Selector]) -> tuple[str, ...]:
    """Return several selectors in words, as :func:`say_selector`; what they have in common is phrased once."""
    wording = SelectorWording({})
    return tuple(wording.phrase(selector).say() for selector in selectors)


def say_places(ids: tuple[str, ...], few: int = 8) -> str:
    """Places by id: all of them when few, else the first ones and how many more."""
    if len(ids) <= few:
        return listed(ids)
    return message("{places} and {count} more", places=joined(", ", ids[:few]), count=len(ids) - few)
