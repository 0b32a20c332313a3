"""Place points on the straight line between two places."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from fieldhand.errors import PlaceError
from fieldhand.language import counted, message
from fieldhand.language.words import say_number, say_rounded, say_zone
from fieldhand.places.neighbours.distances import ZoneArea
from fieldhand.places.points.free_ground import MOST_POINTS, free_points, nearest_free
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.places.selector import Selector
from fieldhand.places.wording import say_selector

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.points.straight_line import StraightLine
    from fieldhand.places.resolution import Resolution

Floats = NDArray[np.float64]

#: Maximum distance in metres by which a point is moved to free ground; one farther from it is left out.
_MOST_MOVED_M = 2.0


def points_between(selector: StraightLine, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
    """Return points on the straight line between two places, in the order of the line.

    The ends of a zone are its points nearest to the other end. A point that lies in a keep-out or outside the boundary
    is moved by at most 2 m, else left out.

    Raises:
        PlaceError: An end is no single place, both are the same, or the number or distance of the points is not
            possible.
    """
    site = resolution.site
    ends = shapely.get_coordinates(
        shapely.shortest_line(_end(selector.start, resolution), _end(selector.end, resolution))
    )
    length = float(np.hypot(*(ends[1] - ends[0])))
    if length < 1e-6:
        raise PlaceError(
            message(
                "there is no line from {start} to {end}: they are at the same place",
                start=_said(selector.start),
                end=_said(selector.end),
            ),
            where=site.name,
            advice=message("name two places"),
        )
    on_line = ends[0] + _distances(selector, length)[:, None] * (ends[1] - ends[0]) / length
    free = nearest_free(site, on_line)
    kept = np.hypot(*(free - on_line).T) <= _MOST_MOVED_M
    notes.rule = message("the line is {metres} m long", metres=say_rounded(length))
    if not kept.all():
        notes.remark(
            counted(
                "{count} point of the line is left out: it lies inside a keep-out or outside the boundary",
                "{count} points of the line are left out: they lie inside a keep-out or outside the boundary",
                int((~kept).sum()),
            )
        )
    total = int(kept.sum())
    start, end = _name(selector.start, resolution), _name(selector.end, resolution)
    names = [
        message("point {number} of {count} from {start} to {end}", number=k, count=total, start=start, end=end)
        for k in range(1, total + 1)
    ]
    return free_points(site, free[kept], names)


def _said(end: Selector) -> str:
    return say_zone(end.whole_zone) if end.whole_zone else say_selector(end)


def _name(end: Selector, resolution: Resolution) -> str:
    return end.whole_zone or resolution.one(end).places[0].id


def _end(selector: Selector, resolution: Resolution) -> BaseGeometry:
    """Return an end of the line: the ground of a zone, else a point."""
    origin = resolution.origin(selector)
    if isinstance(origin, ZoneArea):
        return origin.area
    return shapely.Point(resolution.one(selector).xy[0])


def _distances(selector: StraightLine, length: float) -> Floats:
    """Return the distances of the points from the start in metres."""
    count, apart = selector.count, selector.apart_m
    if apart and np.isfinite(apart) and apart > 0 and not count and length / apart < MOST_POINTS:
        return np.arange(int(length / apart + 1e-6) + 1, dtype=np.float64) * np.float64(apart)
    if not apart and 1 <= count <= MOST_POINTS:
        return np.asarray(np.linspace(0.0, length, count) if count > 1 else [length / 2.0], dtype=np.float64)
    if apart and count:
        raise PlaceError(
            message("points on a line have a number or a distance, not both"), advice=message("leave one of them out")
        )
    raise PlaceError(
        message("{count} points {metres} m apart on a line are not possible", count=count, metres=say_number(apart)),
        advice=message("ask for 1 to {count}, or for a spacing", count=MOST_POINTS),
    )
