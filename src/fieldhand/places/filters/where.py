"""Trees by an attribute."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.filters.attribute_words import say_whose
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Test, Value

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site

#: Attributes whose values people use as adjectives: "yellow trees", "Kerman trees".
_ADJECTIVAL = re.compile(r"(^|_)(colou?r|variety|cultivar|species|health|status|condition|kind)$")


@dataclass(frozen=True, kw_only=True)
class Where(FromGroup):
    """Trees whose attribute passes a test; letter case is ignored."""

    attribute: str
    test: Test
    value: Value
    of: Selector = Trees()

    reference_rule = "group"

    @classmethod
    def example(cls, site: Site) -> Where:
        return cls(attribute="variety", test="eq", value="Kerman")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.filters.attributes import where

        return where(of, self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        base = wording.phrase(self.of)
        if isinstance(self.value, str) and self.test == "eq" and _ADJECTIVAL.search(self.attribute):
            return base.keeping(before=self.value)
        return base.keeping(whose=say_whose(self.attribute, self.test, self.value))

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)
