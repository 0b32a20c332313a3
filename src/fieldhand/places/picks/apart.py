"""Trees at a distance from each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import counted, message
from fieldhand.language.words import say_number
from fieldhand.places.phrase import Phrase, many
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.size import ANY, Range, exactly
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Apart(FromGroup):
    """``count`` trees of ``of``, each about ``apart_m`` metres from the one before it; with ``least``, at least so far
    from all."""

    apart_m: float
    count: int
    least: bool = False
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Apart:
        return cls(apart_m=25.0, count=5)

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.picks.at_distance import at_distance

        return at_distance(of.once(self.count), self, tell)

    def phrase(self, saying: Saying) -> Phrase:
        group, count = saying.phrase(self.of), self.count
        if group.plain:
            trees = counted("{count} tree", "{count} trees", count)
        else:
            trees = message("{count} of {trees}", count=count, trees=group.group())
        distance = say_number(self.apart_m)
        if self.least:
            return many(message("{trees}, at least {distance} m from each other", trees=trees, distance=distance))
        return many(message("{trees}, about {distance} m from each other", trees=trees, distance=distance))

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def single(self) -> bool:
        return self.count == 1

    @property
    def size(self) -> Range:
        return exactly(self.count) if self.count else ANY
