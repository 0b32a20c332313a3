"""Constructions of rounds: corners that are visited clockwise or against the clock, from one of them on."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_corners
from fieldhand.terms import CornerName

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_CLOCKWISE: tuple[CornerName, ...] = ("nw", "ne", "se", "sw")


@construction(
    "first_corner: STARTING [DET] side=DIR [noun=CORNER] [TREE]",
    "first_corner: STARTING [DET] side=DIR ONE",
    "first_corner: FROM [DET] side=DIR [noun=CORNER] [TREE]",
    cost=0.1,
)
def first_corner(side: Lex, noun: Lex | None = None) -> CornerName | None:
    """Compose "starting in the north-west corner"."""
    known = side.value in CORNERS and (noun is None or not noun.plural)
    return side.value if known else None


@construction(
    "place: corners=place [COMMA] way=CLOCKWISE",
    "place: corners=place [COMMA] start=first_corner [COMMA] [and_or_but] way=CLOCKWISE",
    "place: corners=place [COMMA] way=CLOCKWISE [COMMA] [and_or_but] start=first_corner",
    cost=0.1,
)
def corners_round(
    corners: PlaceMeaning, way: Lex, start: CornerName | None = None
) -> list[PlaceMeaning] | PlaceMeaning | None:
    """Compose "the corners clockwise, starting in the north-west"; without a start each corner may be meant."""
    known = as_corners(corners.selector)
    if known is None or corners.in_order or len(known.which) < 3 or start not in (None, *known.which):
        return None
    starts = known.which if start is None else (start,)
    return [_from(corners, known, first, against="against" in way.features) for first in starts]


@construction("place: first=place [COMMA] [AND] then OTHERS [COMMA] way=CLOCKWISE", cost=0.1)
def others_round(first: PlaceMeaning, way: Lex) -> PlaceMeaning | None:
    """Compose "the south-west corner, then the others clockwise"."""
    known = as_corners(first.selector)
    if known is None or len(known.which) != 1:
        return None
    every = replace(known, which=_CLOCKWISE)
    return _from(first, every, known.which[0], against="against" in way.features)


def _from(place: PlaceMeaning, corners: s.Corners, first: CornerName, *, against: bool) -> PlaceMeaning:
    """Return corners in the order of a round that begins with one of them."""
    turn = tuple(reversed(_CLOCKWISE)) if against else _CLOCKWISE
    begin = turn.index(first)
    order = [corner for corner in (*turn[begin:], *turn[:begin]) if corner in corners.which]
    parts = tuple(replace(corners, which=(corner,)) for corner in order)
    return replace(place, selector=s.UnionOf(parts=parts), shape="several", count=len(parts), each=False, in_order=True)
