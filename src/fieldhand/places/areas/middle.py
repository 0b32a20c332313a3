"""The middle of a group."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.phrase import Phrase
from fieldhand.places.picked import picked
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Middle(Counted):
    """The ``count`` trees nearest to the centre of the extent of ``of``."""

    count: int = 1
    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> Middle:
        return cls()

    def choose(self, of: Spots, resolution: Resolution, tell: Tell) -> Spots:
        from fieldhand.places.areas.extent import from_centre
        from fieldhand.places.ranks import rank

        self.need(of, resolution)
        away = from_centre(of, resolution.ground(self.of, of, picks_too=False))
        return rank(of, away, self.count, tell, message("the nearest to the middle"))

    def phrase(self, saying: Saying) -> Phrase:
        if self.of == Trees():
            near = message("nearest to the middle of the site")
        else:
            near = message("nearest to the middle of their area")
        return picked(saying.phrase(self.of), self.count, near)

    @property
    def central(self) -> bool:
        return True
