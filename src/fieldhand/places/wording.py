"""Wording of selectors, used for all messages, the read-back and the map.

The phrase of a selector is built from the inside out. Filters (an attribute, a zone, a half of the site, a row)
accumulate around one noun: "the yellow trees of row 3 in the northern half". A pick (the northernmost, the 3 nearest)
closes the phrase: "the 3 northernmost of the yellow trees"; a filter applied after it begins a new one. Each selector
defines its own words (:meth:`~fieldhand.places.selector.Selector.phrase`).
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
    """Builds and caches the phrases of selectors.

    Args:
        names: Wording of each label.
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
        selector: Selector to put into words.
        names: Wording of each label ("the tree of step 3"); other labels are quoted.
        count: Number of places, included where the phrase does not state it.
    """
    return SelectorWording(names or {}).phrase(selector).say(count)


def say_selectors(selectors: Iterable[Selector]) -> tuple[str, ...]:
    """Return several selectors in words, as :func:`say_selector`; what they have in common is phrased once."""
    wording = SelectorWording({})
    return tuple(wording.phrase(selector).say() for selector in selectors)


def say_places(ids: tuple[str, ...], few: int = 8) -> str:
    """Return places by id: all if they are few, else the first ones and the number of the others."""
    if len(ids) <= few:
        return listed(ids)
    return message("{places} and {count} more", places=joined(", ", ids[:few]), count=len(ids) - few)
