"""Free points at a spacing along a line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import say_number, say_zone
from fieldhand.places.count_range import ANY, CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.marker import Marker
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Spaced(FromGroup):
    """``count`` free points ``apart_m`` metres apart, else as many as fit, on a line beside the row of ``of`` nearest
    to ``near``, from its end nearer to that; without rows, or inside a ``zone``, on a straight line."""

    apart_m: float
    count: int = 0
    near: Selector = Here()
    zone: str = ""
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Spaced:
        return cls(apart_m=15.0)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.on_line import on_line

        return on_line(of, resolution.origin(self.near), self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        apart, count = say_number(self.apart_m), self.count
        where, near = self._line(wording), self.near.as_origin(wording)
        if count == 1:
            return one(message("a point {where}, beginning at the end nearer to {place}", where=where, place=near))
        if count:
            points = message("{count} points {distance} m apart", count=count, distance=apart)
        else:
            points = message("as many points {distance} m apart as fit", distance=apart)
        return many(
            message("{points} {where}, beginning at the end nearer to {place}", points=points, where=where, place=near)
        )

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def size(self) -> CountRange:
        return exactly(self.count) if self.count else ANY

    @property
    def measured_from(self) -> Selector:
        return self.near

    @property
    def from_start(self) -> Selector:
        return replace(self, near=Marker(name="start")) if self.near == Here() else self

    def _line(self, wording: SelectorWording) -> str:
        """Return on which line the points lie."""
        group = wording.phrase(self.of)
        if self.zone:
            return message("on a line inside {zone}", zone=say_zone(self.zone))
        if group.bare and group.one_row:
            return message("beside {row}", row=group.rows_and_block)
        if group.plain:
            return message("beside the nearest row")
        return message("beside the nearest row of {trees}", trees=group.group())
