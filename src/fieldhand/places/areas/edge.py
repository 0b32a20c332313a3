"""Selector of the trees on one edge of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import SIDES
from fieldhand.places.areas.area_words import in_area, of_reference
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Edge(FromGroup):
    """Trees of ``of`` on the outermost line of one side of its area: no tree stands right beyond them."""

    side: Side
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> Edge:
        return cls(side="west")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import edge

        notes.rule = "no tree beside them stands farther out"
        return edge(of, self.side, resolution.reference(self.of, of))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        of = of_reference(self.of, wording)
        return in_area(
            self.of, message("along the {northern} edge {of_trees}", northern=SIDES[self.side], of_trees=of), wording
        )

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)
