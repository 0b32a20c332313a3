"""Free points on the straight line from one place to another."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import counted, message
from fieldhand.language.words import say_number
from fieldhand.places.count_range import ANY, CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.marker import Marker

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class StraightLine(Selector):
    """Free points on the straight line from ``start`` to ``end``: ``count``, both ends among them, or every ``apart_m``
    metres."""

    start: Selector
    end: Selector
    count: int = 0
    apart_m: float = 0.0

    @classmethod
    def example(cls, site: Site) -> StraightLine:
        return cls(start=Marker(name="start"), end=Marker(name="end"), apart_m=20.0)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.between_places import points_between

        return points_between(self, resolution, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        ends = {"start": self.start.as_origin(wording), "end": self.end.as_origin(wording)}
        if self.apart_m:
            text = message(
                "the points every {metres} m on the straight line from {start} to {end}",
                metres=say_number(self.apart_m),
                **ends,
            )
            return many(text)
        points = counted("{count} point", "{count} points", self.count)
        text = message("{points} on the straight line from {start} to {end}", points=points, **ends)
        return one(text) if self.count == 1 else many(text)

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def single(self) -> bool:
        return self.count == 1 and not self.apart_m

    @property
    def size(self) -> CountRange:
        return exactly(self.count) if self.count and not self.apart_m else ANY

    @property
    def from_start(self) -> Selector:
        begin = Marker(name="start") if self.start == Here() else self.start
        return replace(self, start=begin)
