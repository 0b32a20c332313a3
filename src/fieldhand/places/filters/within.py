"""Trees at most so far from places, or farther away."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.language.words import say_number
from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Within(FromGroup):
    """Trees at most ``distance_m`` metres from ``to``, which itself does not count; with ``beyond`` those farther away.

    The nearest of several places counts: the trees of a row or a block as ``to``.
    """

    distance_m: float
    to: Selector
    beyond: bool = False
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> Within:
        return cls(distance_m=20.0, to=Here())

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.neighbours.distances import apart_from, within

        if not (math.isfinite(self.distance_m) and self.distance_m > 0):
            raise PlaceError(
                message("a distance of {distance} m is not possible", distance=Number(f"{self.distance_m:g}")),
                advice=message("ask for more than 0 m"),
            )
        to = resolution.origin(self.to)
        near = within(apart_from(of, to), to, self.distance_m)
        return apart_from(of, to).without(near) if self.beyond else near

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        distance, place = say_number(self.distance_m), self.to.as_origin(wording)
        if self.beyond:
            where = message("more than {distance} m from {place}", distance=distance, place=place)
        else:
            where = message("within {distance} m of {place}", distance=distance, place=place)
        return wording.phrase(self.of).keeping(after=where)

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)

    @property
    def measured_from(self) -> Selector:
        return self.to
