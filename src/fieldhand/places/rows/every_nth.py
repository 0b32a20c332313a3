"""Every n-th tree along each row."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.language import joined, message
from fieldhand.places.noun_phrase import NounPhrase
from fieldhand.places.ordinals import say_ordinal
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
class EveryNth(FromGroup):
    """Every ``nth`` tree along each row of ``of``, from tree ``start`` on (1, 4, 7 for 3); they count as for
    :class:`InRow`, on from row to row where no row has ``nth``."""

    nth: int
    start: int = 1
    counted_from: CountedFrom = "usual"
    of: Selector = Trees()

    reference_rule = "group"
    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> EveryNth:
        return cls(nth=3)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.by_number import every_nth

        return every_nth(of, self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group = wording.phrase(self.of)
        text = self._of_rows(group) if group.bare else self._of_trees(group.group())
        if self.start != 1:
            text = message("{trees}, from the {ordinal} on", trees=text, ordinal=say_ordinal(self.start, "one"))
        return replace(many_from(text, self.counted_from), every=True)

    def _of_rows(self, group: NounPhrase) -> str:
        each = "" if group.row else message("of each row")
        of = joined(" ", [part for part in (each, group.of_what) if part])
        match self.nth:
            case 1:
                return message("every tree {of_rows}", of_rows=of)
            case 2:
                return message("every other tree {of_rows}", of_rows=of)
        return message("every {ordinal} tree {of_rows}", ordinal=say_ordinal(self.nth), of_rows=of)

    def _of_trees(self, trees: str) -> str:
        match self.nth:
            case 1:
                return message("every one of {trees}", trees=trees)
            case 2:
                return message("every other one of {trees}", context="trees", trees=trees)
        return message("every {ordinal} one of {trees}", ordinal=say_ordinal(self.nth), trees=trees)
