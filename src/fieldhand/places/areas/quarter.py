"""A quarter of a group's ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import CORNERS
from fieldhand.places.areas.area_words import in_area, of_ground, sides_of_corners
from fieldhand.places.phrase import Phrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.size import Range, at_most
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import CornerName, Side

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Quarter(FromGroup):
    """Trees of ``of`` in one quarter of its ground."""

    quarter: CornerName
    of: Selector = Trees()

    ground_rule = "region"

    @classmethod
    def example(cls, site: Site) -> Quarter:
        return cls(quarter="se")

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.areas.extent import EXTENT_RULE, quarter

        tell.rule = EXTENT_RULE
        return quarter(of, self.quarter, resolution.ground(self.of, of))

    def phrase(self, saying: Saying) -> Phrase:
        of = of_ground(self.of, saying)
        return in_area(
            self.of,
            message("in the {north_west} quarter {of_trees}", north_west=CORNERS[self.quarter], of_trees=of),
            saying,
        )

    @property
    def size(self) -> Range:
        return at_most(self.of.size)

    @property
    def sides(self) -> tuple[Side, ...]:
        return sides_of_corners((self.quarter,))
