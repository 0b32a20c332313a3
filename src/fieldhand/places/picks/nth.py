"""The place of a number in an order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places.faults import too_few
from fieldhand.places.phrase import Phrase
from fieldhand.places.picks.ordered import Ordered
from fieldhand.places.selector import FromGroup, Selector

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
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

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        if self.nth == 0:
            raise PlaceError(
                message("places count from 1"), advice=message("ask for the first, or with -1 for the last")
            )
        if len(of) < abs(self.nth):
            raise too_few(resolution.site, self.of, abs(self.nth), len(of))
        return of.keep([self.nth - 1 if self.nth > 0 else len(of) + self.nth])

    def phrase(self, saying: Saying) -> Phrase:
        return self.of.nth_phrase(self.nth, saying)

    @property
    def single(self) -> bool:
        return True
