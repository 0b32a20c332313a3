"""Drives that did not arrive: how far the robot went along a way before it was blocked, paused or cut off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, pairwise

Path = Sequence[tuple[float, float]]


def driven_part(path: Path, at: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    """The part of a way that was driven when the robot stands at a point of it, or beside it.

    Args:
        path: Corners of the way as latitude and longitude.
        at: Where the drive ended, which is the last corner of the answer.
    """
    from shapely import LineString, Point

    if len(path) < 2:
        return (*path, at)
    # Degrees of longitude are shorter than those of latitude; on the length of one drive that is one factor.
    narrow = math.cos(math.radians(at[0]))
    corners = [(lon * narrow, lat) for lat, lon in path]
    passed = LineString(corners).project(Point(at[1] * narrow, at[0]))
    lengths = accumulate((math.dist(a, b) for a, b in pairwise(corners)), initial=0.0)
    return (*[corner for corner, length in zip(path, lengths, strict=True) if length <= passed], at)
