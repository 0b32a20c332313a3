"""Compute the smallest-area rectangle around points, and name its corners by the compass."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPoint, Polygon

from fieldhand.terms import CornerName

#: Anticlockwise, like the corners of the rectangle.
_NAMES: tuple[CornerName, ...] = ("ne", "nw", "sw", "se")
_COMPASS = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], dtype=np.float64)


def smallest_rectangle(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the corners of the smallest-area enclosing rectangle, anticlockwise, shape (4, 2).

    One of its sides lies on an edge of the convex hull (Freeman and Shapira 1975), so each edge is tried. The extreme
    points in each direction are found by binary search among the sorted edge normals. Fewer than three points, or
    collinear points, give a rectangle of zero width.
    """
    hull = MultiPoint(_outer(xy)).convex_hull
    points = shapely.get_coordinates(hull)
    if not isinstance(hull, Polygon):
        points = points if len(points) == 2 else np.repeat(points, 2, axis=0)
        along = points[1] - points[0]
        length = float(np.hypot(*along))
        return _rectangle(points, along / length if length > 0.0 else np.array([1.0, 0.0]))
    ring = points[:-1] if shapely.is_ccw(hull.exterior) else points[:0:-1]
    edges = np.roll(ring, -1, axis=0) - ring
    first = int(np.argmin(np.arctan2(edges[:, 1], edges[:, 0])))
    ring, edges = np.roll(ring, -first, axis=0), np.roll(edges, -first, axis=0)
    angles = np.arctan2(edges[:, 1], edges[:, 0])  # ascending around an anticlockwise hull
    along = edges / np.hypot(edges[:, 0], edges[:, 1])[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    area = _reach(ring, angles, along) * _reach(ring, angles, across)
    # Rounding may make the area of a hull of zero width slightly negative.
    best = int(np.flatnonzero(area <= area.min() + 1e-9 * abs(area.min()))[0])
    return _rectangle(ring, along[best])


def named_corners(rectangle: NDArray[np.float64]) -> Mapping[CornerName, NDArray[np.float64]]:
    """Return each corner by its compass name as seen from the centre; every name is used once, even at 45 degrees.

    Among the four cyclic assignments of names, the one that agrees best with the compass is chosen.
    """
    offsets = rectangle - rectangle.mean(axis=0)
    agreement = [float((offsets * np.roll(_COMPASS, -turn, axis=0)).sum()) for turn in range(4)]
    best = max(agreement)
    slack = 1e-9 * (1.0 + abs(best))
    turn = next(t for t, a in enumerate(agreement) if a >= best - slack)
    return {_NAMES[(k + turn) % 4]: rectangle[k] for k in range(4)}


def _outer(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the points that may lie on the hull, without those well inside (Akl and Toussaint 1978)."""
    if len(xy) < 1000:
        return xy
    x, y = np.ascontiguousarray(xy[:, 0]), np.ascontiguousarray(xy[:, 1])
    turn = np.arange(16) * (np.pi / 8)
    frame = xy[[int(np.argmax(c * x + s * y)) for c, s in zip(np.cos(turn), np.sin(turn), strict=True)]]
    inside = np.ones(len(xy), dtype=bool)
    for a, b in zip(frame, np.roll(frame, -1, axis=0), strict=True):
        if (a != b).any():
            east, north = b - a
            inside &= east * y - north * x > east * a[1] - north * a[0]
    return np.asarray(xy[~inside])


def _reach(
    ring: NDArray[np.float64], angles: NDArray[np.float64], direction: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the extent of the hull along each direction."""
    high = ring[_farthest_vertex(angles, direction)]
    low = ring[_farthest_vertex(angles, -direction)]
    return np.asarray(((high - low) * direction).sum(axis=1))


def _farthest_vertex(angles: NDArray[np.float64], direction: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the index of the vertex farthest along each direction.

    It is where the direction of the edges passes the perpendicular of the direction.
    """
    turned = np.arctan2(direction[:, 0], -direction[:, 1])  # the direction of travel whose outward side is `direction`
    return np.searchsorted(angles, turned) % len(angles)


def _rectangle(points: NDArray[np.float64], along: NDArray[np.float64]) -> NDArray[np.float64]:
    across = np.array([-along[1], along[0]])
    u, v = points @ along, points @ across
    box = [(u.min(), v.min()), (u.max(), v.min()), (u.max(), v.max()), (u.min(), v.max())]
    return np.array([a * along + b * across for a, b in box])
