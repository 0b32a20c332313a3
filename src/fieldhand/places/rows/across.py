"""The tree abreast in the next row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.phrase import Phrase, one
from fieldhand.places.selector import Selector
from fieldhand.places.sources.here import Here
from fieldhand.terms import CountedFrom, Side

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
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

    def resolve(self, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.rows.in_hand import across

        return across(resolution.one(self.origin), self.side, tell)

    def phrase(self, saying: Saying) -> Phrase:
        place = self.origin.it(saying)
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
