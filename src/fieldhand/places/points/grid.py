"""Selector of plants, or free points, on a square grid over an area."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import say_number
from fieldhand.places.areas.area_words import say_area, sides_of_part
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import AreaPart, Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Grid(FromGroup):
    """The tree of ``of`` nearest to the middle of each cell of a square grid with ``every_m`` metre sides. With
    ``zone`` (and ``part``), free points there; without trees, on the whole site."""

    every_m: float
    zone: str = ""
    part: AreaPart = "all"
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Grid:
        return cls(every_m=20.0)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.on_grid import points_on_grid

        if self.on_ground or not resolution.site.trees:
            return points_on_grid(resolution.site, self, notes)
        return super().resolve(resolution, notes)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return one tree of each cell that has one.

        Raises:
            PlaceError: The spacing is not possible.
        """
        from fieldhand.places.filters.zones import outside_keep_outs
        from fieldhand.places.points.on_grid import trees_on_grid

        return trees_on_grid(outside_keep_outs(of, notes).once(1), self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        every = say_number(self.every_m)
        if self.on_ground:
            area = say_area(self.zone, self.part)
            return many(message("points on a {metres} m grid over {zone}", metres=every, zone=area))
        group = wording.phrase(self.of)
        return many(message("one of {trees} per cell of a {metres} m grid", metres=every, trees=group.group()))

    @property
    def on_ground(self) -> bool:
        """True if the points are named by their ground rather than by trees."""
        return bool(self.zone) or self.part != "all"

    @property
    def sides(self) -> tuple[Side, ...]:
        return sides_of_part(self.part)

    @property
    def keeps_order(self) -> bool:
        return False
