"""Constructions of the sides of trees: "both sides of tree 4", "the east side of every vine", "from either side"."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct
from fieldhand.planning.grammar.meaning import CaptureCommand, PlaceMeaning, WorkCommand
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, is_gate, is_one_row
from fieldhand.site.model import Site
from fieldhand.terms import TreeSide

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Side of a row, as seen when driving it from its first tree to its last.
Hand = Literal["left", "right"]


@construction(
    "tree_side: EACHSIDE",
    "tree_side: BOTH [OF] [ITS] noun=SIDE",
    "tree_side: BOTH [OF] [DET] noun=SIDE",
    "tree_side: EACH noun=SIDE",
    cost=0.1,
)
def both_sides(noun: Lex | None = None) -> TreeSide | None:
    """Compose "both sides"; "each section" and "both parts" are none of a row."""
    return "both" if noun is None or "borders" in noun.features else None


@construction(
    "own_side: [DET] side=DIR SIDE", "own_side: ITS side=DIR SIDE", "own_side: [DET] side=DIR AISLE",
    "own_side: [DET] AISLE side=DIR OF IT", "own_side: [DET] AISLE [WHICH] [IS] AT side=own_side",
    "own_side: [DET] AISLE AT DET side=DIR OF IT", cost=0.1,
)  # fmt: skip
def compass_side(side: Lex | TreeSide) -> TreeSide | None:
    """Compose "the east side" and "the aisle to the west of it"."""
    if isinstance(side, str):
        return side
    return side.value if side.value in SIDES else None


def beside(place: PlaceMeaning, side: TreeSide) -> PlaceMeaning | None:
    """Return the side of a place, or both sides of it; None for what is spoken of, or has a side already."""
    if place.shape not in ("one", "several", "area") or place.per is not None or place.refers_back:
        return None
    if place.optional or place.at_most is not None or place.selector.named_marker:
        return None
    if any(isinstance(part, s.Beside | s.Spaced | s.PointsIn) or is_gate(part) for part in place.selector.walk()):
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


@construction("place: side=own_side OF place=place", cost=0.2, given=("site",))
def side_of_row(side: TreeSide, place: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "the west side of row 4", which runs north to south; the north side of it is one of its ends."""
    whole = place.shape == "area" or (place.shape == "several" and place.count is None)
    return beside(place, side) if whole and side in across_rows(place.selector, site) else None


@construction("hand: [DET] LEFTSIDE", "hand: ITS LEFTSIDE", "hand: DET LEFTHAND", cost=0.1)
def left() -> Hand:
    """Compose "the left side"."""
    return "left"


@construction("hand: [DET] RIGHTSIDE", "hand: ITS RIGHTSIDE", "hand: DET RIGHTHAND", cost=0.1)
def right() -> Hand:
    """Compose "the right side"."""
    return "right"


@construction("place: hand=hand OF place=place", cost=0.1, given=("site",))
def hand_of(hand: Hand, place: PlaceMeaning, site: Site) -> PlaceMeaning | None:
    """Compose "the left side of row 4", as seen when driving it from its first tree to its last."""
    if place.shape == "area" and not are_rows(place.selector):
        return None
    ways = _run_east_west(place.selector, site)
    if len(ways) != 1:
        return None
    return beside(place, _compass(hand, ways))


def _on_row_side(command: CaptureCommand, side: TreeSide) -> CaptureCommand | None:
    place = command.place
    return (
        None if place is None or (place.shape == "area" and not are_rows(place.selector)) else _on_side(command, side)
    )


@construction("adjunct: AT hand=hand", "adjunct: FROM hand=hand", "adjunct: ALONG hand=hand", cost=0.2, given=("site",))
def on_hand(hand: Hand, site: Site) -> Adjunct | None:
    """Compose "on the left side", behind trees of rows that all run the same way."""
    ways = {block.runs_east_west for block in site.planting.blocks}
    return Adjunct(_on_row_side, _compass(hand, ways), of_place=True, is_sentence=True) if len(ways) == 1 else None


@construction("adjunct: FROM side=own_side", "adjunct: AT side=own_side", cost=0.1, given=("site",))
def on_side_of_row(side: TreeSide, site: Site) -> Adjunct | None:
    """Compose "from the west side", of rows that run north to south."""
    ways = {block.runs_east_west for block in site.planting.blocks}
    if len(ways) != 1 or (side in ("north", "south")) not in ways:
        return None
    return Adjunct(_on_rows, _RowSide(side, site), of_place=True)


@dataclass(frozen=True, slots=True)
class _RowSide:
    """A side of rows, on a site."""

    side: TreeSide
    site: Site = field(compare=False)


def _on_rows(command: CaptureCommand, on: _RowSide) -> CaptureCommand | None:
    place = command.place
    if place is None or place.shape not in ("area", "several") or place.count is not None:
        return None
    return _on_side(command, on.side) if on.side in across_rows(place.selector, on.site) else None


def _compass(hand: Hand, ways: set[bool]) -> TreeSide:
    """Return the side of the compass of rows that run from north to south, or from west to east."""
    if True in ways:
        return "north" if hand == "left" else "south"
    return "east" if hand == "left" else "west"


def _run_east_west(selector: s.Selector, site: Site) -> set[bool]:
    """Return for the rows of trees whether they run east to west; empty if one of the trees is in no row."""
    planting = site.planting
    trees = [site.by_id[name].index for name in ids_of(selector, site) or () if name in site.by_id]
    rows = planting.row_of[trees].tolist()
    if not rows or min(rows) < 0:
        return set()
    return {planting.blocks[planting.rows[row].block].runs_east_west for row in rows}


def across_rows(selector: s.Selector, site: Site) -> set[TreeSide]:
    """Return the sides of rows, or of all plants of some, if they run the same way; empty for other places."""
    if not are_rows(selector) and (s.Trees() in selector.members or rows_out_of(selector, site) is None):
        return set()
    ways = _run_east_west(selector, site)
    return set() if len(ways) != 1 else {"north", "south"} if True in ways else {"east", "west"}


def _on_side(command: CaptureCommand, side: TreeSide) -> CaptureCommand | None:
    place = command.place
    if place is None or command.spacing is not None:
        return None
    if side == "both" and s.Trees() in (place.selector, *place.selector.members):
        return None  # "the trees on either side" are those beside another place
    sided = beside(place, side)
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


@construction("adjunct: TAKENSO FROM side=own_side", "adjunct: TAKENSO FROM [DET] dir=DIR", cost=0.1, given=("site",))
def taken_from_side(site: Site, side: TreeSide | None = None, dir: Lex | None = None) -> Adjunct | None:  # noqa: A002
    """Compose "taken from the south side", at which the robot stands at each plant."""
    where = side or (dir.value if dir is not None and dir.value in SIDES else None)
    return None if where is None else Adjunct(_taken_from, _RowSide(where, site), of_place=True)


def _taken_from(command: CaptureCommand, on: _RowSide) -> CaptureCommand | None:
    """Return captures on a side of plants of rows that run across it, or of a single plant."""
    place = command.place
    if place is None or (place.shape == "area" and not are_rows(place.selector)):
        return None
    if place.shape == "one":
        return _on_own_side(command, on.side)
    ways = _run_east_west(place.selector, on.site)
    return _on_side(command, on.side) if ways == {on.side in ("north", "south")} else None


@construction("adjunct: FROM [DET] side=DIR", cost=0.3)
def from_a_direction(side: Lex) -> Adjunct | None:
    """Compose "from the east", of a single tree."""
    return Adjunct(_on_own_side, side.value, of_place=True) if side.value in SIDES else None


@construction("each_from: FROM", cost=0.0)
@construction("each_from: each=EACH [ONE] FROM", "each_from: each=INEACHCASE [each=EACH] FROM", cost=0.0)
def each_from(each: Lex | None = None) -> bool:
    """Compose "from", and "each from" and "always from", which speak of a side and not of an order."""
    return each is not None


@construction("work: one=work [COMMA] [and_or_but] each=each_from [DET] side=DIR", cost=0.2, given=("site",))
def worked_from_a_side(one: WorkCommand, each: bool, side: Lex, used: int, site: Site) -> WorkCommand | None:
    """Compose "film row 4 from the east", which runs north to south; from the south it may be a direction."""
    if one.mode != "rows" or one.sides != "one" or one.along is None:
        return None
    in_one = each or is_one_row(one.along) or is_one_row(rows_out_of(one.along, site) or s.Trees())
    return replace(one, sides=side.value, used=used) if in_one and side.value in across_rows(one.along, site) else None


@construction(
    "work: one=work [COMMA] [AT] side=own_side", "work: one=work [COMMA] [and_or_but] each_from side=own_side",
    "work: one=work FULLSTOP each_from side=own_side", "work: each_from side=own_side [COMMA] one=work",
    "work: one=work [COMMA] ALONG side=own_side", "work: one=work [COMMA] GO AT side=own_side",
    "work: one=work [COMMA] GO ALONG side=own_side",
    "work: one=work [COMMA] GO ALONG side=own_side OF IT",
    "work: one=work [COMMA] GO ALONG side=own_side OF EACH [ONE]",
    "work: one=work [COMMA] STAYV AT side=own_side", cost=0.1, given=("site",),
)  # fmt: skip
def worked_on_one_side(one: WorkCommand, side: TreeSide, used: int, site: Site) -> WorkCommand | None:
    """Compose "spray rows 3 to 8 at 300 l/ha on the west side" and "film the carrots from the west side"."""
    if one.mode != "rows" or one.sides != "one" or one.along is None:
        return None
    sided = are_rows(one.along) or side in across_rows(one.along, site)
    return replace(one, sides=side, used=used) if sided else None


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
