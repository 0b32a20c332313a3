"""Place points in the corners of a zone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.ops import unary_union

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.language.words import CORNERS
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.points.free_ground import area_called, free_points, nearest_free
from fieldhand.site.feature_kinds import phrase
from fieldhand.site.model import Site
from fieldhand.site.rectangle import named_corners, smallest_rectangle
from fieldhand.terms import CornerName

#: Distance in metres of the points from the edge of the zone.
_OFF_EDGE_M = 1.5


def in_corners(site: Site, zone: str, which: Sequence[CornerName]) -> PlaceGroup:
    """Return the free point nearest to each corner of the smallest rectangle around a zone.

    The points lie inside of the zone, 1.5 m from its edge where it is wide enough; of a keep-out, outside of it.

    Raises:
        PlaceError: There is no such zone, or no free ground within 100 m of one of the points.
    """
    outs = [one.polygon for one in site.zones_of("keep_out") if phrase(one.name) == phrase(zone)]
    area = unary_union(outs) if outs else area_called(site, zone)
    edge = area.buffer(_OFF_EDGE_M).boundary if outs else area.buffer(-_OFF_EDGE_M)
    corner = named_corners(smallest_rectangle(shapely.get_coordinates(area)))
    wanted = shapely.points(np.array([corner[name] for name in which]))
    lines = shapely.shortest_line(wanted, area if edge.is_empty else edge)
    stands = nearest_free(site, shapely.get_coordinates(lines).reshape(-1, 2, 2)[:, 1])
    if not np.isfinite(stands).all():
        raise PlaceError(
            message("there is no free ground in a corner of {zone}", zone=zone),
            where=site.name,
            advice=message("all of it is inside keep-outs or outside the boundary"),
        )
    names = [message("{north_west} corner of {zone}", north_west=CORNERS[name], zone=zone) for name in which]
    return free_points(site, stands, names)
