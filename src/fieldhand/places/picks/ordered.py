"""Selector of places in a given order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from fieldhand.language import joined, message
from fieldhand.places.count_range import CountRange
from fieldhand.places.filters.attribute_words import say_attribute
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.ordinals import say_ordinal
from fieldhand.places.selection_phrase import foremost_phrase, superlative
from fieldhand.places.selector import DependsOn, FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site

Order = Literal[
    "west_to_east",
    "east_to_west",
    "north_to_south",
    "south_to_north",
    "nearest_first",
    "farthest_first",
    "rows",
    "attribute",
]
#: Superlative of the first place in each order.
_FOREMOST: Mapping[Order, str] = {
    "west_to_east": "westernmost",
    "east_to_west": "easternmost",
    "north_to_south": "northernmost",
    "south_to_north": "southernmost",
    "nearest_first": "nearest",
    "farthest_first": "farthest",
}
_ORDERS: Mapping[Order, str] = {
    "west_to_east": message("from west to east"),
    "east_to_west": message("from east to west"),
    "north_to_south": message("from north to south"),
    "south_to_north": message("from south to north"),
    "nearest_first": message("the nearest first"),
    "farthest_first": message("the farthest first"),
    "rows": message("row by row"),
}
_BACKWARDS: Mapping[Order, str] = {
    "west_to_east": message("from east to west"),
    "east_to_west": message("from west to east"),
    "north_to_south": message("from south to north"),
    "south_to_north": message("from north to south"),
    "nearest_first": message("the farthest first"),
    "farthest_first": message("the nearest first"),
    "rows": message("row by row from the last"),
}


@dataclass(frozen=True, kw_only=True)
class Ordered(FromGroup):
    """``of`` in a fixed order: by the compass, by distance from the current place, row by row
    (``rows``), or by an ``attribute``, from its lowest value or ``descending``."""

    by: Order
    attribute: str = ""
    descending: bool = False
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Ordered:
        return cls(by="rows")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.picks.ordering import ordered

        return ordered(of, self, resolution.context.here.xy, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return replace(wording.phrase(self.of), order=self._order())

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def size(self) -> CountRange:
        return self.of.size

    @property
    def depends_on(self) -> DependsOn:
        return "nearness" if self.by in ("nearest_first", "farthest_first") else "site"

    def nth_phrase(self, number: int, wording: SelectorWording) -> NounPhrase:
        """Return the phrase of the n-th place, such as "the tree with the third highest yield"."""
        if number > 0 and self.by == "attribute":
            return one(self._nth_most(number, wording.phrase(self.of)))
        if number > 0 and self.by in _FOREMOST and not self.descending:
            return _nth_foremost(_FOREMOST[self.by], number, wording.phrase(self.of))
        return super().nth_phrase(number, wording)

    def _order(self) -> str:
        """Return the order in words: "from west to east", "by yield, the highest first"."""
        if self.by == "attribute":
            name = say_attribute(self.attribute)[0]
            if self.descending:
                return message("by {name}, the highest first", name=name)
            return message("by {name}, the lowest first", name=name)
        return (_BACKWARDS if self.descending else _ORDERS)[self.by]

    def _nth_most(self, number: int, group: NounPhrase) -> str:
        base = message("the tree") if group.plain else message("the one of {trees}", trees=group.group())
        name = say_attribute(self.attribute)[0]
        if number == 1:
            most = message("with the highest {name}", name=name), message("with the lowest {name}", name=name)
        else:
            rank = say_ordinal(number, "one")
            most = (
                message("with the {ordinal} highest {name}", ordinal=rank, name=name),
                message("with the {ordinal} lowest {name}", ordinal=rank, name=name),
            )
        return joined(" ", (base, most[0] if self.descending else most[1]))


def _nth_foremost(word: str, number: int, group: NounPhrase) -> NounPhrase:
    """Return a phrase such as "the second northernmost tree"."""
    if number == 1:
        return foremost_phrase(word, 1, group)
    rank, which = say_ordinal(number, "tree"), superlative(word, 1)
    if group.plain:
        return one(message("the {ordinal} {northernmost} tree", ordinal=rank, northernmost=which))
    rank = say_ordinal(number, "one")
    return one(
        message("the {ordinal} {northernmost} of {trees}", ordinal=rank, northernmost=which, trees=group.group())
    )
