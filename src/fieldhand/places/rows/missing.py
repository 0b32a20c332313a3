"""Selector of the gaps in rows: positions where a plant is missing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Missing(FromGroup):
    """The gaps in rows where a tree is missing, between two trees of ``of``; places of their own, not trees."""

    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Missing:
        return cls()

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the gaps both of whose neighbours in the row are in the group, row after row.

        Raises:
            PlaceError: There are no rows, or no gaps there.
        """
        from fieldhand.places.rows.gaps_between import gaps_between

        return gaps_between(of, self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group = wording.phrase(self.of)
        if group.plain:
            return many(message("the gaps where trees are missing"))
        if group.bare:
            return many(message("the gaps where trees of {part} are missing", part=group.rows_and_block))
        return many(message("the gaps where a tree is missing among {trees}", trees=group.group()))

    @property
    def keeps_order(self) -> bool:
        return False
