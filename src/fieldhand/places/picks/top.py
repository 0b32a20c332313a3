"""The trees with the most of an attribute."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import say_name
from fieldhand.places.filters.attribute_words import say_attribute
from fieldhand.places.phrase import Phrase
from fieldhand.places.picked import picked
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.site.kinds import phrase as words_of

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Top(Counted):
    """The ``count`` trees with the highest (or lowest) value of an attribute."""

    attribute: str
    count: int
    lowest: bool = False
    of: Selector = Trees()

    ground_rule = "pick"

    @classmethod
    def example(cls, site: Site) -> Top:
        return cls(attribute="yield_kg", count=10)

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.filters.attributes import tell_lacking, with_number
        from fieldhand.places.ranks import rank

        known, numbers = with_number(of, self.attribute)
        tell.candidates = len(known)
        self.need(known, resolution)
        tell_lacking(len(of) - len(known), self.attribute, tell)
        name = say_name(words_of(self.attribute))
        most = message("the lowest {name}", name=name) if self.lowest else message("the highest {name}", name=name)
        return rank(known, numbers if self.lowest else -numbers, self.count, tell, most)

    def phrase(self, saying: Saying) -> Phrase:
        name = say_attribute(self.attribute)[0]
        if self.lowest:
            most = message("with the lowest {name}", name=name)
        else:
            most = message("with the highest {name}", name=name)
        return picked(saying.phrase(self.of), self.count, most, that_is=False)
