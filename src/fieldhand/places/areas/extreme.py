"""The trees farthest to one side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.phrase import Phrase
from fieldhand.places.picked import foremost, the_most
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Extreme(Counted):
    """The ``count`` trees farthest to one side."""

    side: Side
    count: int = 1
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Extreme:
        return cls(side="north", count=3)

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.areas.extent import outward
        from fieldhand.places.ranks import rank

        self.need(of, resolution)
        return rank(of, -outward(of.xy, self.side), self.count, tell, the_most(f"{self.side}ernmost"))

    def phrase(self, saying: Saying) -> Phrase:
        return foremost(f"{self.side}ernmost", self.count, saying.phrase(self.of))

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)
