"""Constructions of parts that the site does not name: "the bottom of the slope", "the half nearest the gate"."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import cast

from fieldhand.errors import PlaceError, TaskError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution, resolve
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.places.points import Ground
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_zone, compass_part, is_one_row
from fieldhand.site.model import Site
from fieldhand.terms import AreaPart, Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Share of the site's ground from which on half of a zone may be "the half nearest the gate" of the site.
_LARGE = 0.2
#: Ratio of the distances along the two axes from which on a place lies to one side rather than to a corner.
_CLEARLY = 1.5
#: Parts of an area that a half and a quarter are.
_HALF, _QUARTER = 0.5, 0.25


@construction("region: [DET] OPENPART OF whole=region", "region: [DET] OPENPART in_ whole=region", cost=0.2)
def some_side_of(whole: s.Selector) -> list[s.Selector] | None:
    """Compose "the bottom of the slope": which side is that?"""
    if are_rows(whole) or any(compass_part(part) is not None or isinstance(part, s.Edge) for part in whole.walk()):
        return None
    return [s.Half(side=side, of=whole) for side in SIDES]


@construction("region: part=PART [OF] whole=region", cost=0.3, given=("site",))
def some_part_of(part: Lex, whole: s.Selector, site: Site) -> list[s.Selector] | None:
    """Compose "half of the paddock" and "a quarter of the meadow": which half or quarter is that?"""
    rows = rows_out_of(whole, site)
    if are_rows(whole) or (rows is not None and is_one_row(rows)):
        return None
    if any(compass_part(one) is not None or isinstance(one, s.Edge) for one in whole.walk()):
        return None
    if part.value == _QUARTER:
        return [s.Quarter(quarter=corner, of=whole) for corner in CORNERS]
    return [s.Half(side=side, of=whole) for side in SIDES] if part.value == _HALF else None


@construction("ground: part=PART [OF] whole=ground", cost=0.1)
def some_part_of_ground(part: Lex, whole: Ground) -> list[Ground] | None:
    """Compose "half of the paddock", of points in it: in which half?"""
    parts: dict[float, tuple[AreaPart, ...]] = {_HALF: SIDES, _QUARTER: CORNERS}
    if whole.part != "all":
        return None
    return [replace(whole, part=one) for one in parts.get(part.value, ())] or None


@construction(
    "region: [DET] HALF OF whole=region [COMMA] which_is AT [DET] side=DIR [SIDE]",
    "region: [DET] HALF OF whole=region AT [DET] side=DIR [SIDE]",
    cost=0.1,
)  # fmt: skip
def half_on_a_side(whole: s.Selector, side: Lex) -> s.Selector | None:
    """Compose "the half of the meadow that lies to the west"."""
    if are_rows(whole) or side.value not in SIDES or compass_part(whole) is not None:
        return None
    return s.Half(side=side.value, of=whole)


@construction(
    "place: [DET] OPENPART OF rows=rows",
    "place: [DET] OPENPART FINISH OF rows=rows", "place: [DET] FAR FINISH OF rows=rows",
    cost=0.2,
)  # fmt: skip
def some_end_of(rows: s.Selector) -> list[PlaceMeaning] | None:
    """Compose "the far end of bed 4": which end is that?"""
    if not is_one_row(rows):
        return None
    return [PlaceMeaning(s.InRow(first=at, last=at, of=rows), "one") for at in (1, -1)]


@construction(
    "region: [DET] HALF NEAREST [AT] to=place", "region: [DET] HALF NEAREST [AT] to=place OF site", cost=0.2,
    given=("site",),
)  # fmt: skip
def half_of_site_nearest(to: PlaceMeaning, site: Site) -> list[s.Selector] | None:
    """Compose "the half nearest the gate": of the site, or of a large part of it?"""
    whole = s.Trees().ground(Resolution(site, Context(here=site.start)))
    large = [zone for zone in site.zones_of("zone") if zone.polygon.area >= _LARGE * whole.area]
    wholes = [s.Trees(), *(s.InZone(zone=zone.name) for zone in large if not site.trees)]
    return [half for one in wholes for half in half_nearest(one, to, site) or ()] or None


@construction(
    "region: [DET] HALF OF whole=region NEAREST [AT] to=place",
    "region: [DET] HALF in_ whole=region NEAREST [AT] to=place",
    "region: whole=region [COMMA] [DET] HALF NEAREST [AT] to=place",
    cost=0.1, given=("site",),
)  # fmt: skip
def half_nearest(whole: s.Selector, to: PlaceMeaning, site: Site) -> list[s.Selector] | None:
    """Compose "the half of the paddock nearest the gate": the one on that side, or two if it lies to a corner."""
    if are_rows(whole) or to.shape not in ("one", "area") or to.selector.relative:
        return None
    resolution = Resolution(site, Context(here=site.start))
    try:
        ground = whole.ground(resolution)
        zone = as_zone(to.selector)
        near = zone.ground(resolution).centroid.coords[0] if zone is not None else _position(to.selector, site)
    except (PlaceError, TaskError):
        return None
    west, south, east, north = ground.bounds
    along = ((near[0] - (west + east) / 2) / (east - west), (near[1] - (south + north) / 2) / (north - south))
    sides = ("east" if along[0] > 0 else "west", "north" if along[1] > 0 else "south")
    far = (abs(along[0]), abs(along[1]))
    if math.isclose(*far, abs_tol=1e-6) or max(far) < _CLEARLY * min(far):
        wanted: tuple[str, ...] = sides
    else:
        wanted = (sides[0],) if far[0] > far[1] else (sides[1],)
    return [s.Half(side=cast(Side, side), of=whole) for side in wanted]


def _position(selector: s.Selector, site: Site) -> tuple[float, float]:
    """Return the position of the first place of a selector."""
    place = resolve(selector, site, Context(here=site.start))[0]
    return place.x, place.y
