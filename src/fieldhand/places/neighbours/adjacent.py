"""Trees next to each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.faults import too_few
from fieldhand.places.phrase import Phrase, many
from fieldhand.places.picked import picked
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
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

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.neighbours.distances import side_by_side

        near = resolution.origin(self.near)
        self.need(of, resolution)
        tell.rule = "each is a neighbour of one before it, in the same row first"
        found = side_by_side(of, near, self.count)
        if len(found) < self.count:
            raise too_few(resolution.site, self, self.count, len(found))
        return found

    def phrase(self, saying: Saying) -> Phrase:
        near, count = self.near.as_origin(saying), self.count
        group = saying.phrase(self.of)
        if count == 1:
            return picked(group, 1, message("nearest to {place}", place=near))
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
