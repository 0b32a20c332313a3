"""Selector of the tree a number of trees along the row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places.noun_phrase import NounPhrase, one
from fieldhand.places.selector import Selector
from fieldhand.places.sources.here import Here
from fieldhand.terms import Side, Towards

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class AlongRow(Selector):
    """The tree that many ``trees`` along the row from ``origin``: down is away from the start marker, up towards it.

    Where the row ends before, its last tree.
    """

    trees: int
    towards: Towards = "down"
    origin: Selector = Here()

    counts_from_a_side = True

    @classmethod
    def example(cls, site: Site) -> AlongRow:
        return cls(trees=3)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.rows.along_and_across import along_row

        return along_row(resolution.one(self.origin), self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        start, way = self.origin.from_it(wording), _say_way(self.towards)
        if self.trees == 1:
            text = message("the next tree {down_the_row}", down_the_row=way)
        else:
            text = message("the tree {count} trees further {down_the_row}", count=self.trees, down_the_row=way)
        return one(message("{tree} from {place}", tree=text, place=start) if start else text)

    @property
    def single(self) -> bool:
        return True

    @property
    def sides(self) -> tuple[Side, ...]:
        return () if self.towards == "down" or self.towards == "up" else (self.towards,)


def _say_way(towards: Towards) -> str:
    """Return the direction along a row: "down the row", "along the row to the north"."""
    match towards:
        case "down":
            return message("down the row")
        case "up":
            return message("up the row")
    return message("along the row to the {side}", side=COMPASS[towards])
