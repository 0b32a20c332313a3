"""Every tree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import Selector

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Trees(Selector):
    """Every tree of the site, in the order of the file."""

    @classmethod
    def example(cls, site: Site) -> Trees:
        return cls()

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        return resolution.every_tree()

    def ground(self, resolution: Resolution) -> BaseGeometry:
        """Return the ground inside the boundary of the site, else the outline of all trees."""
        import shapely

        boundaries = [zone.polygon for zone in resolution.site.zones_of("boundary")]
        return shapely.union_all(boundaries) if boundaries else super().ground(resolution)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return NounPhrase()
