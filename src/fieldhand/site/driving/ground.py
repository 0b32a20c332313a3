"""Open ground, and the shortest ways over it.

The shortest way in the plane turns only at corners of what is in the way, so it is found in the graph of corners that
see each other (a visibility graph: Lozano-Pérez and Wesley 1979). Doors are further points on the ground's edge at
which other ways begin: the mouths of aisles.

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

from fieldhand.site.driving.free import with_edge
from fieldhand.site.driving.graph import Graph, Indices, Links, Points, between, chain

XY = tuple[float, float]

#: Over hard ground a place is left within this many clearances (beyond its own distance to soft ground).
_LEAVE_WITHIN = 3.0
_WIDER = (1.0, 2.0, 4.0, 8.0)
_MOST_EXITS = 40

#: Pairs of nodes that are looked at together: bounds the memory.
_BATCH = 200_000


@dataclass(frozen=True, eq=False)
class Doors:
    """Points on the edge of the ground from which ways lead off it.

    Attributes:
        at: Shape (n, 2).
        outward: Unit vectors from the edge onto the ground, shape (n, 2).
        edge: Doors with the same number are on one straight edge, and stand in its order.
    """

    at: Points
    outward: Points
    edge: Indices

    @staticmethod
    def none() -> Doors:
        """No doors."""
        return Doors(np.empty((0, 2)), np.empty((0, 2)), np.zeros(0, dtype=np.intp))


@dataclass(frozen=True, eq=False)
class Access:
    """How one place reaches soft ground.

    Attributes:
        at: The place.
        radius: Within this of the place a way may use hard ground; 0 for a place on soft ground.
        exits: The place itself, then the points by which it can be left, shape (m, 2).
        walked: Metres from the place to each exit (inf: not reached), and by which exit.
        links: The nodes of the ground that it reaches, and by which exit.
    """

    at: Points
    radius: float
    exits: Points
    walked: Points
    walked_by: Indices
    links: Links
    links_by: Indices

    def points_to(self, exit_: int) -> list[Points]:
        """The points from the place to one of its exits."""
        points = [self.exits[exit_]]
        while exit_ > 0:
            exit_ = int(self.walked_by[exit_])
            points.append(self.exits[exit_])
        return points[::-1]

    def points_to_node(self, node: int) -> list[Points]:
        """The points from the place to the exit by which it reaches this node of the ground."""
        return self.points_to(int(self.links_by[np.flatnonzero(self.links.nodes == node)[0]]))


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

    def touched(self, which: Indices, towards: Points) -> NDArray[np.bool_]:
        """Whether a line from a corner in this direction only touches the obstacle there: a shortest way has no other
        lines at its turns."""
        before, after = -self.before[which], self.after[which]
        return np.asarray(_cross(towards, before) * _cross(towards, after) >= -1e-9)


class Ground:
    """Hard and soft ground, the corners of the soft ground and its doors, and how they see each other.

    Args:
        hard: Where a robot may be at all.
        soft: Where ways keep their distance from edges.
        clearance_m: That distance.
        doors: Further nodes, on the edge of the soft ground.
    """

    def __init__(self, hard: BaseGeometry, soft: BaseGeometry, clearance_m: float, doors: Doors | None = None) -> None:
        self._clearance_m = clearance_m
        self._soft = soft
        self._turns = _corners(soft)
        self._doors = doors or Doors.none()
        self.nodes = np.vstack([self._turns.at, self._doors.at])
        self.first_door = len(self._turns.at)
        self._exits = np.vstack([self._turns.vertices, _corners(hard).at])
        self._hard_and_edge, self._soft_and_edge = with_edge(hard), with_edge(soft)
        self.one, self.two, self.metres = self._edges()
        self.graph = Graph(len(self.nodes), self.one, self.two, self.metres)
        self._accesses: dict[XY, Access] = {}

    def way(self, one: XY, two: XY) -> list[Points] | None:
        """The points of the shortest way between two places on hard ground; None if there is none."""
        a, b = self.access(one), self.access(two)
        rows = self.graph.rows([a.links])
        around = float(between(rows.metres, [b.links])[0, 0])
        direct, points = self.direct(a, b, around)
        if math.isinf(min(around, direct)):
            return None
        if direct <= around:
            return points
        last = int(b.links.nodes[np.argmin(rows.metres[0, b.links.nodes] + b.links.metres)])
        nodes = chain(rows, 0, last)
        return [*a.points_to_node(nodes[0]), *self.nodes[nodes], *reversed(b.points_to_node(last))]

    def lengths(self, xy: Points) -> Points:
        """Metres of the shortest way between every two of these places, shape (n, n); inf where there is none."""
        accesses = [self.access((x, y)) for x, y in xy.tolist()]
        links = [a.links for a in accesses]
        best = between(self.graph.rows(links).metres, links)
        best = self.direct_lengths(accesses, np.minimum(best, best.T))
        np.fill_diagonal(best, 0.0)
        return best

    def direct_lengths(self, accesses: Sequence[Access], best: Points) -> Points:
        """The known lengths, and straight ways where they are shorter; shape (n, n)."""
        owner = np.repeat(np.arange(len(accesses)), [len(a.exits) for a in accesses])
        exits = np.vstack([a.exits for a in accesses])
        walked = np.concatenate([a.walked for a in accesses])
        centre = np.array([a.at for a in accesses])[owner]
        radius = np.array([a.radius for a in accesses])[owner]
        best = best.copy()
        for one, two in _pairs(len(exits)):
            length = walked[one] + walked[two] + np.hypot(*(exits[one] - exits[two]).T)
            tried = (owner[one] != owner[two]) & (length < best[owner[one], owner[two]])
            one, two, length = one[tried], two[tried], length[tried]
            clear = self._clear(exits[one], exits[two], (centre[one], radius[one]), (centre[two], radius[two]))
            i, j, length = owner[one[clear]], owner[two[clear]], length[clear]
            np.minimum.at(best, (i, j), length)
            np.minimum.at(best, (j, i), length)
        return best

    def direct(self, a: Access, b: Access, below: float) -> tuple[float, list[Points]]:
        """The shortest way that turns at no node, only where the places leave and enter their band; inf if there is
        none below that many metres."""
        i, j = (g.ravel() for g in np.indices((len(a.exits), len(b.exits))))
        length = a.walked[i] + b.walked[j] + np.hypot(*(a.exits[i] - b.exits[j]).T)
        i, j, length = i[length < below], j[length < below], length[length < below]
        m = len(i)
        clear = self._clear(
            a.exits[i],
            b.exits[j],
            (np.tile(a.at, (m, 1)), np.full(m, a.radius)),
            (np.tile(b.at, (m, 1)), np.full(m, b.radius)),
        )
        if not clear.any():
            return math.inf, []
        best = int(np.argmin(np.where(clear, length, np.inf)))
        return float(length[best]), [*a.points_to(int(i[best])), *reversed(b.points_to(int(j[best])))]

    def access(self, xy: XY) -> Access:
        """How this place reaches the ground's nodes, remembered."""
        if xy not in self._accesses:
            at = np.array(xy)
            if shapely.intersects_xy(self._soft_and_edge, at[0], at[1]):
                self._accesses[xy] = self._reach(at, 0.0, at[None, :])
            else:
                self._accesses[xy] = self._leave(at)
        return self._accesses[xy]

    def _edges(self) -> tuple[Indices, Indices, Points]:
        """The pairs of nodes that see each other, and the metres between them.

        Doors on one edge see each other along it, so that only neighbours are joined there.
        """
        found_one, found_two = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
        for one, two in _pairs(len(self.nodes)):
            line = self.nodes[two] - self.nodes[one]
            tried = self._leaves(one, line) & self._leaves(two, -line)
            first = self.first_door
            both = one >= first
            same = np.zeros(len(one), dtype=bool)
            same[both] = self._doors.edge[one[both] - first] == self._doors.edge[two[both] - first]
            tried &= ~same | (two == one + 1)
            one, two = one[tried], two[tried]
            clear = self._clear(self.nodes[one], self.nodes[two])
            found_one.append(one[clear])
            found_two.append(two[clear])
        one, two = np.concatenate(found_one), np.concatenate(found_two)
        return one, two, np.hypot(*(self.nodes[one] - self.nodes[two]).T)

    def _leaves(self, which: Indices, towards: Points) -> NDArray[np.bool_]:
        """Whether a way can have this direction at a node: it touches a corner, and from a door it leads outward."""
        can = np.ones(len(which), dtype=bool)
        corner = which < self.first_door
        can[corner] = self._turns.touched(which[corner], towards[corner])
        door = which[~corner] - self.first_door
        away = (self._doors.outward[door] * towards[~corner]).sum(axis=1)
        can[~corner] = away >= -1e-6 * np.maximum(np.hypot(*towards[~corner].T), 1.0)
        return can

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
            got = access.exits[np.isfinite(access.walked)]
            if shapely.intersects_xy(self._soft_and_edge, got[:, 0], got[:, 1]).any():
                break
        return access

    def _reach(self, at: Points, radius: float, exits: Points) -> Access:
        """Metres from a place over its exits, and on to every node."""
        m, n = len(exits), len(self.nodes)
        walked, by = np.zeros(1), np.full(1, -1, dtype=np.intp)
        disk = (np.tile(at, (m * max(m, n), 1)), np.full(m * max(m, n), radius))
        if m > 1:
            i, j = (g.ravel() for g in np.indices((m, m)))
            clear = self._clear(
                exits[i], exits[j], (disk[0][: m * m], disk[1][: m * m]), (disk[0][: m * m], disk[1][: m * m])
            )
            graph = np.where(clear, np.hypot(*(exits[i] - exits[j]).T), 0.0).reshape(m, m)
            found = dijkstra(np.asarray(graph), directed=False, indices=[0], return_predecessors=True)
            walked, by = np.asarray(found[0][0]), np.asarray(found[1][0], dtype=np.intp)
        i, k = (g.ravel() for g in np.indices((m, n)))
        clear = self._leaves(k, exits[i] - self.nodes[k])
        if radius == 0.0:
            clear[clear] = self._clear(exits[i[clear]], self.nodes[k[clear]])
        else:
            # Hard ground may bend around a corner of the soft ground, so no direction is left out here.
            clear = self._clear(exits[i], self.nodes[k], (disk[0][: m * n], disk[1][: m * n]))
        length = np.where(clear, walked[i] + np.hypot(*(exits[i] - self.nodes[k]).T), np.inf).reshape(m, n)
        nearest, nearest_by = length.min(axis=0), length.argmin(axis=0)
        reached = np.flatnonzero(np.isfinite(nearest))
        return Access(at, radius, exits, walked, by, Links(reached, nearest[reached]), nearest_by[reached])

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


def _pairs(n: int) -> list[tuple[Indices, Indices]]:
    """All pairs of so many things, in batches."""
    one, two = np.triu_indices(n, k=1)
    return [(one[k : k + _BATCH], two[k : k + _BATCH]) for k in range(0, len(one), _BATCH)]


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
