"""All but some trees."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import NoPlaceError
from fieldhand.language import message
from fieldhand.places.areas.half import Half
from fieldhand.places.count_range import CountRange, at_most
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Excluding(FromGroup):
    """Trees of ``of`` that are not among ``places``."""

    places: Selector
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Excluding:
        return cls(places=Half(side="south"))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        if not any(part.uses_records for part in self.places.walk()):
            return of.without(resolution.spots(self.places))
        try:
            return of.without(resolution.spots(self.places))
        except NoPlaceError as error:  # earlier missions did nothing of the kind, so that nothing is left out
            notes.remark(message("nothing is left out: {why}", why=error.what))
            return of

    def ground(self, resolution: Resolution) -> BaseGeometry:
        return self.of.ground(resolution).difference(self.places.ground(resolution))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return wording.phrase(self.of).keeping(after=self.places.left_out(wording))

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size)
