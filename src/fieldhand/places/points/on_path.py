"""Place points at equal steps along a path across an area, and find the trees nearest to them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Polygon
from shapely.geometry.polygon import orient
from shapely.ops import unary_union

from fieldhand import language
from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.language.words import say_rounded
from fieldhand.places.place_errors import too_few
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.points.free_ground import (
    MOST_POINTS,
    area_called,
    free_part,
    free_points,
    nearest_free,
    part_of_area,
    segments,
)
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Site
from fieldhand.site.rectangle import named_corners, smallest_rectangle
from fieldhand.site.working.heading import TOWARDS, facing

if TYPE_CHECKING:
    from fieldhand.places.points.transect import Transect

Floats = NDArray[np.float64]

#: Maximum distance in metres of points along an edge from it.
_MOST_OFF_M = 100.0

#: Maximum number of legs of a zigzag.
MOST_LEGS = 200


def trees_on_path(of: PlaceGroup, selector: Transect, notes: ResolutionNotes) -> PlaceGroup:
    """Return the tree nearest to each point of the path across a group of trees, each tree once, in the path's order.

    The path runs inside the smallest-area rectangle around the trees.

    Raises:
        PlaceError: There are too few trees, or the number of points or legs is not possible.
    """
    path = _path(of.xy, selector) if len(of) else []
    points = _along(path, selector)
    if len(points) > len(of) and not selector.apart_m:
        raise too_few(of.site, selector, selector.count, len(of))
    taken = np.zeros(len(of), dtype=bool)
    order: list[int] = []
    farthest = 0.0
    for point in points:
        away = np.hypot(*(of.xy - point).T)
        if selector.apart_m and taken[int(away.argmin())]:
            continue  # two points of a dense path may have one nearest tree
        away[taken] = np.inf
        k = int(away.argmin())
        taken[k] = True
        order.append(k)
        farthest = max(farthest, float(away[k]))
    notes.rule = message(
        "the path is {metres} m long, the trees are at most {most} m from its points",
        metres=say_rounded(sum(piece.length for piece in path)),
        most=say_rounded(farthest, 1),
    )
    return of.keep(order)


def points_on_path(site: Site, selector: Transect, notes: ResolutionNotes) -> PlaceGroup:
    """Return free points along the parts of the path that lie inside a zone, or inside the whole site.

    Raises:
        PlaceError: There is no such zone, no space in it, or the number of points or legs is not possible.
    """
    if selector.shape == "edge":
        path = _edge(site, selector)
    else:
        area = part_of_area(area_called(site, selector.zone), selector.part)
        free = free_part(site, area)
        lines = _path(shapely.get_coordinates(area), selector)
        path = [piece for line in lines for piece in segments(line.intersection(free))]
    if not path:
        raise PlaceError(
            message("there is no free ground along that path"),
            where=site.name,
            advice=message("all of it is inside keep-outs or outside the boundary"),
        )
    xy = _along(path, selector)
    if selector.shape == "edge":
        xy = _beside_edge(site, xy, selector)
    notes.rule = message("the path is {metres} m long", metres=say_rounded(sum(piece.length for piece in path)))
    count = len(xy)
    if selector.zone:
        names = [
            message("point {number} of {count} in {zone}", number=k, count=count, zone=selector.zone)
            for k in range(1, count + 1)
        ]
    else:
        names = [message("point {number} of {count}", number=k, count=count) for k in range(1, count + 1)]
    return free_points(site, xy, names)


def _beside_edge(site: Site, xy: Floats, selector: Transect) -> Floats:
    """Return points along an edge, those that are not free moved to the nearest free ground.

    At a spacing, those that would move by more than half of it are left out: an edge outside of the boundary has none.
    """
    free = nearest_free(site, xy)
    moved = np.hypot(*(free - xy).T)
    near = moved <= selector.apart_m / 2.0 if selector.apart_m else np.ones(len(xy), dtype=bool)
    stands: Floats = free[near]
    return stands


def _edge(site: Site, selector: Transect) -> list[LineString]:
    """Return the pieces of the edge of a zone or the site, inside of it, clockwise from its north-west.

    Around a keep-out they lie outside of it. Of one side they face it; a single point is on the longest of them.

    Raises:
        PlaceError: There is no such zone, the distance from the edge is none, or no part of it faces that side.
    """
    zone, off = selector.zone, selector.off_m
    outs = [z.polygon for z in site.zones_of("keep_out") if zone and phrase(z.name) == phrase(zone)]
    if not (np.isfinite(off) and (0 if outs or not zone else -_MOST_OFF_M) <= off <= _MOST_OFF_M):
        raise PlaceError(
            message("points cannot lie {metres} m from an edge", metres=Number(f"{off:g}")),
            advice=message("ask for 0 to {most} m", most=Number(f"{_MOST_OFF_M:g}")),
        )
    area = unary_union(outs).buffer(off) if outs else area_called(site, zone).buffer(-off)
    found: list[LineString] = []
    for part in shapely.get_parts(area):
        at = list(orient(part, sign=-1.0).exterior.coords)[:-1] if isinstance(part, Polygon) else []
        if at:
            first = int(np.argmin(np.asarray(at) @ np.array([1.0, -1.0])))
            found.append(LineString([*at[first:], *at[: first + 1]]))
    if selector.part == "all":
        return found
    faced = [side for side in TOWARDS if side == selector.part]
    rings = [np.asarray(line.coords) for line in found]
    pieces = [LineString(one) for side in faced for ring in rings for one in facing(ring, side, clockwise=True)]
    if not pieces:
        raise PlaceError(
            message("no part of this edge faces that side"),
            where=site.name,
            advice=message("name north, east, south or west, or the whole edge"),
        )
    return pieces if selector.count != 1 else [max(pieces, key=lambda piece: float(piece.length))]


def _path(xy: Floats, selector: Transect) -> list[LineString]:
    """Return the pieces of the path across the smallest-area rectangle around points, beginning in the north-west."""
    if not 1 <= selector.legs <= MOST_LEGS:
        raise PlaceError(
            language.counted(
                "a zigzag of {count} leg is not possible", "a zigzag of {count} legs is not possible", selector.legs
            ),
            advice=message("ask for 1 to {count}", count=MOST_LEGS),
        )
    corner = named_corners(smallest_rectangle(xy))
    nw, ne, sw, se = (corner[name] for name in ("nw", "ne", "sw", "se"))
    if np.hypot(*(ne - nw)) < np.hypot(*(sw - nw)):
        ne, sw = sw, ne  # the path leads along the longer sides
    match selector.shape:
        case "z":
            return [LineString([nw, ne, sw, se])]
        case "x":
            return [LineString([nw, se]), LineString([ne, sw])]
        case _:
            at = np.linspace(0.0, 1.0, selector.legs + 1)[:, None]
            one, other = nw + at * (ne - nw), sw + at * (se - sw)
            return [LineString(np.where(np.arange(selector.legs + 1)[:, None] % 2 == 0, one, other))]


def _along(path: Sequence[LineString], selector: Transect) -> Floats:
    """Return points in the middles of equal parts of the pieces taken together, or at a spacing, shape (n, 2)."""
    length = sum(piece.length for piece in path)
    count = selector.count
    if selector.apart_m and np.isfinite(selector.apart_m) and selector.apart_m > 0:
        count = max(1, round(length / selector.apart_m)) if length / selector.apart_m <= MOST_POINTS else 0
    if not 1 <= count <= MOST_POINTS or selector.apart_m < 0 or (selector.apart_m and selector.count):
        raise PlaceError(
            message("{count} points along a path is not possible", count=count),
            advice=message("ask for 1 to {count}, or for a spacing", count=MOST_POINTS),
        )
    ends = np.cumsum([piece.length for piece in path])
    at = (np.arange(count) + 0.5) * length / count
    which = np.minimum(np.searchsorted(ends, at), len(path) - 1)
    return np.array(
        [
            path[k].interpolate(d - (ends[k] - path[k].length)).coords[0]
            for d, k in zip(at.tolist(), which.tolist(), strict=True)
        ]
    ).reshape(-1, 2)
