"""Trees in the row of a place, or some rows from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class RowOf(FromGroup):
    """Trees in the same row as ``origin``, or ``over`` rows from it (1 the next higher number, -1 the next lower)."""

    origin: Selector = Here()
    over: int = 0
    of: Selector = Trees()

    reference_rule = "group"
    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> RowOf:
        return cls(over=1)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.row_range import row_of

        return row_of(of, resolution.spots(self.origin), self.over, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return wording.phrase(self.of).of_rows(_row_of(self.over, self.origin.from_it(wording)), one=True)

    @property
    def row_of(self) -> Selector:
        return self.origin


def _row_of(over: int, origin: str) -> str:
    """Return the row of a place, or a row near it, in words; of the current place if there is no origin."""
    if over == 0:
        return message("the row of {place}", place=origin) if origin else message("the same row")
    if over == 1:
        return message("the row after that of {place}", place=origin) if origin else message("the row after this one")
    if over == -1:
        return message("the row before that of {place}", place=origin) if origin else message("the row before this one")
    if over > 0:
        if origin:
            return message("the row {count} rows after that of {place}", count=over, place=origin)
        return message("the row {count} rows after this one", count=over)
    if origin:
        return message("the row {count} rows before that of {place}", count=-over, place=origin)
    return message("the row {count} rows before this one", count=-over)
