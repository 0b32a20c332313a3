"""The trees farthest to one side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selection_phrase import foremost_phrase, the_most
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
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

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import outward
        from fieldhand.places.ranks import rank

        self.need(of, resolution)
        return rank(of, -outward(of.xy, self.side), self.count, notes, the_most(f"{self.side}ernmost"))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return foremost_phrase(f"{self.side}ernmost", self.count, wording.phrase(self.of))

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)
