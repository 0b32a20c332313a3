"""Constructions of the sides of trees: "both sides of tree 4", "the east side of every vine", "from either side"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct
from fieldhand.planning.grammar.meaning import CaptureCommand, PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.terms import TreeSide

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction(
    "tree_side: EACHSIDE",
    "tree_side: BOTH [OF] [ITS] SIDE",
    "tree_side: BOTH [OF] [DET] SIDE",
    "tree_side: EACH SIDE",
    cost=0.1,
)
def both_sides() -> TreeSide:
    """Compose "both sides"."""
    return "both"


@construction("own_side: [DET] side=DIR SIDE", "own_side: ITS side=DIR SIDE", cost=0.1)
def compass_side(side: Lex) -> TreeSide | None:
    """Compose "the east side"."""
    return side.value if side.value in SIDES else None


def beside(place: PlaceMeaning, side: TreeSide) -> PlaceMeaning | None:
    """Return the side of a place, or both sides of it; None for what is spoken of, or has a side already."""
    if place.shape not in ("one", "several", "area") or place.per is not None or place.like is not None:
        return None
    if place.optional or place.at_most is not None or place.selector.named_marker:
        return None
    if any(isinstance(part, s.Beside | s.Spaced | s.PointsIn | s.GateIs) for part in place.selector.walk()):
        return None
    sided = s.Beside(side=side, of=place.selector)
    if side != "both":
        shape = "one" if place.shape == "one" else "several"
        return replace(place, selector=sided, shape=shape, each=shape == "several")  # type: ignore[arg-type]
    count = 2 if place.shape == "one" else None if place.count is None else 2 * place.count
    return replace(place, selector=sided, shape="several", each=True, count=count)


@construction("place: side=tree_side OF place=place", "place: AT side=tree_side OF place=place", cost=0.1)
def both_sides_of(side: TreeSide, place: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "both sides of tree 4"."""
    return beside(place, side)


@construction("place: side=own_side OF place=place", cost=0.2)
def side_of(side: TreeSide, place: PlaceMeaning) -> PlaceMeaning | None:
    """Compose "the east side of tree 4", and of each of several; the east side of an area is a part of it."""
    is_tree = place.shape == "one" and bool(place.selector.named_tree)
    return beside(place, side) if is_tree or (place.shape == "several" and place.each) else None


def _on_side(command: CaptureCommand, side: TreeSide) -> CaptureCommand | None:
    place = command.place
    sided = None if place is None or command.spacing is not None else beside(place, side)
    return None if sided is None else replace(command, place=sided)


@construction("adjunct: [AT] side=tree_side", "adjunct: FROM side=tree_side", cost=0.2)
def on_both_sides(side: TreeSide) -> Adjunct:
    """Compose "from both sides"."""
    return Adjunct(_on_side, side, of_place=True, is_sentence=True)


def _on_own_side(command: CaptureCommand, side: TreeSide) -> CaptureCommand | None:
    place = command.place
    one = place is not None and place.shape == "one" and bool(place.selector.named_tree)
    return _on_side(command, side) if one else None


@construction("adjunct: FROM side=own_side", "adjunct: AT side=own_side", cost=0.2)
def on_one_side(side: TreeSide) -> Adjunct:
    """Compose "from the east side", of a single tree: several are visited in that order."""
    return Adjunct(_on_own_side, side, of_place=True)


@construction("adjunct: FROM [DET] side=DIR", cost=0.3)
def from_a_direction(side: Lex) -> Adjunct | None:
    """Compose "from the east", of a single tree."""
    return Adjunct(_on_own_side, side.value, of_place=True) if side.value in SIDES else None


@construction(
    "adjunct: AT side=own_side OF EACH [TREE]",
    "adjunct: FROM side=own_side OF EACH [TREE]",
    "adjunct: AT side=own_side OF IT",
    "adjunct: AT ITS side=own_side",
    "adjunct: FROM ITS side=own_side",
    "adjunct: AT EACH side=own_side",
    cost=0.2,
)
def on_the_side_of_each(side: TreeSide) -> Adjunct:
    """Compose "on the east side of each", behind the trees."""
    return Adjunct(_on_side, side, of_place=True)
