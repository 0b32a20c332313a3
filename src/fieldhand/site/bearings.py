"""Bearings between points, and headings at the ends of a path.

Headings and bearings are in degrees clockwise from true north, 0 to 360; points in local metres east and north.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

XY = tuple[float, float]

#: Length in metres below which a leg has no direction.
NO_LEG_M = 0.01
#: A displacement has a direction along an axis if its part along it is at least this fraction of that across.
_ALONG = 0.2


def bearing_of(one: XY, two: XY) -> float:
    """Return the bearing from one point to another."""
    return math.degrees(math.atan2(two[0] - one[0], two[1] - one[1])) % 360.0


def apart_deg(one: float, two: float) -> float:
    """Return the angle between two headings in degrees, 0 to 180."""
    return abs((one - two + 180.0) % 360.0 - 180.0)


def ahead_of(at: XY, heading_deg: float, metres: float) -> XY:
    """Return the point some metres ahead."""
    heading = math.radians(heading_deg)
    return at[0] + metres * math.sin(heading), at[1] + metres * math.cos(heading)


def first_heading(points: Sequence[XY]) -> float | None:
    """Return the bearing of the first leg of a path; None for a path of no length."""
    legs = (leg for leg in itertools.pairwise(points) if math.dist(*leg) > NO_LEG_M)
    return next((bearing_of(*leg) for leg in legs), None)


def last_heading(points: Sequence[XY]) -> float | None:
    """Return the bearing of the last leg of a path; None for a path of no length."""
    return None if (back := first_heading(points[::-1])) is None else (back + 180.0) % 360.0


def heading_along(axis_deg: float, points: Sequence[XY]) -> float:
    """Return the heading along an axis in which a path ends.

    Args:
        axis_deg: Bearing of the axis, either of its two.
        points: Corners of the path. If its last leg runs across the axis, as from the middle of an aisle to a tree
            beside it, the legs before it count.
    """
    end, (east, north) = points[-1], ahead_of((0.0, 0.0), axis_deg, 1.0)
    for x, y in reversed(points[:-1]):
        dx, dy = end[0] - x, end[1] - y
        along, across = dx * east + dy * north, dx * north - dy * east
        if abs(along) > max(NO_LEG_M, _ALONG * abs(across)):
            return axis_deg % 360.0 if along > 0.0 else (axis_deg + 180.0) % 360.0
    return axis_deg % 360.0
