"""The middle of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selection_phrase import picked_phrase
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Middle(Counted):
    """The ``count`` trees nearest to the centre of the extent of ``of``."""

    count: int = 1
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Middle:
        return cls()

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import from_centre
        from fieldhand.places.ranks import rank

        self.need(of, resolution)
        away = from_centre(of, resolution.reference(self.of, of, picks_too=False))
        return rank(of, away, self.count, notes, message("the nearest to the middle"))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        if self.of == Trees():
            near = message("nearest to the middle of the site")
        else:
            near = message("nearest to the middle of their area")
        return picked_phrase(wording.phrase(self.of), self.count, near)

    @property
    def central(self) -> bool:
        return True
