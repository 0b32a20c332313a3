"""Interrupted drives: the part of a path driven before the robot was blocked, paused or powered off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, pairwise

Path = Sequence[tuple[float, float]]


def driven_part(path: Path, at: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    """Return the part of a path driven up to a robot position on or beside it.

    Args:
        path: Corners of the path as latitude and longitude.
        at: Position at the end of the drive, which becomes the last corner of the result.
    """
    from shapely import LineString, Point

    if len(path) < 2:
        return (*path, at)
    # Degrees of longitude are shorter than those of latitude; the factor is constant over a single drive.
    narrow = math.cos(math.radians(at[0]))
    corners = [(lon * narrow, lat) for lat, lon in path]
    passed = LineString(corners).project(Point(at[1] * narrow, at[0]))
    lengths = accumulate((math.dist(a, b) for a, b in pairwise(corners)), initial=0.0)
    return (*[corner for corner, length in zip(path, lengths, strict=True) if length <= passed], at)
