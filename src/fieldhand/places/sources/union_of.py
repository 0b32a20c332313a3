"""Several selectors together."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import listed
from fieldhand.places.areas.corners import Corners
from fieldhand.places.count_range import CountRange
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.picks.first import First
from fieldhand.places.picks.last import Last
from fieldhand.places.place_errors import nothing
from fieldhand.places.selector import Selector

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class UnionOf(Selector):
    """All places of the parts, in their order, each once."""

    parts: tuple[Selector, ...]

    @classmethod
    def example(cls, site: Site) -> UnionOf:
        return cls(parts=(First(), Last(), Corners()))

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        if not self.parts:
            raise nothing(resolution.site, self, "it has no parts")
        return resolution.joined([resolution.spots(part) for part in self.parts])

    def ground(self, resolution: Resolution) -> BaseGeometry:
        import shapely

        return shapely.union_all([part.ground(resolution) for part in self.parts])

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        trees = [part.named_tree for part in self.parts if part.named_tree]
        if len(self.parts) == 1:
            return wording.phrase(self.parts[0])
        if trees and len(trees) == len(self.parts):
            return many(message("trees {ids}", ids=listed(trees)))
        text = listed([wording.phrase(part).say() for part in self.parts])
        return replace(many(text or message("no place at all")), listed=True)

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def single(self) -> bool:
        return len(self.parts) == 1 and self.parts[0].single

    @property
    def members(self) -> tuple[Selector, ...]:
        return self.parts

    @property
    def size(self) -> CountRange:
        """At most the sum of the parts' sizes; exactly the sum if every part is a different named tree."""
        sizes = [part.size for part in self.parts]
        highs = [size.high for size in sizes if size.high is not None]
        total = sum(highs) if len(highs) == len(sizes) else None
        apart = all(part.named_tree for part in self.parts) and len(set(self.parts)) == len(self.parts)
        return CountRange(low=total if apart and total is not None else 1, high=total)

    def reference(self, *, picks_too: bool = True) -> Selector:
        return UnionOf(parts=tuple(part.reference(picks_too=picks_too) for part in self.parts))
