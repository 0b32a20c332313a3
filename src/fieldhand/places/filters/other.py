"""Trees that were not visited."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.phrase import Phrase
from fieldhand.places.selector import DependsOn, FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Other(FromGroup):
    """Trees that this mission has not visited."""

    of: Selector = Trees()

    ground_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Other:
        return cls()

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        return of.without(resolution.visited())

    def phrase(self, saying: Saying) -> Phrase:
        return saying.phrase(self.of).keeping(after=message("not visited yet"))

    @property
    def depends_on(self) -> DependsOn:
        return "mission"
