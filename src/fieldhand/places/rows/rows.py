"""Selector of the trees of some rows."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.filters.in_block import InBlock
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.ordinals import say_ordinal
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import CountedFrom

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Rows(FromGroup):
    """Trees of row ``first`` (left out: the first) to row ``last`` (the last), or of each ``every``-th of these, from
    ``first`` on.

    A row is called by its name, or by its number in the block; -1 is the last row. Numbers count from west, or from
    north where rows run east-west, or from the side ``counted_from``. Of several blocks, ``of`` says which
    (:class:`InBlock`).
    """

    first: str = ""
    last: str = ""
    every: int = 1
    counted_from: CountedFrom = "usual"
    of: Selector = Trees()

    reference_rule = "group"
    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> Rows:
        return cls(first="2", last="-2", every=2, of=InBlock.example(site))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.row_range import in_rows

        return in_rows(of, self, resolution.reference(self.of, of), notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        rows, single = self._rows_in_words()
        return wording.phrase(self.of).of_rows(rows, one=single, outer=self._outer_rows())

    def _outer_rows(self) -> str:
        """Return the first and the last row in words; empty if they are not the ends of a range that is named."""
        first, last = self.first, self.last
        if first == last or self.every != 1 or self.counted_from != "usual" or not (_rises(first) and _rises(last)):
            return ""
        return message("rows {first} and {last}", first=_bare(first), last=_bare(last))

    def _rows_in_words(self) -> tuple[str, bool]:
        """Return the rows in words ("row 3", "all rows"), and True if it is a single row."""
        first, last = self.first, self.last
        side = "" if self.counted_from == "usual" else message("from the {side}", side=COMPASS[self.counted_from])
        if first and first == last:
            return _say_row(first, side), True
        if not first and not last:
            match self.every:
                case 1:
                    return message("all rows {from_side}", from_side=side), False
                case 2:
                    return message("every other row {from_side}", from_side=side), False
            nth = say_ordinal(self.every, "row")
            return message("every {ordinal} row {from_side}", ordinal=nth, from_side=side), False
        if _rises(first) and _rises(last):
            span = message("rows {first} to {last} {from_side}", first=_bare(first), last=_bare(last), from_side=side)
        else:
            begins = _say_row(first, side) if first else message("the first row {from_side}", from_side=side)
            ends = _say_row(last, side) if last else message("the last row {from_side}", from_side=side)
            span = message("the rows from {first} to {last}", first=begins, last=ends)
        match self.every:
            case 1:
                return span, False
            case 2:
                return message("every other one of {rows}", rows=span), False
        return message("every {ordinal} one of {rows}", ordinal=say_ordinal(self.every, "row"), rows=span), False


def _say_row(row: str, side: str) -> str:
    if _is_name(row, side):
        return message("row {name}", name=_bare(row))
    if int(row) < -1:
        ordinal = say_ordinal(-int(row), "row")
        return message("the {ordinal} last row {from_side}", ordinal=ordinal, from_side=side)
    return message("the {ordinal} row {from_side}", ordinal=say_ordinal(int(row), "row"), from_side=side)


def _is_name(row: str, side: str) -> bool:
    """Return True if the text is a name or plain number, not counted from a side or from the last row."""
    return _rises(row) and not (side and row.strip().isdecimal())


def _rises(row: str) -> bool:
    """Return True for a name, or a number that does not count from the last row."""
    return bool(row) and re.fullmatch(r"-\d{1,9}", row.strip()) is None


def _bare(row: str) -> str:
    return row[4:] if row.lower().startswith("row ") else row
