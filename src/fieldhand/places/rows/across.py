"""Selector of the tree abreast in the next row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import Selector
from fieldhand.places.sources.here import Here
from fieldhand.terms import CountedFrom, Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Across(Selector):
    """The tree abreast of ``origin`` in the next row: the nearer one, or the one on ``side``."""

    origin: Selector = Here()
    side: CountedFrom = "usual"

    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> Across:
        return cls()

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.along_and_across import across

        return across(resolution.one(self.origin), self.side, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        place = self.origin.it(wording)
        if self.side == "usual":
            return one(message("the tree abreast of {place} in the next row", place=place))
        return one(
            message("the tree abreast of {place} in the next row to the {side}", place=place, side=COMPASS[self.side])
        )

    @property
    def single(self) -> bool:
        return True

    @property
    def sides(self) -> tuple[Side, ...]:
        return () if self.side == "usual" else (self.side,)
