"""Any few of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.filters.other import Other
from fieldhand.places.filters.where import Where
from fieldhand.places.phrase import Phrase, many, one
from fieldhand.places.selector import Counted, DependsOn, Selector

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Take(Counted):
    """Any ``count`` of ``of``: the nearest to the place in hand, so that the drive is short."""

    count: int
    of: Selector

    ground_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Take:
        return cls(count=10, of=Where(attribute="age_years", test="gt", value=10.0))

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.filters.zones import outside_keep_outs
        from fieldhand.places.neighbours.distances import short_drive

        free = outside_keep_outs(of, tell).once(self.count)
        self.need(free, resolution)
        tell.rule = "from the place in hand to the nearest, from there to the next nearest"
        return short_drive(free, resolution.context.here.xy, self.count)

    def phrase(self, saying: Saying) -> Phrase:
        inner = saying.phrase(self.of)
        if self.count == 1:
            if self.of == Other():
                return one(message("another tree, the nearest one not visited yet"))
            return inner if inner.single else one(message("the nearest of {trees}", trees=inner.group()))
        return many(message("the {count} nearest of {trees}", count=self.count, trees=inner.group()))

    @property
    def depends_on(self) -> DependsOn:
        return "nearness"

    @property
    def any_of(self) -> Selector:
        return self.of
