"""The farthest from places."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selection_phrase import picked_phrase, the_most
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Farthest(Counted):
    """The ``count`` trees of ``of`` farthest from ``origin``."""

    origin: Selector
    count: int = 1
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Farthest:
        return cls(origin=Here(), count=5)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.neighbours.distances import apart_from, distance_to
        from fieldhand.places.ranks import rank

        origin = resolution.origin(self.origin)
        candidates = apart_from(of, origin).once(self.count if self.count > 1 else len(of))
        notes.candidates = len(candidates)
        self.need(candidates, resolution)
        return rank(candidates, -distance_to(candidates, origin), self.count, notes, the_most("farthest"))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        far = message("farthest from there")
        if self.origin.from_it(wording):
            far = message("farthest from {place}", place=self.origin.as_origin(wording))
        return picked_phrase(wording.phrase(self.of), self.count, far)

    @property
    def measured_from(self) -> Selector:
        return self.origin
