"""Place a point at a distance and in a direction from a place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely.geometry import LineString, Point

from fieldhand.errors import PlaceError
from fieldhand.language import Number, message
from fieldhand.language.words import COMPASS, say_rounded
from fieldhand.places.neighbours.distances import ZoneArea
from fieldhand.places.points.free_ground import free_points, nearest_free
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.site.working.heading import TOWARDS

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.points.point_at import PointAt
    from fieldhand.places.resolution import Resolution

#: Maximum distance in metres from the place, and that by which the point is moved to free ground.
_MOST_M, _MOST_MOVED_M = 10_000.0, 2.0


def point_at(selector: PointAt, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
    """Return the point so far from a place; from a zone, so far beyond its edge on the line from its middle.

    A point in a keep-out or outside the boundary is moved by at most 2 m.

    Raises:
        PlaceError: The distance is not possible, the origin is no single place, or the point is not on free ground.
    """
    site = resolution.site
    if not (math.isfinite(selector.metres) and 0.0 < selector.metres <= _MOST_M):
        raise PlaceError(
            message("a point {metres} m away is not possible", metres=Number(f"{selector.metres:g}")),
            advice=message("ask for a distance of up to {most} m", most=Number(f"{_MOST_M:g}")),
        )
    step = np.array(TOWARDS[selector.towards])
    origin = resolution.origin(selector.origin)
    if isinstance(origin, ZoneArea):
        middle = origin.area.centroid
        start, beyond = np.array([middle.x, middle.y]), 0.0
        line = LineString([start, start + step * _MOST_M]).intersection(origin.area)
        if not line.is_empty:
            beyond = max(Point(xy).distance(middle) for xy in shapely.get_coordinates(line))
        wanted, name = start + step * (beyond + selector.metres), selector.origin.whole_zone
    else:
        group = resolution.one(selector.origin)
        wanted, name = group.xy[0] + step * selector.metres, group.places[0].id
    (stand,) = nearest_free(site, wanted[None])
    moved = float(np.hypot(*(stand - wanted)))
    side, metres = COMPASS[selector.towards], Number(f"{selector.metres:g}")
    said = message("{metres} m {north} of {place}", context="log", metres=metres, north=side, place=name)
    if not moved <= _MOST_MOVED_M:
        raise PlaceError(
            message("the point {there} is inside a keep-out or outside the boundary", there=said),
            where=site.name,
            advice=message("ask for another distance or direction"),
        )
    if moved > 0.05:
        notes.remark(message("the point is moved by {metres} m to free ground", metres=say_rounded(moved, 1)))
    return free_points(site, stand[None], [said])
