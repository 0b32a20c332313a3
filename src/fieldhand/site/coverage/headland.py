"""Headlands: the ground around an area and around its holes, and the closed passes that work on it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

from fieldhand.site.coverage.plan import XY, CoverageParams
from fieldhand.site.coverage.strips import centres
from fieldhand.site.driving.graph import Points

#: Chords per quarter turn around a corner.
_CHORDS = 4

#: Parts of an inset area of less than this, in square metres, are rounding errors.
_NOTHING_M2 = 1e-6


def headland_width(params: CoverageParams) -> float:
    """Return the width of the declared headland in metres."""
    if params.headland_m is not None:
        return params.headland_m
    if params.headland_passes == 0:
        return 0.0
    return params.working_width_m + (params.headland_passes - 1) * (params.working_width_m - params.overlap_m)


def inset(area: BaseGeometry, by_m: float, chords: int = _CHORDS) -> BaseGeometry:
    """Return the ground of an area that is farther than ``by_m`` from its edge; ``chords`` per quarter turn."""
    if by_m <= 0.0:
        return area
    smaller = area.buffer(-by_m, quad_segs=chords)
    parts = [part for part in shapely.get_parts(smaller) if part.area > _NOTHING_M2]
    return shapely.union_all(parts) if parts else Polygon()


def headland_rings(area: BaseGeometry, params: CoverageParams) -> list[Points]:
    """Return the closed passes, from the edge inwards, shape (n, 2) each, the first point repeated at the end."""
    if params.headland_passes == 0:
        return []
    width = params.working_width_m
    apart = width - params.overlap_m
    if params.headland_m is None:
        at = width / 2.0 + apart * np.arange(params.headland_passes)
    else:
        at = centres(0.0, max(params.headland_m, width), width, apart)
        if len(at) < params.headland_passes:
            at = np.linspace(at[0], max(params.headland_m, width) - width / 2.0, params.headland_passes)
    return [ring for metres in at.tolist() for ring in rings_at(area, metres)]


def rings_at(area: BaseGeometry, inset_m: float, *, holes: bool = True, chords: int = _CHORDS) -> list[Points]:
    """Return the rings at a distance inside the edge of an area, with or without those around its holes,
    anticlockwise."""
    found = []
    for part in shapely.get_parts(inset(area, inset_m, chords)):
        if part.is_empty:
            continue
        turned = orient(part)
        found.append(shapely.get_coordinates(turned.exterior))
        found += [shapely.get_coordinates(hole)[::-1] for hole in turned.interiors if holes]
    return found


def turned_to(ring: Points, near: XY | None) -> Points:
    """Return a closed ring that starts at its vertex nearest to a point."""
    if near is None:
        return ring
    open_ring = ring[:-1]
    first = int(np.argmin(np.round(np.hypot(*(open_ring - near).T), 6)))
    turned = np.roll(open_ring, -first, axis=0)
    return np.vstack([turned, turned[:1]])


def nearest_ring_order(rings: Sequence[Points], start: XY | None) -> list[Points]:
    """Return rings in the order of a drive that always goes to the nearest one, each starting where it is entered."""
    left, found, at = list(rings), [], start
    while left:
        if at is None:
            ring = left.pop(0)
        else:
            away = [float(np.hypot(*(ring - at).T).min()) for ring in left]
            ring = left.pop(int(np.argmin(np.round(away, 6))))
        found.append(turned_to(ring, at))
        at = (float(found[-1][-1, 0]), float(found[-1][-1, 1]))
    return found
