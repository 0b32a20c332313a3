"""Constructions of several parts of one area: "at the four corners and in the middle of the slope"."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.sampling import bare_zone, is_keep_out
from fieldhand.planning.grammar.places.zone_sides import Sides, on_side, on_sides
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    are_rows,
    as_corners,
    as_edge,
    as_in_row,
    as_some,
    as_spread_points,
    as_zone,
    chooses_from_trees,
    compass_part,
    over,
    swapped,
)
from fieldhand.site.model import Site
from fieldhand.terms import AreaPart

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Parts of an area that is named behind them: its middle or its corners, or sides.
AreaParts = tuple[s.Selector | Sides, ...]


def is_part(places: s.Selector) -> bool:
    """Return True for the middle or corners of nothing that is named."""
    corners = as_corners(places)
    return places == s.Middle() or (corners is not None and corners.of == s.Trees() and not corners.zone)


def side_named(places: s.Selector) -> bool:
    """Return True for a half, a quarter or an edge, and for points of one: what has another on the other side."""
    half_or_edge = compass_part(places) is not None or as_edge(places) is not None
    return half_or_edge or getattr(places, "part", "all") != "all"


def part_within(places: s.Selector) -> s.Selector | None:
    """Return the middle, corners, half, quarter or end of nothing that is named in a selector; None without one."""
    for one in places.walk():
        side = side_named(one) and getattr(one, "of", s.Trees()) == s.Trees() and not getattr(one, "zone", "")
        end = as_in_row(one)
        if is_part(one) or side or (end is not None and end.of == s.RowOf() and end.counted_from in SIDES):
            return one
    return None


def part_of_ground(
    places: s.Selector, part: s.Selector, ground: s.Selector, site: Site, *, tree: bool = False
) -> s.Selector | None:
    """Return places with a part of the site in them as that of an area; None if it has no such part.

    Args:
        places: Places.
        part: Their middle, corners, half, quarter or end, as :func:`part_within` finds it.
        ground: Area.
        site: Site.
        tree: True for "the middle tree" of a zone, and not a point in its middle.
    """
    zone = as_zone(ground)
    if zone is not None and (zone.outside or zone.margin_m or zone.of != s.Trees()):
        return None
    if zone is not None and bare_zone(ground, site):
        return _of_bare_ground(places, part, zone, site)
    if zone is not None and part == s.Middle() and not tree:
        return swapped(places, part, s.PointsIn(zone=zone.zone))
    rows_have_none = are_rows(ground) and as_corners(part) is not None
    if not chooses_from_trees(ground) or ground.relative or rows_have_none or not hasattr(part, "of"):
        return None
    return None if as_in_row(part) is not None else swapped(places, part, over_ground(part, ground))


def over_ground(part: s.Selector, ground: s.Selector) -> s.Selector:
    """Return a part of the site as that of an area with plants; a half of a zone is not that of the site in it."""
    return swapped(part, s.Trees(), ground) if as_zone(ground) is not None else over(part, ground)


def _of_bare_ground(places: s.Selector, part: s.Selector, zone: s.InZone, site: Site) -> s.Selector | None:
    """Return places with a part of a zone in which nothing grows."""
    corners, end = as_corners(part), as_in_row(part)
    side = end.counted_from if end is not None else _side_of(part)
    some = as_some(places)
    if corners is not None:
        return swapped(places, part, s.Corners(which=corners.which, zone=zone.zone))
    if end is not None or as_edge(part) is not None or is_keep_out(zone, site):
        return swapped(places, part, on_side(zone, side)) if side in SIDES else None
    if part == s.Middle():
        return swapped(places, part, s.PointsIn(zone=zone.zone))
    if some is not None and some.of == part:
        return s.PointsIn(zone=zone.zone, count=some.count, part=cast(AreaPart, side))
    free = as_spread_points(part)
    return swapped(places, part, swapped(part, s.Trees(), zone) if free is None else replace(free, zone=zone.zone))


def _side_of(part: s.Selector) -> str:
    """Return the side or the corner of a half or a quarter, or of the points in one; empty for other places."""
    named, edge = compass_part(part), as_edge(part)
    if edge is not None:
        return edge.side
    return named[0] if named is not None else str(getattr(part, "part", ""))


@construction("area_part: [DET] MIDDLE", cost=0.0)
def middle_part() -> AreaParts:
    """Compose "the middle"."""
    return (s.Middle(),)


@construction("area_part: [DET] [n=count] noun=CORNER", "area_part: each=EACH [OF] [DET] noun=CORNER", cost=0.0)
def corner_part(noun: Lex, n: int = 4, each: Lex | None = None) -> AreaParts | None:
    """Compose "the four corners" and "each corner"."""
    return (s.Corners(),) if n == 4 and (noun.plural or each is not None) else None


@construction("area_part: sides=zone_sides", cost=0.0)
def side_part(sides: Sides) -> AreaParts:
    """Compose "both ends"."""
    return (sides,)


@construction("area_parts: one=area_part", cost=0.0)
def area_parts(one: AreaParts) -> AreaParts:
    """Compose "the middle", the beginning of "the middle and the corners"."""
    return one


@construction(
    "area_parts: first=area_parts [COMMA] AND [AT] last=area_part",
    "area_parts: first=area_parts COMMA [AT] last=area_part",
    cost=0.0,
)
def more_area_parts(first: AreaParts, last: AreaParts) -> AreaParts | None:
    """Compose "the corners and in the middle"."""
    return None if last[0] in first else (*first, *last)


@construction("zone_spot: parts=area_parts OF area=region", cost=0.0, given=("site",))
def parts_of_area(parts: AreaParts, area: s.Selector, site: Site) -> PlaceMeaning | None:
    """Compose "the four corners and in the middle of the slope"."""
    if len(parts) < 2 or all(isinstance(part, Sides) for part in parts) or are_rows(area):
        return None
    made: list[s.Selector] = []
    for part in parts:
        if isinstance(part, Sides):
            place = on_sides(part, site, area)
            found = None if place is None else place.selector
        else:
            found = part_of_ground(part, part, area, site)
        if found is None:
            return None
        made += found.members
    return PlaceMeaning(s.UnionOf(parts=tuple(made)), "several", each=True)
