"""The trees within a row spacing of the extreme."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase, many
from fieldhand.places.selection_phrase import superlative
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class AmongExtreme(FromGroup):
    """The trees within one row spacing of the extreme ("one of the northernmost trees" is one of these)."""

    side: Side
    of: Selector = Trees()

    reference_rule = "region"

    @classmethod
    def example(cls, site: Site) -> AmongExtreme:
        return cls(side="east")

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.areas.extent import among_extreme

        return among_extreme(of, self.side, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group, which = wording.phrase(self.of), superlative(f"{self.side}ernmost", 2)
        if group.plain:
            return many(message("the {northernmost} trees", northernmost=which))
        return many(message("the {northernmost} of {trees}", northernmost=which, trees=group.group()))

    @property
    def sides(self) -> tuple[Side, ...]:
        return (self.side,)
