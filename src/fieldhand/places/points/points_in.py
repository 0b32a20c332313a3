"""Free points spread over a zone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import say_zone
from fieldhand.places.phrase import Phrase, many, one
from fieldhand.places.selector import Selector
from fieldhand.places.size import ANY, Range, exactly

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class PointsIn(Selector):
    """``count`` free points spread evenly over a zone; one point is its middle."""

    zone: str
    count: int = 1

    @classmethod
    def example(cls, site: Site) -> PointsIn:
        return cls(zone=next((zone.name for zone in site.zones if zone.kind == "zone"), ""), count=9)

    def resolve(self, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.points.over_zone import over_zone

        return over_zone(resolution.site, self, tell)

    def phrase(self, saying: Saying) -> Phrase:
        zone = say_zone(self.zone)
        if self.count == 1:
            return one(message("the middle of {zone}", zone=zone))
        return many(message("{count} points spread over {zone}", count=self.count, zone=zone))

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def size(self) -> Range:
        return exactly(self.count) if self.count else ANY
