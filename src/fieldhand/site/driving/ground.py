"""Open ground, and the shortest ways over it.

The shortest way in the plane turns only at corners of what is in the way, so it is found in the graph of corners that
see each other (a visibility graph: Lozano-Pérez and Wesley 1979). Doors are further points on the ground's edge at
which other ways begin: the mouths of aisles.

There are two grounds. *Hard* ground is inside the boundary and outside every keep-out; nothing ever leaves it. *Soft*
ground is hard ground without the band of the clearance along its edges; ways keep to it. A place that stands in the
band (a tree beside the pond) is reached over hard ground within a few clearances of it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra
from shapely.geometry import Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from fieldhand.site.driving.access import Access, exits_of
from fieldhand.site.driving.chords import Chords
from fieldhand.site.driving.corners import corners_of
from fieldhand.site.driving.free import Area
from fieldhand.site.driving.graph import Graph, Indices, Links, Points, between, chain

XY = tuple[float, float]

#: Over hard ground a place is left within this many clearances (beyond its own distance to soft ground).
_LEAVE_WITHIN = 3.0
_WIDER = (1.0, 2.0, 4.0, 8.0)
_MOST_EXITS = 40

#: Pairs of places and nodes that are looked at together: bounds the memory.
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
        self._soft_ground = soft
        self._turns = corners_of(soft)
        self._doors = doors or Doors.none()
        self.nodes = np.vstack([self._turns.at, self._doors.at])
        self.first_door = len(self._turns.at)
        self._exits = np.vstack([self._turns.vertices, corners_of(hard).at])
        self._hard, self.soft = Area(hard), Area(soft)
        self._chords = Chords(hard)
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

    def lengths(self, rows: Points, columns: Points | None = None) -> Points:
        """Metres of the shortest way from each of these places to each of those (the same if none are given), shape
        (n, m); inf where there is none."""
        one = self.accesses(_tuples(rows))
        two = None if columns is None else self.accesses(_tuples(columns))
        best = self.graph.lengths([a.links for a in one], None if two is None else [a.links for a in two])
        self.shorten(best, one, two)
        if columns is None:
            np.fill_diagonal(best, 0.0)
        return best

    def shorten(self, best: Points, rows: Sequence[Access], columns: Sequence[Access] | None = None) -> None:
        """Put straight ways into a table of lengths, shape (n, m), where they are shorter.

        Args:
            best: Symmetric where no columns are given, and left so.
            rows, columns: The places of the table's rows and columns; no columns: those of the rows.
        """
        one = exits_of(rows)
        two = one if columns is None else exits_of(columns)
        for i, j in self._chords.pairs(one.at, None if columns is None else two.at):
            row, column = one.owner[i], two.owner[j]
            length = one.walked[i] + two.walked[j] + np.hypot(*(one.at[i] - two.at[j]).T)
            tried = length < best[row, column]
            if columns is None:
                tried &= row != column
            i, j, row, column, length = i[tried], j[tried], row[tried], column[tried], length[tried]
            clear = self._clear(one.at[i], two.at[j], one.disks(i), two.disks(j))
            row, column, length = row[clear], column[clear], length[clear]
            np.minimum.at(best, (row, column), length)
            if columns is None:
                np.minimum.at(best, (column, row), length)

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
        return self.accesses([xy])[0]

    def accesses(self, places: Sequence[XY]) -> list[Access]:
        """How each of these places reaches the ground's nodes, remembered."""
        new = [xy for xy in dict.fromkeys(places) if xy not in self._accesses]
        if new:
            at = np.array(new)
            on_soft = self.soft.holds(at)
            self._accesses.update(zip((new[k] for k in np.flatnonzero(on_soft)), self._see(at[on_soft]), strict=True))
            for k in np.flatnonzero(~on_soft).tolist():
                self._accesses[new[k]] = self._leave(at[k])
        return [self._accesses[xy] for xy in places]

    def foot(self, xy: XY) -> tuple[XY, float] | None:
        """The nearest point of soft ground by which a place is left, and the metres to there; None if it never is."""
        access = self.access(xy)
        soft = np.flatnonzero(np.isfinite(access.walked) & self.soft.holds(access.exits))
        if not len(soft):
            return None
        nearest = int(soft[np.argmin(access.walked[soft])])
        x, y = access.exits[nearest].tolist()
        return (x, y), float(access.walked[nearest])

    def _see(self, at: Points) -> Iterator[Access]:
        """Places on soft ground: the nodes that each sees."""
        here = np.zeros(1), np.full(1, -1, dtype=np.intp)
        batch = max(_BATCH // max(len(self.nodes), 1), 1)
        for first in range(0, len(at), batch):
            some = at[first : first + batch]
            found = [(np.zeros(0, dtype=np.intp),) * 2, *self._chords.pairs(some, self.nodes)]
            place, node = (np.concatenate(part) for part in zip(*found, strict=True))
            can = self._leaves(node, some[place] - self.nodes[node])
            place, node = place[can], node[can]
            seen = self.soft.sees(some[place], self.nodes[node])
            place, node = place[seen], node[seen]
            metres = np.hypot(*(some[place] - self.nodes[node]).T)
            ends = np.searchsorted(place, np.arange(len(some) + 1))
            for k, (one, two) in enumerate(itertools.pairwise(ends.tolist())):
                links = Links(node[one:two].copy(), metres[one:two].copy())
                yield Access(some[k], 0.0, some[k : k + 1], *here, links, np.zeros(two - one, dtype=np.intp))

    def _edges(self) -> tuple[Indices, Indices, Points]:
        """The pairs of nodes that see each other, and the metres between them.

        Doors on one edge see each other along it, so that only neighbours are joined there.
        """
        found_one, found_two = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
        for one, two in self._chords.pairs(self.nodes):
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
        nearest = []
        if not self._soft_ground.is_empty:
            nearest = [np.array(nearest_points(self._soft_ground, Point(at))[0].coords[0])]
        distance = float(np.hypot(*(nearest[0] - at))) if nearest else 0.0
        for wider in _WIDER:
            radius = wider * (distance + _LEAVE_WITHIN * self._clearance_m)
            exits = np.vstack([*nearest, self._exits])
            away = np.hypot(*(exits - at).T)
            order = np.argsort(away, kind="stable")[:_MOST_EXITS]
            access = self._reach(at, radius, np.vstack([at, exits[order][away[order] <= radius]]))
            got = access.exits[np.isfinite(access.walked)]
            if self.soft.holds(got).any():
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
        clear = self.soft.sees(one, two)
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
            middle = a + t[:, None] * (b - a), a + u[:, None] * (b - a)
            clear[maybe] = self._hard.sees(a, b) & (all_disk | self.soft.sees(*middle))
        return clear


def _tuples(at: Points) -> list[XY]:
    return [(x, y) for x, y in at.tolist()]


def _inside_until(one: Points, two: Points, centre: Points, radius: Points) -> Points:
    """The part of each line, from its beginning, that lies in a disk around its beginning: 0 to 1."""
    d, f = two - one, one - centre
    a = np.maximum((d * d).sum(axis=1), 1e-18)
    b = (d * f).sum(axis=1)
    c = (f * f).sum(axis=1) - radius**2
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    return np.where((radius > 0.0) & (c <= 1e-9), np.clip((root - b) / a, 0.0, 1.0), 0.0)
