"""Trees by an attribute."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.filters.attribute_words import say_whose
from fieldhand.places.phrase import Phrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.size import Range, at_most
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Test, Value

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
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

    ground_rule = "group"

    @classmethod
    def example(cls, site: Site) -> Where:
        return cls(attribute="variety", test="eq", value="Kerman")

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.filters.attributes import where

        return where(of, self, tell)

    def phrase(self, saying: Saying) -> Phrase:
        base = saying.phrase(self.of)
        if isinstance(self.value, str) and self.test == "eq" and _ADJECTIVAL.search(self.attribute):
            return base.keeping(before=self.value)
        return base.keeping(after=say_whose(self.attribute, self.test, self.value))

    @property
    def size(self) -> Range:
        return at_most(self.of.size)
