"""Paths through points beside a row or in the middle of an aisle, around what stands in the way."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely.geometry import LineString

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives

XY = tuple[float, float]

#: Greatest distance in metres from a straight path to the points that it is to pass.
_ASIDE_M = 0.35
#: A leg that is this many times as long as the straight line, plus some metres, is a detour.
_DETOUR, _DETOUR_M = 1.3, 1.5
#: Tolerance in metres within which corners of a path are dropped.
_SIMPLE_M = 0.05


@dataclass(frozen=True, kw_only=True)
class LanePath:
    """A path past some points in order.

    Attributes:
        points: Corners in local metres, at least two.
        passed: Indices of the given points that it passes, in order.
        at_m: Distance along the path at each of them.
    """

    points: tuple[XY, ...]
    passed: tuple[int, ...]
    at_m: tuple[float, ...]


def lanes_past(drives: Drives, stops: Sequence[XY]) -> tuple[LanePath, ...]:
    """Return the paths past points in order: one, or several where a detour or no way leads from one to the next.

    Args:
        drives: Drives of the robot.
        stops: Points on drivable ground in local metres.
    """
    parts = _without_detours(drives, stops, list(range(len(stops))))
    return tuple(_lane(drives, stops, part) for part in parts if len(part) > 1)


def _without_detours(drives: Drives, stops: Sequence[XY], indices: list[int]) -> list[list[int]]:
    """Split points where the way from one to the next is a detour."""
    if len(indices) < 2:
        return [indices]
    if _is_direct(drives, stops, indices):
        return [indices]
    if len(indices) == 2:
        return [indices[:1], indices[1:]]
    middle = len(indices) // 2
    first = _without_detours(drives, stops, indices[: middle + 1])
    second = _without_detours(drives, stops, indices[middle:])
    # The point in the middle is in both halves.
    return [*first[:-1], first[-1] + second[0][1:], *second[1:]]


def _is_direct(drives: Drives, stops: Sequence[XY], indices: Sequence[int]) -> bool:
    """Return True if the way from the first to the last point passes all others without a detour."""
    way = drives.way_between(stops[indices[0]], stops[indices[-1]])
    if way is None:
        return False
    points, length = way
    if len(indices) == 2:
        return length <= _DETOUR * math.dist(stops[indices[0]], stops[indices[-1]]) + _DETOUR_M
    line = LineString(points) if length > 0 else shapely.Point(points[0])
    at = shapely.points(np.array([stops[k] for k in indices]))
    return bool((shapely.distance(line, at) <= _ASIDE_M).all())


def _lane(drives: Drives, stops: Sequence[XY], indices: Sequence[int]) -> LanePath:
    """Return the path past points between which there is no detour."""
    points: list[XY] = [stops[indices[0]]]
    for one, two in itertools.pairwise(_legs(drives, stops, list(indices))):
        way = drives.way_between(stops[one], stops[two])
        assert way is not None  # noqa: S101  points without a way were separated
        points += way[0][1:]
    path = LineString(points) if len(points) > 1 else LineString([points[0], points[0]])
    line = path.simplify(_SIMPLE_M)
    corners = tuple((float(x), float(y)) for x, y in line.coords)
    at, before = [], 0.0
    for k in indices:
        before = max(before, float(line.project(shapely.Point(stops[k]))))
        at.append(before)
    return LanePath(points=corners, passed=tuple(indices), at_m=tuple(at))


def _legs(drives: Drives, stops: Sequence[XY], indices: list[int]) -> list[int]:
    """Return the points between which the shortest ways pass all others."""
    if len(indices) <= 2 or _is_direct(drives, stops, indices):
        return [indices[0], indices[-1]]
    middle = len(indices) // 2
    return [*_legs(drives, stops, indices[: middle + 1]), *_legs(drives, stops, indices[middle:])[1:]]
