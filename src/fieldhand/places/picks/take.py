"""Selector of any few places of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.filters.not_visited import NotVisited
from fieldhand.places.filters.where import Where
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import Counted, DependsOn, Selector

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Take(Counted):
    """Any ``count`` of ``of``: the nearest to the current place, so that the drive is short."""

    count: int
    of: Selector

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Take:
        return cls(count=10, of=Where(attribute="age_years", test="gt", value=10.0))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.filters.zones import outside_keep_outs
        from fieldhand.places.neighbours.distances import short_drive

        free = outside_keep_outs(of, notes).once(self.count)
        count = self.enough(free, resolution, notes)
        notes.rule = "from the current place to the nearest, and from there to the next nearest"
        return short_drive(free, resolution.context.here.xy, count)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        inner = wording.phrase(self.of)
        if self.count == 1:
            if self.of == NotVisited():
                return one(message("another tree, the nearest one not visited yet"))
            return inner if inner.single else one(message("the nearest of {trees}", trees=inner.group()))
        return many(message("the {count} nearest of {trees}", count=self.count, trees=inner.group()))

    @property
    def depends_on(self) -> DependsOn:
        return "nearness"

    @property
    def any_of(self) -> Selector:
        return self.of
