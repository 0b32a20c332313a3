"""The whole site as a robot drives on it: open ground around bodies of rows, aisles in them, and mouths between."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.ops import unary_union

from fieldhand.site.driving.aisles import Aisle, aisles_of
from fieldhand.site.driving.bodies import Body, bodies_of
from fieldhand.site.driving.free import free_ground, with_edge
from fieldhand.site.driving.graph import Graph, Links, Points, Rows, between, chain
from fieldhand.site.driving.ground import XY, Access, Ground
from fieldhand.site.driving.mouths import doors_of, mouths_of, turns_of
from fieldhand.site.model import Site

#: Spots whose ways to all nodes are kept.
_REMEMBERED = 64


@dataclass(frozen=True, eq=False)
class Spot:
    """A point of the site, with how the ways of the site are reached from it.

    Attributes:
        xy: Metres east and north.
        aisle: In which it lies, with ``uv`` in the frame of its rows; None on open ground.
        access: To open ground; None in an aisle.
        spur: Metres straight from the spot to ``access.at``: beside an outer row the outline is reached first.
        links: To the nodes of the site's graph.
    """

    xy: XY
    links: Links
    aisle: Aisle | None = None
    uv: Points | None = None
    access: Access | None = None
    spur: float = 0.0


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
        outlines = [b.polygon for b in self.bodies]
        self.outlines = shapely.STRtree(outlines)
        self.open = bool(self.free.bounded or self.bodies)
        taken = unary_union(outlines)
        self.soft = self.free.soft.difference(taken) if outlines else self.free.soft
        self.soft_and_edge = with_edge(self.soft)
        hard = self.free.hard.difference(taken) if outlines else self.free.hard
        self.mouths = mouths_of(self.aisles, self.soft_and_edge)
        self.turns = turns_of(self.bodies, self.aisles, self.free, max(standoff_m, clearance_m))
        self.ground = Ground(hard, self.soft, clearance_m, doors_of(self.mouths))
        self.graph = self._joined()
        self._spots: dict[XY, Spot] = {}
        self._remembered: dict[XY, Rows] = {}

    # --- where a point is -------------------------------------------------------------------------------------

    def spot(self, xy: XY) -> Spot:
        """Where this point lies and what it reaches, remembered."""
        if xy not in self._spots:
            self._spots[xy] = self._locate(xy)
        return self._spots[xy]

    def _locate(self, xy: XY) -> Spot:
        for number in sorted(self.outlines.query(shapely.Point(xy), predicate="intersects").tolist()):
            body = self.bodies[number]
            uv = body.frame.local(np.array([xy]))[0]
            k = _lines_below(body, uv)
            if 0 < k < len(body.lines):
                return self._in_aisle(xy, self.aisle_of(number, k - 1), uv)
            return self._beside(xy, body, uv, low=k == 0)
        access = self.ground.access(xy)
        return Spot(xy, access.links, access=access)

    def aisle_of(self, body: int, below: int) -> Aisle:
        return self.aisles[self._first_aisle[body] + below]

    @cached_property
    def _first_aisle(self) -> list[int]:
        """Position of each body's first aisle."""
        counts = [len(b.lines) - 1 for b in self.bodies]
        return [0, *np.cumsum(counts).tolist()]

    def _in_aisle(self, xy: XY, aisle: Aisle, uv: Points) -> Spot:
        if aisle.course == "closed" or not self._spur_is_free(aisle, uv):
            return Spot(xy, Links.none())
        nodes, metres = [], []
        for node, at in self._nodes_in[aisle.number].items():
            length = aisle.metres(uv, at)
            if math.isfinite(length):
                nodes.append(node)
                metres.append(length)
        return Spot(xy, Links(np.array(nodes, dtype=np.intp), np.array(metres)), aisle=aisle, uv=uv)

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

    def _spur_is_free(self, aisle: Aisle, uv: Points) -> bool:
        """Whether a spot near a row is not parted by a keep-out from where the robot is clear of the row."""
        if not self.free.bounded or aisle.course == "obstructed":
            return True
        line = shapely.linestrings(aisle.body.frame.world(aisle.way(uv, uv)))  # type: ignore[arg-type]
        return bool(self.free.covers(line, soft=False)[0])

    def _beside(self, xy: XY, body: Body, uv: Points, *, low: bool) -> Spot:
        """Between an outer row and the outline: straight out of the body first."""
        u = float(uv[0])
        foot = np.array([[u, float(np.interp(u, *(body.low_side if low else body.high_side)))]])
        x, y = body.frame.world(foot)[0].tolist()
        spur = float(abs(foot[0, 1] - uv[1]))
        if not self.free.covers(shapely.linestrings([xy, (x, y)]), soft=False)[0]:
            return Spot(xy, Links.none())
        access = self.ground.access((x, y))
        return Spot(xy, Links(access.links.nodes, access.links.metres + spur), access=access, spur=spur)

    # --- ways -------------------------------------------------------------------------------------------------

    def way(self, a: Spot, b: Spot) -> tuple[XY, ...] | None:
        """The points of the shortest way from a spot to another; None if there is none."""
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

    def lengths(self, spots: Sequence[Spot]) -> Points:
        """Metres of the shortest way between every two spots, shape (n, n); inf where there is none."""
        links = [s.links for s in spots]
        best = between(self.graph.rows(links).metres, links)
        best = np.minimum(best, best.T)
        open_ = [k for k, s in enumerate(spots) if s.access is not None]
        if open_:
            spur = np.array([spots[k].spur for k in open_])
            both = np.ix_(open_, open_)
            spurs = spur[:, None] + spur[None, :]
            accesses = [spots[k].access for k in open_]
            best[both] = self.ground.direct_lengths([a for a in accesses if a is not None], best[both] - spurs) + spurs
        for aisle, inside in self._by_aisle(spots).items():
            both = np.ix_(inside, inside)
            uv = np.array([spots[k].uv for k in inside])
            best[both] = np.minimum(best[both], self.aisles[aisle].lengths(uv))
        np.fill_diagonal(best, 0.0)
        return best

    def is_free(self, xy: XY) -> bool:
        """Whether the point is inside the boundary and outside every keep-out."""
        return not self.free.bounded or bool(self.free.holds(np.array([xy]), soft=False)[0])

    def is_clear(self, xy: Points) -> NDArray[np.bool_]:
        """Which of the points, shape (n, 2), are clear of keep-outs and the boundary by the robot's clearance."""
        return self.free.holds(xy, soft=True) if self.free.bounded else np.ones(len(xy), dtype=bool)

    def in_the_way(self, xy: XY) -> str:
        """What keeps a robot from standing at a point, in words; empty if nothing does."""
        return self.free.in_the_way(shapely.Point(xy)) if self.free.bounded else ""

    def reaches(self, spot: Spot) -> bool:
        """Whether anything at all can be driven to from a spot."""
        return not self.open or bool(self.parts(spot))

    def parts(self, spot: Spot) -> frozenset[int]:
        """To which parts of the site ways lead from a spot, as numbers: two spots that share none are cut off."""
        found = {int(self.graph.parts[n]) for n in spot.links.nodes}
        if not found and spot.access is not None:
            exits = spot.access.exits[np.isfinite(spot.access.walked)]
            areas = getattr(self.soft, "geoms", [self.soft])
            near = [k for k, area in enumerate(areas) if shapely.distance(area, shapely.points(exits)).min() < 1e-6]
            found = {-1 - k for k in near}
        return frozenset(found)

    def _by_aisle(self, spots: Sequence[Spot]) -> dict[int, list[int]]:
        found: dict[int, list[int]] = {}
        for k, spot in enumerate(spots):
            if spot.aisle is not None:
                found.setdefault(spot.aisle.number, []).append(k)
        return found

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


def _lines_below(body: Body, uv: Points) -> int:
    """How many of a body's lines a spot is above."""
    first, last = 0, len(body.lines)
    u, v = float(uv[0]), float(uv[1])
    while first < last:
        k = (first + last) // 2
        line = body.lines[k]
        if v >= float(np.interp(u, line.u, (line.low + line.high) / 2.0)):
            first = k + 1
        else:
            last = k
    return first


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
