"""The tree at the start."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class First(FromGroup):
    """The tree nearest to the start marker; the first of the file without one."""

    of: Selector = Trees()

    @classmethod
    def example(cls, site: Site) -> First:
        return cls()

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.ranks import nearest_to_marker

        found = nearest_to_marker(of, "start", notes)
        return of.keep([int(of.file_order.argmin())]) if found is None else found

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group = wording.phrase(self.of)
        if group.plain:
            return one(message("the first tree"))
        return one(message("the first of {trees}", trees=group.group()))

    @property
    def single(self) -> bool:
        return True
