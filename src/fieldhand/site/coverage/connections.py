"""Drives from one pass to the next: straight paths, or arcs of the turning radius, that stay on the ground."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapely.geometry import LineString

from fieldhand.site.coverage.dubins import dubins_lengths, dubins_paths
from fieldhand.site.coverage.ground import TransitGround
from fieldhand.site.coverage.plan import XY, CoverageLeg
from fieldhand.site.driving.graph import Points

#: Distances, in turning radii, for which the robot drives straight on before and after a turn, as they are tried.
_STRAIGHT_ON = (0.0, 0.5, 1.0, 2.0)

#: Points closer than this in metres are the same.
_SAME_M = 1e-6


@dataclass(frozen=True)
class Pose:
    """A point of a path and the direction in which it is passed, as a unit vector."""

    xy: XY
    ahead: XY

    @staticmethod
    def leaving(points: Sequence[XY]) -> Pose:
        """Return the pose at the end of a path."""
        return Pose(points[-1], _direction(points[-2], points[-1]))

    @staticmethod
    def entering(points: Sequence[XY]) -> Pose:
        """Return the pose at the beginning of a path."""
        return Pose(points[0], _direction(points[0], points[1]))

    def moved(self, metres: float) -> Pose:
        """Return the pose so many metres further ahead."""
        return Pose((self.xy[0] + metres * self.ahead[0], self.xy[1] + metres * self.ahead[1]), self.ahead)

    @property
    def array(self) -> Points:
        """Return x, y and the angle in radians, anticlockwise from east."""
        return np.array([*self.xy, np.arctan2(self.ahead[1], self.ahead[0])])


def connection(ground: TransitGround, one: Pose, two: Pose, radius_m: float) -> CoverageLeg | None:
    """Return the drive from one pose to another; None if the poses are at the same place and no turn is needed.

    With a turning radius, the shortest Dubins path that stays on the ground; if there is none, a smooth path along the
    shortest one; if that does not fit either, the shortest path with turns on the spot, marked as tight.

    Raises:
        ValueError: No path connects the poses.
    """
    if np.hypot(one.xy[0] - two.xy[0], one.xy[1] - two.xy[1]) < _SAME_M and radius_m == 0.0:
        return None
    way = ground.way(one.xy, two.xy)
    if way is None:
        raise ValueError("no way")
    if radius_m == 0.0:
        return CoverageLeg(kind="transit", points=way)
    smooth = _turn(ground, one, two, radius_m) or _smooth(ground, one, way, two, radius_m)
    if smooth is not None:
        return CoverageLeg(kind="transit", points=smooth)
    return CoverageLeg(kind="transit", points=way, is_tight=True)


def turn_metres(poses: Points, radius_m: float) -> Points:
    """Return the metres of the Dubins paths between the ends of swaths, shape (n, n).

    Args:
        poses: Each end with the angle in which the swath is left there, shape (n, 3).
        radius_m: Turning radius.
    """
    entered = poses + np.array([0.0, 0.0, np.pi])
    return dubins_lengths(poses[:, None], entered[None], radius_m)


def _turn(ground: TransitGround, one: Pose, two: Pose, radius_m: float) -> tuple[XY, ...] | None:
    """Return the shortest of the Dubins paths that fits, with as little driving straight on as possible."""
    for metres in (share * radius_m for share in _STRAIGHT_ON):
        out, back = one.moved(metres), two.moved(-metres)
        for path in dubins_paths(out.array, back.array, radius_m):
            points = _distinct([one.xy, *((x, y) for x, y in path.tolist()), two.xy])
            if len(points) > 1 and ground.covers(LineString(points)):
                return points
    return None


def _smooth(ground: TransitGround, one: Pose, way: Sequence[XY], two: Pose, radius_m: float) -> tuple[XY, ...] | None:
    """Return Dubins paths between the middles of the segments of a path; None if one does not fit."""
    if len(way) < 3:
        return None
    middles = [
        Pose(((a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0), _direction(a, b))
        for a, b in itertools.pairwise(way)
        if np.hypot(b[0] - a[0], b[1] - a[1]) > 2.0 * radius_m
    ]
    points: list[XY] = [one.xy]
    poses = [one, *middles, two]
    for start, goal in itertools.pairwise(poses):
        part = _turn(ground, start, goal, radius_m)
        if part is None:
            return None
        points += part[1:]
    return tuple(points)


def _distinct(points: Sequence[XY]) -> tuple[XY, ...]:
    found = [points[0]]
    for point in points[1:]:
        if np.hypot(point[0] - found[-1][0], point[1] - found[-1][1]) > _SAME_M:
            found.append(point)
    if len(found) > 1:
        found[-1] = points[-1]
    return tuple(found)


def _direction(one: XY, two: XY) -> XY:
    east, north = two[0] - one[0], two[1] - one[1]
    length = float(np.hypot(east, north))
    return (east / length, north / length)
