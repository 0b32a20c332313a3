"""Spread points evenly over a zone."""

from __future__ import annotations

from hashlib import sha256
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from fieldhand import language
from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.points.free_ground import (
    MOST_POINTS,
    OFF_TREES_M,
    area_called,
    free_part,
    free_points,
    off_trees,
    part_of_area,
)
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.model import Site
from fieldhand.site.names import short
from fieldhand.site.point_index import PointIndex

if TYPE_CHECKING:
    from fieldhand.places.points.points_in import PointsIn


Floats = NDArray[np.float64]

#: Number of raster points per requested point.
_RASTER = 40

#: Number of Lloyd iterations.
_ROUNDS = 8

#: Points of the bounding box that are drawn at once, and how often.
_BATCH, _MOST_BATCHES = 256, 400


def over_zone(site: Site, selector: PointsIn, notes: ResolutionNotes) -> PlaceGroup:
    """Return points spread evenly over a zone, or its middle for one point; a metre from the trees if there is space.

    Raises:
        PlaceError: There is no such zone, or no space in it.
    """
    count = selector.count
    if not 1 <= count <= MOST_POINTS:
        raise PlaceError(
            message("{count} points in a zone is not possible", count=count),
            advice=message("ask for 1 to {count}", count=MOST_POINTS),
        )
    area = part_of_area(area_called(site, selector.zone), selector.part)
    free = free_part(site, area)
    zone = selector.zone or message("the site")
    if selector.random:
        xy = _drawn(site, free, selector)
        notes.rule = message("drawn by seed {seed}", seed=selector.seed)
        return free_points(site, xy, _numbered(zone, count))
    raster = _raster(site, free, count) if not free.is_empty else np.empty((0, 2))
    if len(raster) < count:
        raise _no_room(site, selector, len(raster))
    if count == 1:
        notes.rule = "the free place nearest to the middle of its area"
        middle = np.array(area.centroid.coords[0])
        if shapely.intersects_xy(free, *middle) and off_trees(site, middle[None, :])[0] >= OFF_TREES_M:
            return free_points(site, middle[None, :], [message("the middle of {zone}", context="name", zone=zone)])
        return free_points(
            site,
            raster[_nearest(raster, middle)][None, :],
            [message("the middle of {zone}", context="name", zone=zone)],
        )
    notes.rule = "each covers an equal share of the area"
    xy = _spread(raster, count)
    xy = xy[np.lexsort((-xy[:, 1], np.round(xy[:, 0], 3)))]
    return free_points(site, xy, _numbered(zone, count))


def _numbered(zone: str, count: int) -> list[str]:
    return [
        message("point {number} of {count} in {zone}", number=k, count=count, zone=zone) for k in range(1, count + 1)
    ]


def _no_room(site: Site, selector: PointsIn, most: int) -> PlaceError:
    return PlaceError(
        language.counted(
            "there is no room for {count} point in {zone}",
            "there is no room for {count} points in {zone}",
            selector.count,
            zone=short(selector.zone or message("the site")),
        ),
        where=site.name,
        advice=message("ask for at most {count}", count=most)
        if most
        else message("all of it is inside keep-outs or outside the boundary"),
    )


def _drawn(site: Site, free: BaseGeometry, selector: PointsIn) -> Floats:
    """Return points drawn uniformly from the free area, clear of trees, by the SHA-256 of the seed and a number.

    They depend neither on a random generator nor on the order of the file.
    """
    if free.is_empty or free.area <= 0:
        raise _no_room(site, selector, 0)
    west, south, east, north = free.bounds
    shapely.prepare(free)
    found: list[Floats] = []
    for batch in range(_MOST_BATCHES):
        first = batch * _BATCH
        digests = [sha256(f"{selector.seed}\n{k}".encode()).digest() for k in range(first, first + _BATCH)]
        share = np.array([[int.from_bytes(d[:8], "big"), int.from_bytes(d[8:16], "big")] for d in digests]) / 2.0**64
        xy = np.array([west, south]) + share * np.array([east - west, north - south])
        xy = xy[shapely.contains_xy(free, *xy.T)]
        found.extend(xy[off_trees(site, xy) >= OFF_TREES_M] if len(xy) else xy)
        if len(found) >= selector.count:
            return np.array(found[: selector.count])
    raise _no_room(site, selector, len(found))


def _raster(site: Site, free: BaseGeometry, count: int) -> Floats:
    """Return the points of a square raster over an area, only those clear of trees if there are enough."""
    wanted = int(np.clip(_RASTER * count, 400, max(6_000, 2 * count)))
    step = float(np.sqrt(free.area / wanted))
    west, south, east, north = free.bounds
    x = (west + east) / 2 + step * np.arange(-np.ceil((east - west) / step / 2), np.ceil((east - west) / step / 2) + 1)
    y = (south + north) / 2 + step * np.arange(
        -np.ceil((north - south) / step / 2), np.ceil((north - south) / step / 2) + 1
    )
    columns = np.meshgrid(x, y, indexing="ij")
    columns[1][1::2] = columns[1][1::2, ::-1]  # alternate the direction, so that consecutive points are close
    xy = np.column_stack([c.ravel() for c in columns])
    shapely.prepare(free)
    xy = xy[shapely.intersects_xy(free, *xy.T)]
    clear = xy[off_trees(site, xy) >= OFF_TREES_M] if len(xy) else xy
    return clear if len(clear) >= count else xy


def _spread(raster: Floats, count: int) -> Floats:
    """Return raster points that are centres of their Voronoi cells (Lloyd 1982), starting with an even choice."""
    centres = raster[((np.arange(count) + 0.5) * len(raster) / count).astype(np.intp)]
    for _ in range(_ROUNDS):
        nearest = PointIndex(centres).nearest(raster)[1]
        shares = np.bincount(nearest, minlength=count)
        middles = np.column_stack([np.bincount(nearest, raster[:, k], count) for k in (0, 1)]) / shares[:, None]
        order = np.lexsort((np.round(np.hypot(*(raster - middles[nearest]).T), 6), nearest))
        centres = raster[order[np.searchsorted(nearest[order], np.arange(count))]]
    return centres


def _nearest(xy: Floats, to: Floats) -> int:
    return int(np.argmin(np.round(np.hypot(*(xy - to).T), 4)))
