"""Selector of trees at even positions of a sequence: 3 of the next 5, 3 of every 5."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import counted, message
from fieldhand.places.count_range import CountRange, at_most, exactly
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.picks.ordered import Ordered
from fieldhand.places.place_errors import too_few
from fieldhand.places.rows.rows import Rows
from fieldhand.places.selector import Counted, Selector
from fieldhand.places.sources.trees import Trees

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site


@dataclass(frozen=True, kw_only=True)
class Evenly(Counted):
    """``count`` of ``of``, evenly along it, its ends included; of every ``out_of`` if given."""

    count: int
    out_of: int = 0
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Evenly:
        return cls(count=3, out_of=5, of=Rows.example(site))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return trees at even positions in the order of the group: its own order, else row by row.

        In an incomplete last group of ``out_of`` trees, those at the same positions are returned.
        """
        from fieldhand.places.filters.zones import outside_keep_outs

        if self.out_of and self.out_of < self.count:
            raise PlaceError(
                message("{count} of every {whole} is not possible", count=self.count, whole=self.out_of),
                advice=message("ask for at most {count}", count=self.out_of),
            )
        line = outside_keep_outs(of, notes).once(self.count)
        if not self.of.keeps_order and resolution.site.planting.blocks:
            line = Ordered(by="rows").choose(line, resolution, notes)
        if not self.out_of:
            self.need(line, resolution)
            return line.keep(_even(self.count, len(line)))
        if self.count < 1 or not len(line):
            raise too_few(resolution.site, self, self.count, len(line))
        left = len(line) % self.out_of
        if left:
            notes.remark(
                counted(
                    "the last group has only {count} of {whole} trees",
                    "the last group has only {count} of {whole} trees",
                    left,
                    whole=self.out_of,
                )
            )
        chosen = set(_even(self.count, self.out_of))
        return line.keep([k for k in range(len(line)) if k % self.out_of in chosen])

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        group = wording.phrase(self.of)
        if self.out_of:
            if group.plain:
                return many(message("{count} of every {whole} trees", count=self.count, whole=self.out_of))
            trees = group.group()
            return many(
                message("{count} of every {whole} of {trees}", count=self.count, whole=self.out_of, trees=trees)
            )
        if self.count == 1:
            return one(message("the middle one of {trees}", trees=group.group()))
        return many(message("{count} of {trees}, evenly along them", count=self.count, trees=group.group()))

    @property
    def single(self) -> bool:
        return self.count == 1 and not self.out_of

    @property
    def size(self) -> CountRange:
        return at_most(self.of.size) if self.out_of else exactly(self.count)


def _even(count: int, length: int) -> Sequence[int]:
    """Return positions evenly spread over a length including its ends; for one position, the middle."""
    if count == 1:
        return [(length - 1) // 2]
    gaps = count - 1
    return [(2 * k * (length - 1) + gaps) // (2 * gaps) for k in range(count)]
