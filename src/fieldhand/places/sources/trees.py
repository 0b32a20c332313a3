"""Every tree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.phrase import Phrase
from fieldhand.places.selector import Selector

if TYPE_CHECKING:
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.saying import Saying
    from fieldhand.places.spots import Spots
    from fieldhand.places.tell import Tell
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Trees(Selector):
    """Every tree of the site, in the order of the file."""

    @classmethod
    def example(cls, site: Site) -> Trees:
        return cls()

    def resolve(self, resolution: Resolution, tell: Tell) -> Spots:
        return resolution.every_tree()

    def phrase(self, saying: Saying) -> Phrase:
        return Phrase()
