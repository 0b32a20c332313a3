"""Trees of a block."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.place_errors import no_such_block
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.site.names import say_block

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class InBlock(FromGroup):
    """Trees of one block, by the block's name or number."""

    block: str
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> InBlock:
        return cls(block=site.planting.blocks[0].name if site.planting.blocks else "")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the trees of the block of that name, or else those in the zones of that name."""
        from fieldhand.places.filters.zones import in_block, in_zones

        inside = in_block(of, self.block)
        if inside is None:
            inside = in_zones(of, self.block)
            if inside is None:
                raise no_such_block(resolution.site, self.block)
            notes.rule = "that is a zone of the site"
        return inside

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return wording.phrase(self.of).of_block(say_block(self.block))
