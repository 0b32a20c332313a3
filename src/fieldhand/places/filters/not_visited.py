"""Trees that were not visited."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import DependsOn, FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class NotVisited(FromGroup):
    """Trees that this mission has not visited."""

    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> NotVisited:
        return cls()

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        return of.without(resolution.visited())

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return wording.phrase(self.of).keeping(after=message("not visited yet"))

    @property
    def depends_on(self) -> DependsOn:
        return "mission"
