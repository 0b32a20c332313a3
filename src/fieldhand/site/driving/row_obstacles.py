"""Obstacles of the rows: a polygon with few corners around the trees of each row, which the robot's centre avoids."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry import LineString, Polygon

from fieldhand.site.driving.free_space import TOUCH_M, FreeSpace
from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.rowlines import Frame
from fieldhand.site.planting import Block

#: Fraction of the spare room on each side that an obstacle may take up, so that it has few corners.
_GIVE = 0.2

#: Distances beyond the robot's width plus this many standoffs are not measured: they leave enough room.
_FAR = 4.0

#: Steps from tree to tree in each piece of a row whose distance from other rows is measured.
_PIECE = 6

#: Least half width of an obstacle in metres.
_THIN_M = 0.01

#: Length in metres assumed for a row of one tree.
_SHORT_M = 0.02


@dataclass(frozen=True, eq=False)
class RowObstacle:
    """The ground around a row that the robot's centre avoids.

    Attributes:
        axis: Centre line from end to end, shape (n, 2); no path crosses it.
        half_m: Half width in metres.
    """

    axis: Points
    half_m: float

    @property
    def is_straight(self) -> bool:
        """Return True if it is a rectangle."""
        return len(self.axis) == 2

    @property
    def polygon(self) -> Polygon:
        """Return its outline."""
        if self.is_straight:
            return Polygon(np.concatenate(self.ends))
        return LineString(self.axis).buffer(self.half_m, cap_style="flat", join_style="mitre")

    @cached_property
    def ends(self) -> tuple[Points, Points]:
        """Return the corners of its first and of its last end, shape (2, 2) each."""
        (first_x, first_y), (last_x, last_y) = self._ahead(0, 1), self._ahead(-1, -2)
        first = self.half_m * np.array([(first_y, -first_x), (-first_y, first_x)])
        last = self.half_m * np.array([(last_y, -last_x), (-last_y, last_x)])
        return self.axis[0] + first, self.axis[-1] + last

    @property
    def barriers(self) -> list[Points]:
        """Return lines inside it, shape (n, 2) each, one of which every straight line across it meets.

        A line across a rectangle that meets neither of its ends meets its axis.
        """
        if not self.is_straight:
            shrunk = self.polygon.buffer(-TOUCH_M, join_style="mitre")
            return [shapely.get_coordinates(ring) for ring in shapely.get_rings(shapely.get_parts(shrunk))]
        ahead = np.array(self._ahead(-1, -2))
        inner = RowObstacle(self.axis + TOUCH_M * np.array([ahead, -ahead]), self.half_m - TOUCH_M)
        return [inner.axis, *inner.ends]

    def _ahead(self, end: int, inner: int) -> tuple[float, float]:
        """Return the direction in which an end points, as a unit vector."""
        x, y = (self.axis[end] - self.axis[inner]).tolist()
        length = math.hypot(x, y)
        return x / length, y / length


def row_obstacles(
    rows: Sequence[Points], blocks: Sequence[tuple[Frame, Block]], free: FreeSpace, standoff_m: float
) -> list[RowObstacle]:
    """Return the obstacles of rows.

    An obstacle is straight if its row is straight enough for the room beside it; else it follows the row. It extends
    beyond the last trees by the standoff, or by less where room is needed to drive past its end.

    Args:
        rows: Trees of each row from end to end, shape (n, 2).
        blocks: Axes and block of each row.
        free: Ground outside keep-outs.
        standoff_m: Distance in metres from a tree to its stand.
    """
    if not rows:
        return []
    lines = [_ordered(xy, frame) for xy, (frame, _) in zip(rows, blocks, strict=True)]
    room = _room_beside(lines, _FAR * standoff_m + 2.0 * free.clearance_m)
    spare = np.minimum(room, _room_to_edges(lines, free)) - 2.0 * free.clearance_m
    found = []
    for line, to_spare, (frame, block) in zip(lines, spare.tolist(), blocks, strict=True):
        axis, off = _straightened(shapely.get_coordinates(line), frame, _GIVE * max(to_spare, 0.0))
        spacing = block.row_spacing_m if len(block.rows) > 1 and np.isfinite(block.row_spacing_m) else 2.0 * standoff_m
        turn = max(min(standoff_m, spacing / 2.0), free.clearance_m)
        found.append((axis, max(free.clearance_m, _THIN_M) + off, turn))
    return _extended(found, lines, free)


def _ordered(xy: Points, frame: Frame) -> LineString:
    if len(xy) > 1 and float(np.hypot(*np.ptp(xy, axis=0))) > _SHORT_M:
        u = frame.local(xy[[0, -1]])[:, 0]
        return LineString(xy if u[0] <= u[1] else xy[::-1])
    middle = xy.mean(axis=0)
    return LineString([middle - _SHORT_M / 2.0 * frame.along, middle + _SHORT_M / 2.0 * frame.along])


def _room_beside(lines: Sequence[LineString], most_m: float) -> Points:
    """Return the distance in metres from each line to the next one, at most ``most_m``."""
    xy = [shapely.get_coordinates(line) for line in lines]
    pieces = [(k, at[i : i + _PIECE + 1]) for k, at in enumerate(xy) for i in range(0, len(at) - 1, _PIECE)]
    of = np.array([k for k, _ in pieces])
    numbers = np.repeat(np.arange(len(pieces)), [len(at) for _, at in pieces])
    shapes = np.array(shapely.linestrings(np.concatenate([at for _, at in pieces]), indices=numbers))
    west, south, east, north = shapely.bounds(shapes).T
    # Selecting by bounding boxes and then measuring is faster than a distance query of the tree.
    near = shapely.box(west - most_m, south - most_m, east + most_m, north + most_m)
    one, two = shapely.STRtree(shapes).query(near)
    one, two = one[of[one] < of[two]], two[of[one] < of[two]]
    metres = shapely.distance(shapes[one], shapes[two])
    room = np.full(len(lines), most_m)
    np.minimum.at(room, of[one], metres)
    np.minimum.at(room, of[two], metres)
    return room


def _room_to_edges(lines: Sequence[LineString], free: FreeSpace) -> Points:
    """Return the metres from each line to the edge of free ground; if the edge crosses the line, from its ends."""
    if not free.bounded:
        return np.full(len(lines), np.inf)
    edge = free.hard.boundary
    shapely.prepare(edge)
    away = shapely.distance(np.array(lines), edge)
    ends = np.array([shapely.get_coordinates(line)[[0, -1]] for line in lines]).reshape(-1, 2)
    from_ends = shapely.distance(np.array(shapely.points(ends)), edge).reshape(-1, 2).min(axis=1)
    return np.where(away > 0.0, away, from_ends)


def _straightened(xy: Points, frame: Frame, tolerance_m: float) -> tuple[Points, float]:
    """Return a simplified line through a row, and the greatest distance of a tree from it."""
    middle = xy.mean(axis=0)
    along = np.linalg.svd(xy - middle, full_matrices=False)[2][0]
    along = along if along @ frame.along > 0.0 else -along
    across = np.array([-along[1], along[0]])
    u, v = (xy - middle) @ along, (xy - middle) @ across
    beside = float(np.ptp(v)) / 2.0
    if beside <= tolerance_m:
        centre = middle + (v.min() + v.max()) / 2.0 * across
        return np.array([centre + u.min() * along, centre + u.max() * along]), beside
    line = LineString(xy).simplify(tolerance_m)
    return shapely.get_coordinates(line), float(shapely.distance(shapely.points(xy), line).max())


def _extended(
    obstacles: Sequence[tuple[Points, float, float]], lines: Sequence[LineString], free: FreeSpace
) -> list[RowObstacle]:
    """Return the obstacles with their ends extended by the turning room, or by less near other obstacles."""
    tips = np.array([axis[[0, -1]] for axis, _, _ in obstacles])
    ahead = np.array([[axis[0] - axis[1], axis[-1] - axis[-2]] for axis, _, _ in obstacles])
    ahead /= np.hypot(ahead[..., 0], ahead[..., 1])[..., None]
    half = np.array([half_m for _, half_m, _ in obstacles])[:, None, None]
    beside = half * np.stack([-ahead[..., 1], ahead[..., 0]], axis=2)
    turn = np.repeat([[turn] for _, _, turn in obstacles], 2, axis=1)
    # Rays from the middle and from both corners of each end.
    start = np.stack([tips - beside, tips, tips + beside], axis=2).reshape(-1, 2)
    reach = np.repeat(3.0 * turn[..., None] * ahead, 3, axis=1).reshape(-1, 2)
    rays = np.array(shapely.linestrings(np.stack([start, start + reach], axis=1)))
    points = np.array(shapely.points(start))
    out = np.repeat(turn.ravel(), 3)
    if free.bounded:  # half the distance to an edge stays free to drive through
        away = shapely.distance(points, shapely.intersection(rays, free.hard.boundary))
        out = np.fmin(out, np.where(np.isnan(away), np.inf, away) / 2.0)
    which, other = shapely.STRtree(lines).query(rays, predicate="intersects")
    which, other = which[which // 6 != other], other[which // 6 != other]
    meets = shapely.intersection(rays[which], np.array(lines)[other])
    np.minimum.at(out, which, shapely.distance(points[which], meets) / 3.0)  # the other row may extend as far
    out = np.maximum(out, free.clearance_m).reshape(-1, 2, 3).min(axis=2)
    found = []
    for (axis, half_m, _), tip, away, metres in zip(obstacles, tips, ahead, out, strict=True):
        moved = tip + metres[:, None] * away
        found.append(RowObstacle(np.vstack([moved[:1], axis[1:-1], moved[1:]]), half_m))
    return found
