"""Constructions of the ends of areas that are no rows: "the west end of the warm section", "both ends of the slope"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.places.sampling import bare_points, is_keep_out, whole_zone
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, is_one_row
from fieldhand.site.model import Site
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Ratio of its extents from which on an area without rows is long in one direction.
_LONG = 1.5
#: The two ends of what lies along each axis.
_WEST_EAST: tuple[Side, ...] = ("west", "east")
_NORTH_SOUTH: tuple[Side, ...] = ("north", "south")


@construction("end_sides: [DET] side=DIR FINISH", "end_sides: DET side=DIR", cost=0.0)
def end_side(side: Lex) -> tuple[Side, ...] | None:
    """Compose "the west end"."""
    return (side.value,) if side.value in SIDES else None


@construction(
    "zone_ends: first=end_sides [COMMA] AND [AT] [DET] side=DIR FINISH",
    "zone_ends: first=end_sides [COMMA] then [AT] [DET] side=DIR FINISH",
    "zone_ends: [DET] side=DIR FINISH",
    cost=0.0,
)
def ends_named(side: Lex, first: tuple[Side, ...] = (), then: str = "") -> tuple[Side, ...] | None:
    """Compose "the west end and the east end" and "at the north and at the south end"."""
    del then
    return (*first, side.value) if side.value in SIDES and side.value not in first else None


@construction(
    "place: ends=zone_ends OF whole=region", "place: ends=zone_ends OF whole=region [COMMA] AND [AT] last=own_end",
    "place: ends=zone_ends OF whole=region [COMMA] [AND] then [AT] last=own_end",
    cost=0.1, given=("site",),
)  # fmt: skip
def ends_of_area(
    ends: tuple[Side, ...], whole: s.Selector, site: Site, last: tuple[Side, ...] = ()
) -> PlaceMeaning | None:
    """Compose "the west end and the east end of the warm section" and "... of the slope, then its east end"."""
    if {*ends} & {*last}:
        return None
    ends = (*ends, *last)
    parts = [_end(whole, side, site) for side in ends]
    known = [part for part in parts if part is not None]
    if len(known) < len(ends):
        return None
    if len(known) == 1:
        return PlaceMeaning(known[0], "one")
    return PlaceMeaning(s.UnionOf(parts=tuple(known)), "several", count=len(known), in_order=True)


@construction("own_end: ITS side=DIR FINISH", "own_end: DET side=DIR FINISH", "own_end: DET side=DIR ONE", cost=0.0)
def own_end(side: Lex) -> tuple[Side, ...] | None:
    """Compose "its east end" and "the eastern one", of the area that was just named."""
    return (side.value,) if side.value in SIDES else None


@construction(
    "place: [BOTH] [DET] [n=count] noun=FINISH OF whole=region", "place: each=ANY noun=FINISH OF whole=region",
    "place: each=EACH noun=FINISH OF whole=region",
    cost=0.2, given=("site",),
)  # fmt: skip
def both_ends_of_area(
    noun: Lex, whole: s.Selector, site: Site, n: int = 2, each: Lex | None = None
) -> list[PlaceMeaning] | None:
    """Compose "both ends of the slope": which two, if it is not long in one direction?"""
    if n != 2 or are_rows(whole) or not whole_zone(whole) or (each is None and not noun.plural):
        return None
    made = [ends_of_area(ends, whole, site) for ends in _axes(whole, site)]
    return [one for one in made if one is not None] or None


def _axes(whole: s.Selector, site: Site) -> list[tuple[Side, ...]]:
    """Return the two ends of an area, along its rows or its longer side; those of both axes if neither tells."""
    rows = {block.runs_east_west for block in site.planting.blocks} if bare_points(whole, site, 1) is None else set()
    if len(rows) == 1:
        return [_WEST_EAST if rows.pop() else _NORTH_SOUTH]
    west, south, east, north = whole.ground(Resolution(site, Context(here=site.start))).bounds
    if max(east - west, north - south) < _LONG * min(east - west, north - south):
        return [_WEST_EAST, _NORTH_SOUTH]
    return [_WEST_EAST if east - west > north - south else _NORTH_SOUTH]


def _end(whole: s.Selector, side: Side, site: Site) -> s.Selector | None:
    """Return the end of an area: the middle of an edge of its plants, or of a half of its ground; None for a row."""
    if not whole_zone(whole) or is_keep_out(whole, site):
        return None
    if bare_points(whole, site, 1) is not None:
        return bare_points(s.Half(side=side, of=whole), site, 1)
    rows = rows_out_of(whole, site)
    return None if rows is not None and is_one_row(rows) else s.EdgeMiddle(side=side, of=whole)
