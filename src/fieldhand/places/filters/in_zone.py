"""Trees inside or outside a zone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.language.words import say_number, say_zone
from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.place_errors import no_such_zone
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.site.names import short

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class InZone(FromGroup):
    """Trees inside a named zone of the site or at most ``margin_m`` metres from it, or all others (``outside``)."""

    zone: str
    outside: bool = False
    margin_m: float = 0.0
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> InZone:
        return cls(zone=next((zone.name for zone in site.zones if zone.kind == "zone"), ""))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the trees in the zones of that name, or else those of the block of that name."""
        from fieldhand.places.filters.zones import in_block, in_zones

        site, zone = resolution.site, self.zone
        if not (math.isfinite(self.margin_m) and self.margin_m >= 0):
            raise PlaceError(
                message("a margin of {metres} m is not possible", metres=Number(f"{self.margin_m:g}")),
                advice=message("give a margin of 0 m or more"),
            )
        inside = in_zones(of, zone, self.margin_m)
        if inside is None:
            inside = in_block(of, zone)
            if inside is None:
                raise no_such_zone(site, zone)
            if self.margin_m:
                raise PlaceError(
                    message("distances are not measured from the block '{zone}'", zone=short(zone)),
                    where=site.name,
                    advice=message("name a zone, a tree or a marker to measure from"),
                )
            notes.rule = "that is a block of the site"
        return of.without(inside) if self.outside else inside

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        base, zone = wording.phrase(self.of), say_zone(self.zone)
        if self.margin_m:
            near = {"distance": say_number(self.margin_m), "place": zone}
            if self.outside:
                return base.keeping(after=message("more than {distance} m from {place}", **near))
            return base.keeping(after=message("within {distance} m of {place}", **near))
        if self.outside:
            return base.keeping(after=message("outside {zone}", zone=zone))
        return base.keeping(after=message("inside {zone}", zone=zone))

    def ground(self, resolution: Resolution) -> BaseGeometry:
        """Return the zone itself, whether or not there are trees in it."""
        import shapely

        from fieldhand.places.filters.zones import zones_called

        zones = zones_called(resolution.site, self.whole_zone)
        return shapely.union_all(zones) if zones else super().ground(resolution)

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)

    @property
    def whole_zone(self) -> str:
        return self.zone if self == InZone(zone=self.zone) else ""
