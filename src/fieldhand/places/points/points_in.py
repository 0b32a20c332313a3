"""Selector of free points spread over a zone, or drawn at random in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import counted, message
from fieldhand.places.areas.area_words import say_area, sides_of_part
from fieldhand.places.count_range import ANY, CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import Selector
from fieldhand.terms import AreaPart, Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class PointsIn(Selector):
    """``count`` free points spread evenly over a zone, or over the whole site without one; one point is its middle.
    With ``random``, drawn by ``seed``. With ``part``, in that half or quarter of it."""

    zone: str = ""
    count: int = 1
    random: bool = False
    seed: int = 0
    part: AreaPart = "all"

    @classmethod
    def example(cls, site: Site) -> PointsIn:
        return cls(zone=next((zone.name for zone in site.zones if zone.kind == "zone"), ""), count=9)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.over_zone import over_zone

        return over_zone(resolution.site, self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        zone = say_area(self.zone, self.part)
        if self.random:
            points = counted("{count} point", "{count} points", self.count)
            text = message(
                "{points} in {zone}, drawn at random (seed {seed})", points=points, zone=zone, seed=self.seed
            )
            return one(text) if self.count == 1 else many(text)
        if self.count == 1:
            return one(message("the middle of {zone}", zone=zone))
        return many(message("{count} points spread over {zone}", count=self.count, zone=zone))

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def sides(self) -> tuple[Side, ...]:
        return sides_of_part(self.part)

    @property
    def size(self) -> CountRange:
        return exactly(self.count) if self.count else ANY
