"""Drivable layout of a site: the ground around rows and keep-outs, and the shortest paths over it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiLineString, MultiPolygon, Point, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.driving.aisles import Aisle, Aisles
from fieldhand.site.driving.free_space import TOUCH_M, Area, closed_off, free_space
from fieldhand.site.driving.graph import Indices, Links, Points, ShortestWays, chain
from fieldhand.site.driving.visibility_graph import VisibilityGraph
from fieldhand.site.model import Site
from fieldhand.site.point_index import PointIndex

if TYPE_CHECKING:
    from fieldhand.site.closed_ground import ClosedGround

XY = tuple[float, float]

#: Number of points whose paths to all corners are cached.
_REMEMBERED = 64

#: A place in the margin of an obstacle is left straight towards ground within this many times its distance from it.
_LEAVE_WITHIN = 8.0

#: Greatest length, in clearances, of a straight path between two places in a margin.
_HOP = 3.0

#: Up to this length in metres, a path between two places beside a row is tested against the trees instead of the row's
#: obstacle.
_BESIDE_M = 20.0

#: Fraction of the first segment that is not tested for obstacles, since the place may lie on the line of a row.
_FROM = 1e-3


@dataclass(frozen=True, kw_only=True, eq=False)
class Spot:
    """A point of the site, and its connection to the drivable ground.

    Attributes:
        xy: Metres east and north.
        foot: Point at which paths enter the drivable ground: the point itself, or one nearby if it lies within the
            clearance of an obstacle; None if there is none.
        spur: Metres from the point to the foot.
        part: Number of the connected part of the ground that contains the foot; -1 without a foot.
    """

    xy: XY
    foot: XY | None
    spur: float
    part: int


class Layout:
    """The free space without the row obstacles, the aisles, and the visibility graph of the ground.

    Args:
        site: Site with rows, zones and gates.
        clearance_m: Distance in metres that the robot keeps from tree lines, keep-outs and the boundary.
        standoff_m: Distance in metres from a tree to its stand; also the distance beyond the last trees at which the
            robot turns, if there is room.
        closed: Ground that the mission keeps out of; the obstacles of the rows are the same as without it.
    """

    def __init__(self, site: Site, clearance_m: float, standoff_m: float, closed: Sequence[ClosedGround] = ()) -> None:
        free = free_space(site, clearance_m)
        self.aisles = Aisles(site, free, max(standoff_m, clearance_m))
        self.free = closed_off(free, closed)
        obstacles = self.aisles.obstacles
        self.open = bool(self.free.bounded or obstacles)
        self.soft = self.free.soft.difference(_union([body.polygon for body in obstacles]))
        axes = [np.stack([body.axis[:-1], body.axis[1:]], axis=1) for body in obstacles]
        self.visibility = VisibilityGraph(self.soft, np.concatenate([np.empty((0, 2, 2)), *axes]), self._barriers())
        self.graph = self.visibility.graph
        self._spots: dict[XY, Spot] = {}
        self._links: dict[XY, Links] = {}
        self._remembered: dict[XY, ShortestWays] = {}

    def _barriers(self) -> BaseGeometry:
        """Return the lines that a straight line off the drivable ground crosses: its outer edge, and through rows."""
        rows = [line for body in self.aisles.obstacles for line in body.barriers]
        numbers = np.repeat(np.arange(len(rows)), [len(line) for line in rows])
        lines = np.array(shapely.linestrings(np.concatenate([np.empty((0, 2)), *rows]), indices=numbers))
        edge = self.free.soft.buffer(TOUCH_M, join_style="mitre").boundary
        return MultiLineString([*shapely.get_parts(edge), *lines])

    # --- points -----------------------------------------------------------------------------------------------

    def spot(self, xy: XY) -> Spot:
        """Return the spot of a point, cached."""
        return self.spots([xy])[0]

    def spots(self, places: Sequence[XY]) -> list[Spot]:
        """Return the spots of points, cached."""
        new = [xy for xy in dict.fromkeys(places) if xy not in self._spots]
        if new:
            self._spots.update((spot.xy, spot) for spot in self._locate(new))
        return [self._spots[xy] for xy in places]

    def aisle(self, xy: XY) -> Aisle | None:
        """Return the aisle in which a point lies; None on open ground."""
        return self.aisles.at(np.array([xy]))[0]

    def are_free(self, xy: Points) -> NDArray[np.bool_]:
        """Return which of the points, shape (n, 2), are inside the boundary and outside every keep-out."""
        return self.free.holds(xy, soft=False) if self.free.bounded else np.ones(len(xy), dtype=bool)

    def is_clear(self, xy: Points) -> NDArray[np.bool_]:
        """Return which of the points, shape (n, 2), keep the clearance from keep-outs and the boundary."""
        return self.free.holds(xy, soft=True) if self.free.bounded else np.ones(len(xy), dtype=bool)

    def in_the_way(self, xy: XY) -> str:
        """Return the obstacle that prevents a robot from being at a point, in words; empty if there is none."""
        return self.free.in_the_way(Point(xy)) if self.free.bounded else ""

    def reachable(self, spots: Sequence[Spot], origin: Spot) -> list[bool]:
        """Return which of the spots can be reached from the origin."""
        return [
            not self.open or spot.xy == origin.xy or (spot.part == origin.part and spot.part >= 0) for spot in spots
        ]

    def is_one_view(self, spots: Sequence[Spot]) -> bool:
        """Return True if every path between the spots is a straight line."""
        on_one_part = all(spot.spur == 0.0 and spot.part == spots[0].part >= 0 for spot in spots)
        return not self.open or (not self.graph.count and on_one_part)

    def part(self, number: int) -> shapely.Geometry:
        """Return a connected part of the drivable ground."""
        return self._parts[number].edged

    @cached_property
    def _parts(self) -> list[Area]:
        shapes = [shape for shape in getattr(self.soft, "geoms", [self.soft]) if not shape.is_empty]
        return [self.visibility.area] if len(shapes) == 1 else [Area(shape) for shape in shapes]

    def _locate(self, places: Sequence[XY]) -> Iterator[Spot]:
        at = np.array(places)
        feet = at.copy()
        for k in np.flatnonzero(~self.visibility.area.holds(at)).tolist():
            feet[k] = self._foot(at[k])
        parts = np.full(len(at), -1)
        for number in reversed(range(len(self._parts))):
            west, south, east, north = self._parts[number].edged.bounds
            x, y = feet.T
            inside = np.flatnonzero((x >= west) & (x <= east) & (y >= south) & (y <= north))
            parts[inside[self._parts[number].holds(feet[inside])]] = number
        spurs = np.hypot(*(feet - at).T)
        for xy, (x, y), spur, part in zip(places, feet.tolist(), spurs.tolist(), parts.tolist(), strict=True):
            yield Spot(xy=xy, foot=(x, y) if part >= 0 else None, spur=spur if part >= 0 else 0.0, part=part)

    def _foot(self, at: Points) -> Points:
        """Return the nearest point of the drivable ground with a clear straight line to it; nan if there is none."""
        point = Point(at)
        if self.soft.is_empty:
            return np.full(2, np.nan)
        away = float(self.soft.distance(point))
        near = self._edges.query(point, predicate="dwithin", distance=_LEAVE_WITHIN * (away + self.free.clearance_m))
        feet = shapely.get_coordinates(shapely.shortest_line(point, self._edges.geometries[near])).reshape(-1, 2, 2)[
            :, 1
        ]
        feet = feet[np.argsort(np.hypot(*(feet - at).T), kind="stable")]
        free = self._is_free(at + _FROM * (feet - at), feet)
        return feet[int(np.argmax(free))] if free.any() else np.full(2, np.nan)

    @cached_property
    def _edges(self) -> shapely.STRtree:
        """Return the edges of the drivable ground."""
        rings = shapely.get_parts(shapely.get_rings(shapely.get_parts(self.soft)))
        sides = [np.stack([at[:-1], at[1:]], axis=1) for at in map(shapely.get_coordinates, rings)]
        return shapely.STRtree(np.array(shapely.linestrings(np.concatenate([np.empty((0, 2, 2)), *sides]))))

    def _is_free(self, one: Points, two: Points) -> NDArray[np.bool_]:
        """Return which straight lines cross no keep-out, no boundary and no line of trees."""
        free = self.free.sees(one, two, soft=False) if self.free.bounded else np.ones(len(one), dtype=bool)
        lines = shapely.linestrings(np.stack([one, two], axis=1))
        free[self.aisles.row_lines.query(lines, predicate="intersects")[0]] = False
        return free

    # --- paths ------------------------------------------------------------------------------------------------

    def way(self, a: Spot, b: Spot) -> tuple[XY, ...] | None:
        """Return the points of the shortest path from a spot to another; None if there is none."""
        if a.foot is None or b.foot is None or a.part != b.part:
            return None
        only = np.zeros(1, dtype=np.intp)
        straight, by_feet = self._straight(_Feet.of([a]), _Feet.of([b]), only, only)
        if straight[0] <= by_feet[0] and math.isfinite(straight[0]):
            return _points([a.xy, b.xy])
        if math.isfinite(by_feet[0]):
            return _points([a.xy, a.foot, b.foot, b.xy])
        rows = self._rows(a)
        (there,) = self.links([b])
        around = rows.metres[0, there.nodes] + there.metres
        if not np.isfinite(around).any():
            return None
        nodes = chain(rows, 0, int(there.nodes[np.argmin(around)]))
        corners = [(x, y) for x, y in self.visibility.corners[nodes].tolist()]
        return _points([a.xy, a.foot, *corners, b.foot, b.xy])

    def lengths(self, rows: Sequence[Spot], columns: Sequence[Spot] | None = None) -> Points:
        """Return the lengths in metres of the shortest paths between two sets of spots, shape (n, m); inf if there is
        no path. Without ``columns``, both sets are ``rows``."""
        others = rows if columns is None else columns
        self.links([*rows, *others])
        best = self.graph.lengths(self.links(rows), None if columns is None else self.links(columns))
        one = _Feet.of(rows)
        two = one if columns is None else _Feet.of(columns)
        for i, j in self._may_see(one, None if columns is None else two):
            length = np.minimum(*self._straight(one, two, i, j, below=best[i, j]))
            np.minimum.at(best, (i, j), length)
            if columns is None:
                np.minimum.at(best, (j, i), length)
        there = {s.xy: k for k, s in enumerate(others)}
        same = [(k, there[s.xy]) for k, s in enumerate(rows) if s.xy in there]
        best[[k for k, _ in same], [k for _, k in same]] = 0.0
        return best

    def links(self, spots: Sequence[Spot]) -> list[Links]:
        """Return the corners that each spot sees from its foot, with the metres from the spot; cached."""
        new = {s.xy: s for s in spots if s.xy not in self._links}
        seen = {s.xy: s for s in new.values() if s.foot is not None}
        found = self.visibility.links(np.array([s.foot for s in seen.values()]).reshape(-1, 2))
        self._links.update((xy, Links.none()) for xy in new)
        for spot, links in zip(seen.values(), found, strict=True):
            self._links[spot.xy] = links if spot.spur == 0.0 else Links(links.nodes, links.metres + spot.spur)
        return [self._links[s.xy] for s in spots]

    def straight(self, spots: Sequence[Spot], i: Indices, j: Indices) -> Points:
        """Return the metres from spot i to spot j without turning at a corner, shape (n,); inf if that is blocked."""
        feet = _Feet.of(spots)
        return np.minimum(*self._straight(feet, feet, i, j))

    def _rows(self, spot: Spot) -> ShortestWays:
        """Return the paths from a spot to every corner; those of the last few spots are cached."""
        if spot.xy not in self._remembered:
            if len(self._remembered) >= _REMEMBERED:
                self._remembered.pop(next(iter(self._remembered)))
            self._remembered[spot.xy] = self.graph.rows(self.links([spot]))
        return self._remembered[spot.xy]

    def _may_see(self, one: _Feet, two: _Feet | None) -> Iterator[tuple[Indices, Indices]]:
        """Yield index pairs of spots that may see each other from their feet, or directly beside a row."""
        to = one if two is None else two
        rows, columns = np.flatnonzero(one.part >= 0), np.flatnonzero(to.part >= 0)
        for i, j in self.visibility.pairs(one.foot[rows], None if two is None else two.foot[columns]):
            yield rows[i], columns[j]
        yield _beside(one, to)
        if two is not None:
            yield _beside(two, one)[::-1]

    def _straight(
        self, one: _Feet, two: _Feet, i: Indices, j: Indices, below: Points | None = None
    ) -> tuple[Points, Points]:
        """Return the metres from spot i to spot j in a straight line, and those by way of both feet; inf if the line is
        blocked or the length is not less than ``below``."""
        below = np.full(len(i), np.inf) if below is None else below
        spurs = one.spur[i] + two.spur[j]
        by_feet = spurs + np.hypot(*(one.foot[i] - two.foot[j]).T)
        tried = np.flatnonzero(by_feet < below)
        clear = self.visibility.area.sees(one.foot[i[tried]], two.foot[j[tried]])
        by_feet[tried[~clear]] = np.inf
        by_feet[by_feet >= below] = np.inf
        straight = np.where(spurs == 0.0, by_feet, np.inf)
        metres = np.hypot(*(one.at[i] - two.at[j]).T)
        beside = np.flatnonzero((spurs > 0.0) & (metres <= _BESIDE_M) & (metres < below))
        if len(beside):
            clear = self._is_beside(one.at[i[beside]], two.at[j[beside]], metres[beside])
            straight[beside[clear]] = metres[beside[clear]]
        return straight, by_feet

    def _is_beside(self, one: Points, two: Points, metres: Points) -> NDArray[np.bool_]:
        """Return which straight lines between places in a margin can be driven.

        They keep the clearance from trees, keep-outs and the boundary, but not from row obstacles; or they cross free
        ground over a few clearances only.
        """
        clear = self.free.sees(one, two, soft=True) if self.free.bounded else np.ones(len(one), dtype=bool)
        lines = shapely.linestrings(np.stack([one, two], axis=1))
        near = self.aisles.row_lines.query(lines, predicate="dwithin", distance=self.free.clearance_m - 1e-9)[0]
        clear[near] = False
        hop = np.flatnonzero(~clear & (metres <= _HOP * self.free.clearance_m))
        clear[hop] = self._is_free(one[hop], two[hop])
        return clear


@dataclass(frozen=True, eq=False)
class _Feet:
    """Spots as arrays: positions, feet (nan if missing), spurs, and parts of the ground."""

    at: Points
    foot: Points
    spur: Points
    part: Indices

    @staticmethod
    def of(spots: Sequence[Spot]) -> _Feet:
        foot = np.array([(math.nan, math.nan) if s.foot is None else s.foot for s in spots]).reshape(-1, 2)
        at = np.array([s.xy for s in spots]).reshape(-1, 2)
        part = np.array([s.part for s in spots], dtype=np.intp)
        return _Feet(at, foot, np.array([s.spur for s in spots]), part)


def _union(shapes: Sequence[Polygon]) -> BaseGeometry:
    """Return the union of shapes, which are mostly disjoint: that is much faster to check than to compute the union."""
    together = MultiPolygon(shapes)
    return together if together.is_valid else shapely.union_all(shapes)


def _beside(one: _Feet, two: _Feet) -> tuple[Indices, Indices]:
    """Return index pairs of spots of ``one`` off the drivable ground and nearby spots of ``two``, beside a row."""
    off = np.flatnonzero(one.spur > 0.0)
    near = PointIndex(two.at).close_to(one.at[off], _BESIDE_M)
    i, j = off[near[:, 0]], near[:, 1]
    on_one_part = one.part[i] == two.part[j]
    return i[on_one_part], j[on_one_part]


def _points(way: Sequence[XY]) -> tuple[XY, ...]:
    """Return a path without repeated and collinear points."""
    found: list[XY] = [way[0]]
    for x, y in way[1:]:
        if math.hypot(x - found[-1][0], y - found[-1][1]) < 1e-9:
            continue
        while len(found) > 1 and _is_straight(found[-2], found[-1], (x, y)):
            found.pop()
        found.append((x, y))
    return (*found[:-1], way[-1]) if len(found) > 1 else (way[0], way[-1])


def _is_straight(a: XY, b: XY, c: XY) -> bool:
    """Return True if b lies on the line from a to c."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]
    return abs(ux * vy - uy * vx) < 1e-9 * math.hypot(ux, uy) * math.hypot(vx, vy) and ux * vx + uy * vy > 0.0
