"""Selector of the trees in one quarter of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import CORNERS, say_zone
from fieldhand.places.areas.area_words import in_area, of_reference, sides_of_corners
from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import CornerName, Side

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Quarter(FromGroup):
    """Trees of ``of`` in one quarter of its area."""

    quarter: CornerName
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> Quarter:
        return cls(quarter="se")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import EXTENT_RULE, quarter

        notes.rule = EXTENT_RULE
        return quarter(of, self.quarter, resolution.reference(self.of, of))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        of = of_reference(self.of, wording)
        return in_area(
            self.of,
            message("in the {north_west} quarter {of_trees}", north_west=CORNERS[self.quarter], of_trees=of),
            wording,
        )

    def as_origin(self, wording: SelectorWording) -> str:
        if not self.of.whole_zone:
            return super().as_origin(wording)
        return message(
            "the {north_west} quarter of {zone}", north_west=CORNERS[self.quarter], zone=say_zone(self.of.whole_zone)
        )

    def ground(self, resolution: Resolution) -> BaseGeometry:
        """Return that part of the ground of a zone or of a site without plants, else the outline of the trees."""
        from fieldhand.places.points.free_ground import part_of_area

        if self.of.whole_zone or not resolution.site.trees:
            return part_of_area(self.of.ground(resolution), self.quarter)
        return super().ground(resolution)

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)

    @property
    def sides(self) -> tuple[Side, ...]:
        return sides_of_corners((self.quarter,))
