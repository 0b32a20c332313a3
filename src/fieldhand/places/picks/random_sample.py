"""Selector of random trees, the same ones in preview, approval, execution and replay."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from hashlib import sha256
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
class RandomSample(Counted):
    """``count`` of ``of``, drawn at random.

    Attributes:
        seed: The same seed draws the same trees whenever it is drawn.
    """

    count: int
    seed: int = 0
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> RandomSample:
        return cls(count=10, of=Where(attribute="age_years", test="gt", value=10.0))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.filters.zones import outside_keep_outs

        free = outside_keep_outs(of, notes).once(self.count)
        count = self.enough(free, resolution, notes)
        notes.rule = message("drawn by seed {seed}", seed=self.seed)
        return drawn(free, count, self.seed)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group, seed = wording.phrase(self.of).group(), self.seed
        if self.count == 1:
            return one(message("one of {trees}, drawn at random (seed {seed})", trees=group, seed=seed))
        text = message("{count} of {trees}, drawn at random (seed {seed})", count=self.count, trees=group, seed=seed)
        return many(text)

    @property
    def keeps_order(self) -> bool:
        return False


def drawn(spots: PlaceGroup, count: int, seed: int) -> PlaceGroup:
    """Return a uniform random sample of ``count`` places, in the order of the file.

    Each place gets a number from the SHA-256 of the seed and its id, and the lowest are drawn (bottom-k sampling, Cohen
    and Kelley 2007), so the sample depends neither on a random generator nor on the order of the file.
    """
    prefix = f"{seed}\n".encode()
    lots = [sha256(prefix + place.id.encode()).digest() for place in spots.places]
    taken = heapq.nsmallest(count, range(len(lots)), key=lots.__getitem__)
    return spots.keep(sorted(taken, key=lambda k: int(spots.file_order[k])))
