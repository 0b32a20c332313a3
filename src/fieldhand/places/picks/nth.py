"""The place of a number in an order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.picks.ordered import Ordered
from fieldhand.places.place_errors import too_few
from fieldhand.places.selector import FromGroup, Selector

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Nth(FromGroup):
    """The ``nth`` place of ``of`` in its order; -1 is the last."""

    nth: int
    of: Selector

    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> Nth:
        return cls(nth=2, of=Ordered(by="north_to_south"))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        if self.nth == 0:
            raise PlaceError(
                message("places are counted from 1"), advice=message("ask for the first, or with -1 for the last")
            )
        if len(of) < abs(self.nth):
            raise too_few(resolution.site, self.of, abs(self.nth), len(of))
        return of.keep([self.nth - 1 if self.nth > 0 else len(of) + self.nth])

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return self.of.nth_phrase(self.nth, wording)

    @property
    def single(self) -> bool:
        return True
