"""The ground that may be driven on, and the shortest ways over it.

The shortest way in the plane turns only at corners of what is in the way, so it is found in the graph of corners that
see each other (a visibility graph: Lozano-Pérez and Wesley 1979).

There are two grounds. *Hard* ground is inside the boundary and outside every keep-out; nothing ever leaves it. *Soft*
ground is hard ground without the band of the clearance along its edges; ways keep to it. A place that stands in the
band (a tree beside the pond) is reached over hard ground within a few clearances of it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from shapely.geometry import MultiPolygon, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient
from shapely.ops import nearest_points

XY = tuple[float, float]
Points = NDArray[np.float64]

#: Ways run along edges, so what reaches less than this past an edge is a touch.
_TOUCH_M = 1e-6

#: The arc around a corner is drawn with this many chords a quarter turn, outside the true arc.
_CHORDS = 2

#: A traced pond may have thousands of corners. More than this are thinned out, by keeping up to so much farther away.
_MANY_CORNERS = 300
_GIVE_M = (0.05, 0.1, 0.2, 0.4)

#: Over hard ground a place is left within this many clearances (beyond its own distance to soft ground).
_LEAVE_WITHIN = 3.0
_WIDER = (1.0, 2.0, 4.0, 8.0)
_MOST_EXITS = 40


@dataclass(frozen=True, eq=False)
class Access:
    """How one place reaches soft ground.

    Attributes:
        at: The place.
        radius: Within this of the place a way may use hard ground; 0 for a place on soft ground.
        nodes: The place itself, then the points by which it can be left, shape (m, 2).
        walked: Metres from the place to each node (inf: not reached), and by which node.
        to_corner: Metres from the place to each corner of the ground, and by which node.
    """

    at: Points
    radius: float
    nodes: Points
    walked: Points
    walked_by: NDArray[np.intp]
    to_corner: Points
    to_corner_by: NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Corners:
    """Where ways can turn, shape (n, 2) each; ``vertices`` are all vertices of the ground.

    Attributes:
        before, after: The edges that meet at each corner, along the ring.
    """

    at: Points
    before: Points
    after: Points
    vertices: Points

    def touched(self, which: NDArray[np.intp], towards: Points) -> NDArray[np.bool_]:
        """Whether a line from a corner in this direction only touches the obstacle there: a shortest way has no other
        lines at its turns."""
        before, after = -self.before[which], self.after[which]
        return np.asarray(_cross(towards, before) * _cross(towards, after) >= -1e-9)


class Ground:
    """Hard and soft ground, the corners of the soft ground, and how they see each other.

    Args:
        hard: Where a robot may be at all.
        clearance_m: Width of the band that soft ground leaves out.
    """

    def __init__(self, hard: BaseGeometry, clearance_m: float) -> None:
        self._clearance_m = clearance_m
        self._soft, self._turns = _soft_ground(hard, clearance_m)
        self._corners = self._turns.at
        self._exits = np.vstack([self._turns.vertices, _corners(hard).at])
        self._hard_and_edge = hard.buffer(_TOUCH_M, join_style="mitre")
        self._soft_and_edge = self._soft.buffer(_TOUCH_M, join_style="mitre")
        shapely.prepare(self._hard_and_edge)
        shapely.prepare(self._soft_and_edge)
        self._ways, self._ways_by = self._corner_graph()
        self._accesses: dict[XY, Access] = {}

    def way(self, one: XY, two: XY) -> tuple[XY, ...] | None:
        """The points of the shortest way between two places on hard ground; None if there is none."""
        a, b = self._access(one), self._access(two)
        around, k, last = _by_corners(a, b, self._ways)
        direct, i, j = self._direct(a, b, around)
        if math.isinf(min(around, direct)):
            return None
        if direct <= around:
            return _points([*_chain(a, i), *reversed(_chain(b, j))])
        between = [last]
        while between[-1] != k:
            between.append(int(self._ways_by[k, between[-1]]))
        start = _chain(a, int(a.to_corner_by[k]))
        finish = _chain(b, int(b.to_corner_by[last]))
        return _points([*start, *(self._corners[c] for c in reversed(between)), *reversed(finish)])

    def lengths(self, xy: Points) -> Points:
        """Metres of the shortest way between every two of these places, shape (n, n); inf where there is none."""
        accesses = [self._access((x, y)) for x, y in xy.tolist()]
        best: Points = self._around(accesses)
        owner = np.repeat(np.arange(len(accesses)), [len(a.nodes) for a in accesses])
        nodes = np.vstack([a.nodes for a in accesses])
        walked = np.concatenate([a.walked for a in accesses])
        centre = np.array([a.at for a in accesses])[owner]
        radius = np.array([a.radius for a in accesses])[owner]
        one, two = np.triu_indices(len(nodes), k=1)
        length = walked[one] + walked[two] + np.hypot(*(nodes[one] - nodes[two]).T)
        tried = (owner[one] != owner[two]) & (length < best[owner[one], owner[two]])
        one, two, length = one[tried], two[tried], length[tried]
        clear = self._clear(nodes[one], nodes[two], (centre[one], radius[one]), (centre[two], radius[two]))
        i, j, length = owner[one[clear]], owner[two[clear]], length[clear]
        np.minimum.at(best, (i, j), length)
        np.minimum.at(best, (j, i), length)
        np.fill_diagonal(best, 0.0)
        return best

    def _around(self, accesses: Sequence[Access]) -> Points:
        """Metres between every two places by way of corners."""
        n = len(accesses)
        to_corner = np.array([a.to_corner for a in accesses]).reshape(n, -1)
        reached = np.full_like(to_corner, np.inf)
        for k in range(to_corner.shape[1]):
            np.minimum(reached, to_corner[:, k, None] + self._ways[k], out=reached)
        best = np.full((n, n), np.inf)
        for k in range(to_corner.shape[1]):
            np.minimum(best, reached[:, k, None] + to_corner[None, :, k], out=best)
        return np.asarray(np.minimum(best, best.T), dtype=np.float64)

    def _direct(self, a: Access, b: Access, below: float) -> tuple[float, int, int]:
        """The shortest way that turns at no corner, only where the places leave and enter their band."""
        i, j = (g.ravel() for g in np.indices((len(a.nodes), len(b.nodes))))
        length = a.walked[i] + b.walked[j] + np.hypot(*(a.nodes[i] - b.nodes[j]).T)
        i, j, length = i[length < below], j[length < below], length[length < below]
        m = len(i)
        clear = self._clear(
            a.nodes[i],
            b.nodes[j],
            (np.tile(a.at, (m, 1)), np.full(m, a.radius)),
            (np.tile(b.at, (m, 1)), np.full(m, b.radius)),
        )
        if not clear.any():
            return math.inf, 0, 0
        best = int(np.argmin(np.where(clear, length, np.inf)))
        return float(length[best]), int(i[best]), int(j[best])

    def _corner_graph(self) -> tuple[Points, NDArray[np.intp]]:
        """Shortest metres from corner to corner, and the corner before the last on that way."""
        n = len(self._corners)
        if n == 0:
            return np.zeros((0, 0)), np.zeros((0, 0), dtype=np.intp)
        one, two = np.triu_indices(n, k=1)
        line = self._corners[two] - self._corners[one]
        touching = self._turns.touched(one, line) & self._turns.touched(two, line)
        one, two = one[touching], two[touching]
        clear = self._clear(self._corners[one], self._corners[two])
        length = np.hypot(*(self._corners[one] - self._corners[two]).T)
        graph = np.zeros((n, n))
        graph[one[clear], two[clear]] = length[clear]
        ways, before = dijkstra(graph, directed=False, return_predecessors=True)
        return np.asarray(ways), np.asarray(before, dtype=np.intp)

    def _access(self, xy: XY) -> Access:
        if xy not in self._accesses:
            at = np.array(xy)
            if shapely.intersects_xy(self._soft_and_edge, at[0], at[1]):
                self._accesses[xy] = self._reach(at, 0.0, at[None, :])
            else:
                self._accesses[xy] = self._leave(at)
        return self._accesses[xy]

    def _leave(self, at: Points) -> Access:
        """From a place in the band: the radius is widened until some soft ground is reached."""
        nearest = [] if self._soft.is_empty else [np.array(nearest_points(self._soft, Point(at))[0].coords[0])]
        distance = float(np.hypot(*(nearest[0] - at))) if nearest else 0.0
        for wider in _WIDER:
            radius = wider * (distance + _LEAVE_WITHIN * self._clearance_m)
            exits = np.vstack([*nearest, self._exits])
            away = np.hypot(*(exits - at).T)
            order = np.argsort(away, kind="stable")[:_MOST_EXITS]
            access = self._reach(at, radius, np.vstack([at, exits[order][away[order] <= radius]]))
            got = access.nodes[np.isfinite(access.walked)]
            if shapely.intersects_xy(self._soft_and_edge, got[:, 0], got[:, 1]).any():
                break
        return access

    def _reach(self, at: Points, radius: float, nodes: Points) -> Access:
        """Metres from a place over its nodes, and on to every corner."""
        m, n = len(nodes), len(self._corners)
        walked, by = np.zeros(1), np.full(1, -1, dtype=np.intp)
        disk = (np.tile(at, (m * max(m, n), 1)), np.full(m * max(m, n), radius))
        if m > 1:
            i, j = (g.ravel() for g in np.indices((m, m)))
            clear = self._clear(
                nodes[i], nodes[j], (disk[0][: m * m], disk[1][: m * m]), (disk[0][: m * m], disk[1][: m * m])
            )
            graph = np.where(clear, np.hypot(*(nodes[i] - nodes[j]).T), 0.0).reshape(m, m)
            found = dijkstra(np.asarray(graph), directed=False, indices=[0], return_predecessors=True)
            walked, by = np.asarray(found[0][0]), np.asarray(found[1][0], dtype=np.intp)
        i, k = (g.ravel() for g in np.indices((m, n)))
        if radius == 0.0:
            clear = self._turns.touched(k, nodes[i] - self._corners[k])
            clear[clear] = self._clear(nodes[i[clear]], self._corners[k[clear]])
        else:
            clear = self._clear(nodes[i], self._corners[k], (disk[0][: m * n], disk[1][: m * n]))
        length = np.where(clear, walked[i] + np.hypot(*(nodes[i] - self._corners[k]).T), np.inf).reshape(m, n)
        return Access(at, radius, nodes, walked, by, length.min(axis=0), length.argmin(axis=0))

    def _clear(
        self,
        one: Points,
        two: Points,
        near_one: tuple[Points, Points] | None = None,
        near_two: tuple[Points, Points] | None = None,
    ) -> NDArray[np.bool_]:
        """Which straight lines may be driven: over soft ground, or over hard ground while inside the disks (centres,
        radii) that the line begins or ends in."""
        if len(one) == 0:
            return np.zeros(0, dtype=bool)
        clear = np.asarray(shapely.covers(self._soft_and_edge, _lines(one, two)))
        leave, enter = np.zeros(len(one)), np.ones(len(one))
        if near_one is not None:
            leave = _inside_until(one, two, *near_one)
        if near_two is not None:
            enter = 1.0 - _inside_until(two, one, *near_two)
        maybe = np.flatnonzero(~clear & ((leave > 0.0) | (enter < 1.0)))
        if len(maybe):
            a, b = one[maybe], two[maybe]
            t, u = np.minimum(leave[maybe], enter[maybe]), np.maximum(leave[maybe], enter[maybe])
            all_disk = leave[maybe] >= enter[maybe]
            middle = _lines(a + t[:, None] * (b - a), a + u[:, None] * (b - a))
            clear[maybe] = shapely.covers(self._hard_and_edge, _lines(a, b)) & (
                all_disk | shapely.covers(self._soft_and_edge, middle)
            )
        return clear


def _lines(one: Points, two: Points) -> NDArray[np.object_]:
    return np.asarray(shapely.linestrings(np.stack([one, two], axis=1)))


def _inside_until(one: Points, two: Points, centre: Points, radius: Points) -> Points:
    """The part of each line, from its beginning, that lies in a disk around its beginning: 0 to 1."""
    d, f = two - one, one - centre
    a = np.maximum((d * d).sum(axis=1), 1e-18)
    b = (d * f).sum(axis=1)
    c = (f * f).sum(axis=1) - radius**2
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    return np.where((radius > 0.0) & (c <= 1e-9), np.clip((root - b) / a, 0.0, 1.0), 0.0)


def _by_corners(a: Access, b: Access, ways: Points) -> tuple[float, int, int]:
    """The shortest way by corners: metres, first corner, last corner."""
    if len(a.to_corner) == 0:
        return math.inf, 0, 0
    total = a.to_corner[:, None] + ways + b.to_corner[None, :]
    first, last = np.unravel_index(int(np.argmin(total)), total.shape)
    return float(total[first, last]), int(first), int(last)


def _chain(access: Access, node: int) -> list[Points]:
    """The points from a place to one of its nodes."""
    chain = [access.nodes[node]]
    while node > 0:
        node = int(access.walked_by[node])
        chain.append(access.nodes[node])
    return chain[::-1]


def _points(points: Sequence[Points]) -> tuple[XY, ...]:
    """As numbers, without repeated points."""
    way: list[XY] = []
    for x, y in (p.tolist() for p in points):
        if not way or (x, y) != way[-1]:
            way.append((x, y))
    return tuple(way)


def _soft_ground(hard: BaseGeometry, clearance_m: float) -> tuple[BaseGeometry, Corners]:
    """Soft ground and its corners. Too many corners are thinned, giving ground up."""
    soft = _shrunk(hard, clearance_m, _CHORDS)
    corners = _corners(soft)
    for give in _GIVE_M:
        if len(corners.at) <= _MANY_CORNERS:
            break
        soft = _shrunk(hard.buffer(-give).simplify(0.9 * give), clearance_m, 1)
        corners = _corners(soft)
    return soft, corners


def _shrunk(ground: BaseGeometry, by: float, chords: int) -> BaseGeometry:
    """The ground without a band along its edges, that is nowhere narrower than ``by``."""
    if by <= 0.0:
        return ground
    return ground.buffer(-by / math.cos(math.pi / (4 * chords)), quad_segs=chords)


def _corners(ground: BaseGeometry) -> Corners:
    """The vertices at which a way can turn: the ground takes more than half a turn there."""
    parts = ground.geoms if isinstance(ground, MultiPolygon) else [ground]
    found = [np.empty((3, 0, 2))]
    vertices = [np.empty((0, 2))]
    for part in parts:
        if not isinstance(part, Polygon) or part.is_empty:
            continue
        turned = orient(part)  # the ground on the left of every ring
        for ring in (turned.exterior, *turned.interiors):
            at = shapely.get_coordinates(ring)[:-1]
            before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
            corner = _cross(before, after) < 0.0
            found.append(np.stack([at, before, after])[:, corner])
            vertices.append(at)
    at, before, after = np.concatenate(found, axis=1)
    return Corners(at, before, after, np.vstack(vertices))


def _cross(one: Points, two: Points) -> Points:
    return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
