"""Free point at a distance and in a direction from a place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS, say_number
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.marker import Marker
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class PointAt(Selector):
    """The free point ``metres`` ``towards`` a side from ``origin``."""

    metres: float
    towards: Side
    origin: Selector = Here()

    @classmethod
    def example(cls, site: Site) -> PointAt:
        return cls(metres=10.0, towards="north", origin=Marker(name="start"))

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.at_bearing import point_at

        return point_at(self, resolution, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        side, metres, origin = COMPASS[self.towards], say_number(self.metres), self.origin.as_origin(wording)
        return one(message("the point {metres} m {north} of {place}", metres=metres, north=side, place=origin))

    @property
    def single(self) -> bool:
        return True

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.towards,)

    @property
    def from_start(self) -> Selector:
        return replace(self, origin=Marker(name="start")) if self.origin == Here() else self
