"""Areas for free points: inside the boundary, clear of keep-out zones and trees."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, MultiPoint, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places.place_errors import no_such_zone
from fieldhand.places.place_group import PlaceGroup
from fieldhand.site.counting import find_block
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Place, Site
from fieldhand.site.names import short
from fieldhand.site.point_index import PointIndex
from fieldhand.terms import AreaPart

#: Preferred distance in metres of free points from keep-out zones and the boundary.
MARGIN_M = 1.0

#: Preferred distance in metres of free points from trees.
OFF_TREES_M = 1.0

#: Maximum number of points on one line or in one zone.
MOST_POINTS = 10_000

#: Distance in metres from points within which free ground is sought.
_AROUND_M = 100.0

Floats = NDArray[np.float64]

#: Sides of the quarters.
_CORNER_SIDES = {"nw": ("north", "west"), "ne": ("north", "east"), "se": ("south", "east"), "sw": ("south", "west")}


def free_points(site: Site, xy: Floats, ids: Sequence[str]) -> PlaceGroup:
    """Return a group of free points with these ids."""
    degrees = site.projection.degrees(xy).tolist()
    return PlaceGroup.of(
        site,
        [
            Place(kind="point", id=name, x=float(x), y=float(y), lat=lat, lon=lon)
            for name, (x, y), (lat, lon) in zip(ids, xy.tolist(), degrees, strict=True)
        ],
    )


def nearest_free(site: Site, xy: Floats) -> Floats:
    """Return the point of free ground nearest to each point, shape (n, 2)."""
    (west, south), (east, north) = xy.min(axis=0) - _AROUND_M, xy.max(axis=0) + _AROUND_M
    free = free_part(site, shapely.box(west, south, east, north))
    if free.is_empty:
        return np.full_like(xy, np.inf)
    nearest: Floats = shapely.get_coordinates(shapely.shortest_line(shapely.points(xy), free)).reshape(-1, 2, 2)[:, 1]
    return nearest


def area_called(site: Site, name: str) -> BaseGeometry:
    """Return the union of the zones of that name, else the area of the block of that name; for an empty name the site.

    Raises:
        PlaceError: There is neither, or robots are not allowed there.
    """
    if not name:
        return _whole_site(site)
    zones = [z for z in site.zones if phrase(z.name) == phrase(name)]
    zones = [z for z in zones if z.name == name] or zones
    if zones and all(z.kind == "keep_out" for z in zones):
        raise PlaceError(
            message("{name} is a keep-out zone", name=short(zones[0].name)),
            where=site.name,
            advice=message("ask for points in another zone"),
        )
    if zones:
        return unary_union([z.polygon for z in zones if z.kind != "keep_out"])
    block = find_block(site, name)
    if block is None:
        raise no_such_zone(site, name)
    return area_around(site.xy[np.concatenate([row.trees for row in block.rows])], site.spacing_m / 2)


def part_of_area(area: BaseGeometry, part: AreaPart) -> BaseGeometry:
    """Return a half or a quarter of an area, by the middle lines of its extent along true north."""
    if part == "all" or area.is_empty:
        return area
    west, south, east, north = area.bounds
    wanted = _CORNER_SIDES.get(part, (part,))
    west = (west + east) / 2 if "east" in wanted else west
    east = (area.bounds[0] + east) / 2 if "west" in wanted else east
    south = (south + north) / 2 if "north" in wanted else south
    north = (area.bounds[1] + north) / 2 if "south" in wanted else north
    return area.intersection(shapely.box(west, south, east, north))


def _whole_site(site: Site) -> BaseGeometry:
    """Return the area inside the boundary; without one that of the trees, or that of the zones."""
    bounds = site.zones_of("boundary")
    if not bounds and site.trees:
        return area_around(site.xy, site.spacing_m / 2)
    return unary_union([z.polygon for z in bounds or site.zones_of("zone")])


def area_around(xy: Floats, around_m: float) -> BaseGeometry:
    """Return the convex hull of some trees, extended by ``around_m`` metres."""
    return MultiPoint(xy).convex_hull.buffer(around_m)


def free_part(site: Site, area: BaseGeometry) -> BaseGeometry:
    """Return the part of an area or line that is free for points, with the margin unless nothing would remain."""
    if not site.zones:
        return area
    for margin in (MARGIN_M, 0.0):
        free: BaseGeometry = area.intersection(_open_ground(site, margin))
        if free.length > 0:
            return free
    return Polygon()


def segments(geometry: BaseGeometry) -> list[LineString]:
    """Return the straight pieces of a line or of several lines."""
    pieces = getattr(geometry, "geoms", [geometry])
    return [p for p in pieces if isinstance(p, LineString) and p.length > 0]


def tree_index(site: Site) -> PointIndex:
    """Return a spatial index of the trees, cached with the site."""
    if "tree index" not in site.cache:
        site.cache["tree index"] = PointIndex(site.xy)
    return cast(PointIndex, site.cache["tree index"])


def off_trees(site: Site, xy: Floats) -> Floats:
    """Return the distance of each point to the nearest tree in metres, capped at the preferred distance."""
    return np.asarray(np.minimum(tree_index(site).nearest(xy)[0], OFF_TREES_M))


def _open_ground(site: Site, margin_m: float) -> Any:
    """Return the area inside the boundary, or the whole plane, without keep-out zones and with a margin to both."""
    key = ("open ground", margin_m)
    if key not in site.cache:
        bounds = [z.polygon for z in site.zones_of("boundary")]
        if bounds:
            ground = unary_union(bounds).buffer(-margin_m)
        else:
            west, south = site.outline_xy.min(axis=0) - 10_000.0
            east, north = site.outline_xy.max(axis=0) + 10_000.0
            ground = shapely.box(west, south, east, north)
        outs = [z.polygon.buffer(margin_m) for z in site.zones_of("keep_out")]
        site.cache[key] = ground.difference(unary_union(outs)) if outs else ground
    return site.cache[key]
