"""Trees by their numbers in their row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.ordinals import say_ordinal, say_ranked_tree
from fieldhand.places.rows.counted_from import many_from
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
class InRow(FromGroup):
    """Trees ``first`` to ``last`` along each row of ``of``; negative numbers count from the row's other end.

    They count from north, or from west where rows run east-west, or from the side ``counted_from``: what stands, or by
    the file's own numbers.
    """

    first: int
    last: int
    counted_from: CountedFrom = "usual"
    of: Selector = Trees()

    reference_rule = "group"
    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> InRow:
        return cls(first=2, last=-2)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.by_number import in_row

        return in_row(of, self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        return many_from(self._of_rows(wording.phrase(self.of)), self.counted_from)

    def _of_rows(self, group: NounPhrase) -> str:
        """Return the trees with the rows of the group: "trees 4 to 9 of rows 2 to 5"."""
        numbered = self._numbers()
        if not group.bare:
            return message("{numbered} of each row among {trees}", numbered=numbered, trees=group.group())
        if not group.row:
            of = message("of {part}", part=group.block) if group.block else ""
            return message("{numbered} of each row {of_block}", numbered=numbered, of_block=of)
        if group.one_row or not group.row.startswith(("rows", "the rows")):
            return message("{numbered} of {rows}", numbered=numbered, rows=group.rows_and_block)
        return message("{numbered} of each of {rows}", numbered=numbered, rows=group.rows_and_block)

    def _numbers(self) -> str:
        """Return the trees of a row in words: "trees 4 to 9", "tree 4", "the last 3 trees"."""
        first, last = self.first, self.last
        if first == last:
            if first >= 0:
                return message("tree {number}", context="in a row", number=first)
            return say_ranked_tree(first)
        if last == -1 and first < 0:
            return message("the last {count} trees", count=-first)
        if first == 1 and last > 0:
            return message("the first {count} trees", count=last)
        if first > 0 and last > 0:
            return message("trees {first} to {last}", first=first, last=last)
        return message("the {first} to the {last} tree", first=say_ordinal(first, "one"), last=say_ordinal(last, "one"))
