"""The middle of an edge of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import SIDES
from fieldhand.places.areas.area_words import of_reference
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selection_phrase import picked_phrase
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
class EdgeMiddle(Counted):
    """The ``count`` trees on one edge of ``of`` nearest to its middle."""

    side: Side
    count: int = 1
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> EdgeMiddle:
        return cls(side="east")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import edge, from_edge_middle
        from fieldhand.places.ranks import rank

        reference = resolution.reference(self.of, of)
        candidates = edge(of, self.side, reference)
        notes.candidates = len(candidates)
        self.need(candidates, resolution)
        away = from_edge_middle(candidates, self.side, reference)
        middle = message("the nearest to the middle of the {northern} edge", northern=SIDES[self.side])
        return rank(candidates, away, self.count, notes, middle)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        near = message(
            "nearest to the middle of the {northern} edge {of_trees}",
            northern=SIDES[self.side],
            of_trees=of_reference(self.of, wording),
        )
        return picked_phrase(wording.phrase(self.of), self.count, near)

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)

    @property
    def central(self) -> bool:
        return True
