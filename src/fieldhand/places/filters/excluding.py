"""All but some trees."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.areas.half import Half
from fieldhand.places.phrase import Phrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.size import Range, at_most
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Excluding(FromGroup):
    """Trees of ``of`` that are not among ``places``."""

    places: Selector
    of: Selector = Trees()

    ground_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Excluding:
        return cls(places=Half(side="south"))

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        return of.without(resolution.spots(self.places))

    def phrase(self, saying: Saying) -> Phrase:
        return saying.phrase(self.of).keeping(after=message("other than {place}", place=self.places.it(saying)))

    @property
    def size(self) -> Range:
        return at_most(self.of.size)
