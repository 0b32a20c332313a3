"""The whole site as a robot drives on it: open ground around bodies of rows, aisles in them, and mouths between."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.ops import unary_union

from fieldhand.site.driving.access import Access
from fieldhand.site.driving.aisles import Aisle, aisles_of
from fieldhand.site.driving.bodies import bodies_of
from fieldhand.site.driving.free import Area, free_ground
from fieldhand.site.driving.graph import Graph, Indices, Points, Rows, between, chain
from fieldhand.site.driving.ground import XY, Ground
from fieldhand.site.driving.mouths import doors_of, mouths_of, turns_of
from fieldhand.site.driving.spots import Spot, Spots
from fieldhand.site.model import Site

#: Spots whose ways to all nodes are kept.
_REMEMBERED = 64

#: A way this part longer than the straight line is the straight line.
_ROUNDING = 1e-12


class Layout:
    """Open ground, aisles and the graph that joins them.

    Args:
        site: With rows, zones and gates.
        clearance_m: That the robot keeps from tree lines, keep-outs and the boundary.
        standoff_m: From a tree to where the robot stands; it turns as far beyond the last trees where there is room.
    """

    def __init__(self, site: Site, clearance_m: float, standoff_m: float) -> None:
        self.free = free_ground(site, clearance_m)
        self.bodies = bodies_of(site, self.free, standoff_m)
        self.aisles = aisles_of(self.bodies, self.free)
        self.open = bool(self.free.bounded or self.bodies)
        taken = unary_union([b.polygon for b in self.bodies])
        self.soft = self.free.soft.difference(taken) if self.bodies else self.free.soft
        hard = self.free.hard.difference(taken) if self.bodies else self.free.hard
        open_ground = Area(self.soft)
        self.mouths = mouths_of(self.aisles, open_ground)
        self.turns = turns_of(self.bodies, self.aisles, self.free, max(standoff_m, clearance_m))
        self.ground = Ground(hard, self.soft, clearance_m, doors_of(self.mouths))
        self.spots = Spots(self.free, self.bodies, self.aisles, self._nodes_in, self.ground)
        self.graph = self._joined()
        self._parts: dict[XY, frozenset[int]] = {}
        self._remembered: dict[XY, Rows] = {}

    # --- where a point is -------------------------------------------------------------------------------------

    def spot(self, xy: XY) -> Spot:
        """Where this point lies and what it reaches, remembered."""
        return self.spots.at([xy])[0]

    @cached_property
    def _nodes_in(self) -> list[dict[int, Points]]:
        """For each aisle its nodes of the graph, mouths and turns, with their (u, v)."""
        found: list[dict[int, Points]] = [{} for _ in self.aisles]
        for k, mouth in enumerate(self.mouths):
            found[mouth.aisle][self.ground.first_door + k] = mouth.uv
        for k, turn in enumerate(self.turns):
            for aisle in turn.aisles:
                found[aisle][len(self.ground.nodes) + k] = turn.uv
        return found

    @cached_property
    def _aisles_at(self) -> dict[int, tuple[int, ...]]:
        """For each node that is a mouth or a turn the aisles it belongs to."""
        found: dict[int, tuple[int, ...]] = {}
        for aisle, nodes in enumerate(self._nodes_in):
            for node in nodes:
                found[node] = (*found.get(node, ()), aisle)
        return found

    @cached_property
    def junctions(self) -> Points:
        """Metres east and north of the graph's nodes, shape (n, 2): corners, mouths, turns."""
        return np.vstack([self.ground.nodes, np.array([t.at for t in self.turns]).reshape(-1, 2)])

    def is_one_view(self, at: Points) -> bool:
        """Whether every way between these points of open ground is a straight line: nothing is there to turn at."""
        return not self.open or bool(not self.graph.count and any(area.holds(at).all() for area in self._areas))

    # --- ways -------------------------------------------------------------------------------------------------

    def way(self, a: Spot, b: Spot) -> tuple[XY, ...] | None:
        """The points of the shortest way from a spot to another; None if there is none."""
        if a.aisle is not None and a.aisle is b.aisle:
            direct, points = self._direct(a, b, math.inf)
            if direct <= math.dist(a.xy, b.xy) * (1.0 + _ROUNDING):  # nothing is shorter than straight
                return _points(a, b, [points])
        rows = self._rows(a)
        around = float(between(rows.metres, [b.links])[0, 0])
        direct, points = self._direct(a, b, around)
        if math.isinf(min(around, direct)):
            return None
        if direct <= around:
            return _points(a, b, [points])
        last = int(b.links.nodes[np.argmin(rows.metres[0, b.links.nodes] + b.links.metres)])
        nodes = chain(rows, 0, last)
        middle = [self._between_nodes(one, two) for one, two in itertools.pairwise(nodes)]
        return _points(a, b, [self._to_node(a, nodes[0]), *middle, self._to_node(b, last)[::-1]])

    def _rows(self, spot: Spot) -> Rows:
        """Ways from a spot to every node; those of the last few spots are remembered."""
        if spot.xy not in self._remembered:
            if len(self._remembered) >= _REMEMBERED:
                self._remembered.pop(next(iter(self._remembered)))
            self._remembered[spot.xy] = self.graph.rows([spot.links])
        return self._remembered[spot.xy]

    def lengths(self, rows: Sequence[Spot], columns: Sequence[Spot] | None = None) -> Points:
        """Metres of the shortest way from each of these spots to each of those (the same if none are given), shape
        (n, m); inf where there is none."""
        others = rows if columns is None else columns
        self.ground.accesses([s.foot for s in (*rows, *others) if s.foot is not None])
        best = self.graph.lengths([s.links for s in rows], None if columns is None else [s.links for s in columns])
        one, two = ([k for k, s in enumerate(spots) if s.foot is not None] for spots in (rows, others))
        if one and two:
            spurs = np.array([rows[k].spur for k in one])[:, None] + np.array([others[k].spur for k in two])
            straight = best[np.ix_(one, two)] - spurs
            accesses = _accesses(others, two)
            self.ground.shorten(straight, _accesses(rows, one), None if columns is None else accesses)
            best[np.ix_(one, two)] = straight + spurs
        places = by_aisle(others)
        for number, inside in by_aisle(rows).items():
            if number in places:
                both = np.ix_(inside, places[number])
                uv = np.array([rows[k].uv for k in inside])
                to = None if columns is None else np.array([others[k].uv for k in places[number]])
                best[both] = np.minimum(best[both], self.aisles[number].lengths(uv, to))
        if columns is None:
            np.fill_diagonal(best, 0.0)
        else:
            there = {s.xy: k for k, s in enumerate(columns)}
            same = [(k, there[s.xy]) for k, s in enumerate(rows) if s.xy in there]
            best[[k for k, _ in same], [k for _, k in same]] = 0.0
        return best

    def are_free(self, xy: Points) -> NDArray[np.bool_]:
        """Which of the points, shape (n, 2), are inside the boundary and outside every keep-out."""
        return self.free.holds(xy, soft=False) if self.free.bounded else np.ones(len(xy), dtype=bool)

    def is_clear(self, xy: Points) -> NDArray[np.bool_]:
        """Which of the points, shape (n, 2), are clear of keep-outs and the boundary by the robot's clearance."""
        return self.free.holds(xy, soft=True) if self.free.bounded else np.ones(len(xy), dtype=bool)

    def in_the_way(self, xy: XY) -> str:
        """What keeps a robot from standing at a point, in words; empty if nothing does."""
        return self.free.in_the_way(shapely.Point(xy)) if self.free.bounded else ""

    # --- parts ------------------------------------------------------------------------------------------------

    def reach(self, spots: Sequence[Spot]) -> list[bool]:
        """From which of these spots anything at all can be driven to."""
        return [not self.open or bool(parts) for parts in self.parts(spots)]

    def linked(self, spots: Sequence[Spot], origin: Spot) -> list[bool]:
        """Which of these spots can be driven to from there."""
        here = self.parts([origin])[0]
        return [
            not self.open or not here.isdisjoint(parts) or math.isfinite(self._direct(spot, origin, math.inf)[0])
            for spot, parts in zip(spots, self.parts(spots), strict=True)
        ]

    def parts(self, spots: Sequence[Spot]) -> list[frozenset[int]]:
        """To which parts of the site ways lead from each spot, as numbers: two spots that share none are cut off."""
        new = list({s.xy: s for s in spots if s.xy not in self._parts}.values())
        if new:
            _, of_areas = self._numbered_parts
            feet = np.array([s.xy if s.foot is None else s.foot for s in new])
            inside = np.array([area.holds(feet) for area in self._areas]).reshape(-1, len(new))
            for k, spot in enumerate(new):
                found = of_areas[inside[:, k]].tolist() if spot.foot is not None else []
                self._parts[spot.xy] = frozenset(found or self._parts_off(spot))
        return [self._parts[s.xy] for s in spots]

    def _parts_off(self, spot: Spot) -> list[int]:
        """The parts that a spot reaches from where it is not on soft ground."""
        of_nodes, of_areas = self._numbered_parts
        found: list[int] = of_nodes[spot.links.nodes].tolist()
        if spot.access is not None:
            exits = spot.access.exits[np.isfinite(spot.access.walked)]
            found += of_areas[[area.holds(exits).any() for area in self._areas]].tolist()
        return found

    @cached_property
    def _areas(self) -> list[Area]:
        """The areas of soft ground: all of one of them is linked."""
        return [Area(shape) for shape in getattr(self.soft, "geoms", [self.soft])]

    @cached_property
    def _numbered_parts(self) -> tuple[Indices, Indices]:
        """For each node of the graph, and for each area of soft ground, the number of the part of the site it is in."""
        n = self.graph.count
        area, node = np.nonzero([a.holds(self.ground.nodes) for a in self._areas])
        parts = self.graph.parts(node, n + area, len(self._areas))
        return parts[:n], parts[n:]

    def _direct(self, a: Spot, b: Spot, below: float) -> tuple[float, Points]:
        """The shortest way by no node of the graph; inf if there is none below that many metres."""
        if a.aisle is not None and a.aisle is b.aisle and a.uv is not None and b.uv is not None:
            points = a.aisle.way(a.uv, b.uv)
            if points is not None:
                return a.aisle.metres(a.uv, b.uv), a.aisle.body.frame.world(points)
        if a.access is not None and b.access is not None:
            length, straight = self.ground.direct(a.access, b.access, below - a.spur - b.spur)
            return length + a.spur + b.spur, np.array(straight).reshape(-1, 2)
        return math.inf, np.empty((0, 2))

    def _to_node(self, spot: Spot, node: int) -> Points:
        if spot.access is not None:
            points = spot.access.points_to_node(node)
            return np.array([np.array(spot.xy), *points, self.ground.nodes[node]])
        if spot.aisle is None or spot.uv is None:
            return np.array([spot.xy])
        return self._in_one_aisle(spot.aisle, spot.uv, self._nodes_in[spot.aisle.number][node])

    def _between_nodes(self, one: int, two: int) -> Points:
        """The points from a node to the next: within an aisle, or straight over open ground."""
        shared = [a for a in self._aisles_at.get(one, ()) if a in self._aisles_at.get(two, ())]
        if not shared:
            return self.ground.nodes[[one, two]]
        ends = [(self._nodes_in[a][one], self._nodes_in[a][two]) for a in shared]
        best = int(np.argmin([self.aisles[a].metres(*pair) for a, pair in zip(shared, ends, strict=True)]))
        return self._in_one_aisle(self.aisles[shared[best]], *ends[best])

    @staticmethod
    def _in_one_aisle(aisle: Aisle, one: Points, two: Points) -> Points:
        points = aisle.way(one, two)
        return aisle.body.frame.world(np.array([one, two]) if points is None else points)

    # --- making it --------------------------------------------------------------------------------------------

    def _joined(self) -> Graph:
        """The graph of the open ground with the aisles that lead through."""
        one, two, metres = [], [], []
        for aisle, nodes in zip(self.aisles, self._nodes_in, strict=True):
            for (i, a), (j, b) in itertools.combinations(nodes.items(), 2):
                length = aisle.metres(a, b)
                if math.isfinite(length):
                    one.append(i)
                    two.append(j)
                    metres.append(length)
        ground = self.ground
        return Graph(
            len(ground.nodes) + len(self.turns),
            np.concatenate([ground.one, np.array(one, dtype=np.intp)]),
            np.concatenate([ground.two, np.array(two, dtype=np.intp)]),
            np.concatenate([ground.metres, np.array(metres)]),
        )


def by_aisle(spots: Sequence[Spot]) -> dict[int, list[int]]:
    """The positions of the spots in each aisle, by its number."""
    found: dict[int, list[int]] = {}
    for k, spot in enumerate(spots):
        if spot.aisle is not None:
            found.setdefault(spot.aisle.number, []).append(k)
    return found


def _accesses(spots: Sequence[Spot], which: Sequence[int]) -> list[Access]:
    return [access for k in which if (access := spots[k].access) is not None]


def _points(a: Spot, b: Spot, parts: Sequence[Points]) -> tuple[XY, ...]:
    """From spot to spot as numbers, without repeated points and points on a straight line between others."""
    way: list[XY] = [a.xy]
    for x, y in [*np.vstack(parts).tolist(), b.xy]:
        if len(way) > 0 and math.hypot(x - way[-1][0], y - way[-1][1]) < 1e-9:
            continue
        while len(way) > 1 and _straight(way[-2], way[-1], (x, y)):
            way.pop()
        way.append((x, y))
    return (*way[:-1], b.xy) if len(way) > 1 else (a.xy, b.xy)


def _straight(a: XY, b: XY, c: XY) -> bool:
    """Whether b lies on the line from a to c."""
    ux, uy, vx, vy = b[0] - a[0], b[1] - a[1], c[0] - b[0], c[1] - b[1]
    return abs(ux * vy - uy * vx) < 1e-9 * math.hypot(ux, uy) * math.hypot(vx, vy) and ux * vx + uy * vy > 0.0
