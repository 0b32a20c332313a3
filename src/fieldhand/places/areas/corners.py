"""Corners of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import CORNERS, listed, say_zone
from fieldhand.places.areas.area_words import sides_of_corners
from fieldhand.places.count_range import CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.place_errors import nothing
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import CornerName, Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Corners(FromGroup):
    """The tree nearest to each named corner of the smallest-area enclosing rectangle of ``of``; all four by default.
    With ``zone``, free points in its corners."""

    which: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")
    zone: str = ""
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Corners:
        return cls()

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.in_corners import in_corners

        if self.which and self.zone:
            notes.rule = "corners are those of the smallest rectangle around the zone"
            return in_corners(resolution.site, self.zone, self.which)
        return super().resolve(resolution, notes)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import corners

        if not self.which:
            raise nothing(resolution.site, self, "it names no corner")
        notes.rule = "corners are those of the smallest rectangle around the trees"
        return corners(of, self.which, resolution.reference(self.of, of, picks_too=False))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        if self.zone:
            return self._of_zone()
        group = wording.phrase(self.of)
        of = "" if group.plain else message("of {trees}", trees=group.group())
        if len(self.which) == 1:
            corner = CORNERS[self.which[0]]
            return one(message("the {north_west} corner tree {of_trees}", north_west=corner, of_trees=of))
        if not self.which or set(self.which) == set(CORNERS):
            return many(message("the 4 corner trees {of_trees}", of_trees=of))
        named_corners = listed([CORNERS[name] for name in self.which])
        return many(message("the {north_west} corner trees {of_trees}", north_west=named_corners, of_trees=of))

    def _of_zone(self) -> NounPhrase:
        zone = say_zone(self.zone)
        if len(self.which) == 1:
            return one(message("the {north_west} corner of {zone}", north_west=CORNERS[self.which[0]], zone=zone))
        if not self.which or set(self.which) == set(CORNERS):
            return many(message("the 4 corners of {zone}", zone=zone))
        named_corners = listed([CORNERS[name] for name in self.which])
        return many(message("the {north_west} corners of {zone}", north_west=named_corners, zone=zone))

    @property
    def keeps_order(self) -> bool:
        return True

    def aside(self, phrase: str) -> str:
        """Return "north-west corner"."""
        if self.single and not self.zone and self.of == Trees():
            return message("{north_west} corner", north_west=CORNERS[self.which[0]])
        return phrase

    @property
    def single(self) -> bool:
        return len(self.which) == 1

    @property
    def size(self) -> CountRange:
        return exactly(len(self.which)) if self.zone or self.of == Trees() else super().size

    @property
    def sides(self) -> tuple[Side, ...]:
        return sides_of_corners(self.which) if len(self.which) < 4 else ()
