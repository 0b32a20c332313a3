"""Trees next to each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.place_errors import too_few
from fieldhand.places.selection_phrase import picked_phrase
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Adjacent(Counted):
    """``count`` trees next to each other: the tree of ``of`` nearest to ``near`` and then neighbour after neighbour."""

    near: Selector
    count: int = 2
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Adjacent:
        return cls(near=Here(), count=5)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.neighbours.distances import side_by_side

        near = resolution.origin(self.near)
        self.need(of, resolution)
        notes.rule = "each is a neighbour of one before it, in the same row first"
        found = side_by_side(of, near, self.count)
        if len(found) < self.count:
            raise too_few(resolution.site, self, self.count, len(found))
        return found

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        near, count = self.near.as_origin(wording), self.count
        group = wording.phrase(self.of)
        if count == 1:
            return picked_phrase(group, 1, message("nearest to {place}", place=near))
        if group.plain:
            return many(
                message(
                    "{count} trees next to each other, beginning with the one nearest to {place}",
                    count=count,
                    place=near,
                )
            )
        return many(
            message(
                "{count} of {trees} next to each other, beginning with the one nearest to {place}",
                count=count,
                trees=group.group(),
                place=near,
            )
        )

    @property
    def measured_from(self) -> Selector:
        return self.near
