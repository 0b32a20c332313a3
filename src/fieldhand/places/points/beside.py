"""Trees seen from one side, or from both."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import COMPASS, say_tree
from fieldhand.places.count_range import CountRange, exactly
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import Side, TreeSide

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Place, Site


@dataclass(frozen=True, kw_only=True)
class Beside(FromGroup):
    """Trees of ``of``, each worked on from its aisle on ``side``; ``both``: each twice, from either side of its row.

    A tree in a row that runs north to south has an east and a west side, else a north and a south side.
    """

    side: TreeSide
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Beside:
        from fieldhand.places.sources.tree_is import TreeIs

        return cls(side="both", of=TreeIs(tree=site.trees[0].place.id))

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        return resolution.group(*_sided(of, self.side))

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        trees = wording.phrase(self.of)
        if self.side == "both":
            return NounPhrase(closed=message("both sides of {trees}", trees=trees.say()), listed=True)
        side = COMPASS[self.side]
        if self.of.single:
            return one(message("the {side} side of {tree}", side=side, tree=self.of.it(wording)))
        return many(message("the {side} side of {trees}", side=side, trees=trees.say()))

    @property
    def single(self) -> bool:
        return self.side != "both" and self.of.single

    @property
    def size(self) -> CountRange:
        return self.of.size.times(exactly(2)) if self.side == "both" else self.of.size

    @property
    def sides(self) -> tuple[Side, ...]:
        return () if self.side == "both" else (self.side,)

    def aside(self, phrase: str) -> str:
        return phrase if self.of.aside(phrase) else ""

    @property
    def named_tree(self) -> str:
        return self.of.named_tree


def _sided(group: PlaceGroup, side: TreeSide) -> Iterator[Place]:
    """Yield the places with their sides: of both, row after row, all of one side and then all of the other.

    Raises:
        PlaceError: A place is no tree, or has no such side.
    """
    planting = group.site.planting
    run: list[Place] = []
    before = -2
    for place, row, is_tree in zip(group.places, group.row.tolist(), group.is_tree.tolist(), strict=True):
        if not is_tree:
            raise PlaceError(
                message("{place} has no sides: only trees have", place=place.id), advice=message("name trees")
            )
        if row < 0:
            if side == "both":
                raise PlaceError(
                    message("{tree} is in no row, so it has no two sides", tree=say_tree(place.id)),
                    advice=message("name one side by the compass, or leave the sides out"),
                )
            yield replace(place, side=side)
            continue
        sides: tuple[Side, Side] = (
            ("north", "south") if planting.blocks[planting.rows[row].block].runs_east_west else ("west", "east")
        )
        if side != "both":
            if side not in sides:
                raise PlaceError(
                    message(
                        "{tree} has no {side} side: by the direction of its row its sides are {one} and {other}",
                        tree=say_tree(place.id),
                        side=COMPASS[side],
                        one=COMPASS[sides[0]],
                        other=COMPASS[sides[1]],
                    ),
                    advice=message("name one of these sides"),
                )
            yield replace(place, side=side)
            continue
        if row != before:
            yield from run
            run, before = [], row
        yield replace(place, side=sides[0])
        run.append(replace(place, side=sides[1]))
    yield from run
