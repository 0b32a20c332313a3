"""Selector of the trees with the highest or lowest value of an attribute."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import say_name
from fieldhand.places.filters.attribute_words import say_attribute
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selection_phrase import picked_phrase
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.site.feature_kinds import phrase as words_of

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Top(Counted):
    """The ``count`` trees with the highest (or lowest) value of an attribute."""

    attribute: str
    count: int
    lowest: bool = False
    of: Selector = Trees()

    reference_rule = "pick"

    @classmethod
    def example(cls, site: Site) -> Top:
        return cls(attribute="yield_kg", count=10)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.filters.attributes import note_lacking, with_number
        from fieldhand.places.ranks import rank

        known, numbers = with_number(of, self.attribute)
        notes.candidates = len(known)
        count = self.enough(known, resolution, notes)
        note_lacking(len(of) - len(known), self.attribute, notes)
        name = say_name(words_of(self.attribute))
        most = message("the lowest {name}", name=name) if self.lowest else message("the highest {name}", name=name)
        return rank(known, numbers if self.lowest else -numbers, count, notes, most)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        name = say_attribute(self.attribute)[0]
        if self.lowest:
            most = message("with the lowest {name}", name=name)
        else:
            most = message("with the highest {name}", name=name)
        return picked_phrase(wording.phrase(self.of), self.count, most, that_is=False)
