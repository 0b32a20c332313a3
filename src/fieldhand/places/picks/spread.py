"""Selector of trees far from each other, as a sample that represents an area."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.filters.where import Where
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Spread(Counted):
    """``count`` of ``of``, spread far from each other."""

    count: int
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Spread:
        return cls(count=10, of=Where(attribute="age_years", test="gt", value=10.0))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.filters.zones import outside_keep_outs
        from fieldhand.places.picks.far_apart import far_apart

        free = outside_keep_outs(of, notes).once(self.count)
        return far_apart(free, self.enough(free, resolution, notes), notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group = wording.phrase(self.of).group()
        if self.count == 1:
            return one(message("the one of {trees} nearest to their middle", trees=group))
        return many(message("{count} of {trees}, spread far from each other", count=self.count, trees=group))

    @property
    def keeps_order(self) -> bool:
        return False
