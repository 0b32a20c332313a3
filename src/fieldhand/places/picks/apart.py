"""Trees at a distance from each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import counted, message
from fieldhand.language.words import say_number
from fieldhand.places.count_range import ANY, CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
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

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.picks.at_distance import at_distance

        return at_distance(of.once(self.count), self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group, count = wording.phrase(self.of), self.count
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
    def size(self) -> CountRange:
        return exactly(self.count) if self.count else ANY
