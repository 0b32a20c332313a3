"""A half of a group's ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import SIDES
from fieldhand.places.areas.area_words import in_area, of_ground
from fieldhand.places.phrase import Phrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.size import Range, at_most
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Half(FromGroup):
    """Trees of ``of`` on one side of the middle line of its ground.

    The ground is the site, or the zone, block, half or picked trees inside; attributes, rows and visits inside do not
    change it.
    """

    side: Side
    of: Selector = Trees()

    ground_rule = "region"

    @classmethod
    def example(cls, site: Site) -> Half:
        return cls(side="north")

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.areas.extent import EXTENT_RULE, half

        tell.rule = EXTENT_RULE
        return half(of, self.side, resolution.ground(self.of, of))

    def phrase(self, saying: Saying) -> Phrase:
        of = of_ground(self.of, saying)
        return in_area(
            self.of, message("in the {northern} half {of_trees}", northern=SIDES[self.side], of_trees=of), saying
        )

    @property
    def size(self) -> Range:
        return at_most(self.of.size)

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)
