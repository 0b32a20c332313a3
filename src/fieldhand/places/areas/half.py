"""Selector of the trees in one half of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import SIDES, say_zone
from fieldhand.places.areas.area_words import in_area, of_reference
from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Half(FromGroup):
    """Trees of ``of`` on one side of the middle line of its area.

    The area is the site, or the zone, block, half or picked trees inside; attributes, rows and visits inside do not
    change it.
    """

    side: Side
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> Half:
        return cls(side="north")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import EXTENT_RULE, half

        notes.rule = EXTENT_RULE
        return half(of, self.side, resolution.reference(self.of, of))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        of = of_reference(self.of, wording)
        return in_area(
            self.of, message("in the {northern} half {of_trees}", northern=SIDES[self.side], of_trees=of), wording
        )

    def as_origin(self, wording: SelectorWording) -> str:
        if not self.of.whole_zone:
            return super().as_origin(wording)
        return message("the {northern} half of {zone}", northern=SIDES[self.side], zone=say_zone(self.of.whole_zone))

    def ground(self, resolution: Resolution) -> BaseGeometry:
        """Return that part of the ground of a zone or of a site without plants, else the outline of the trees."""
        from fieldhand.places.points.free_ground import part_of_area

        if self.of.whole_zone or not resolution.site.trees:
            return part_of_area(self.of.ground(resolution), self.side)
        return super().ground(resolution)

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)
