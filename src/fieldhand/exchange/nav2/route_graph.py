"""The drives of a site as a graph for Nav2's route server, in its GeoJSON format.

The nodes are the places where the robot stands and the corners where its ways turn, so the shortest routes of the route
server are the drives of a mission. Nav2 drives every edge in a straight line from node to node: it reads neither the
geometry of an edge nor its length.

Format: ``nav2_route/src/plugins/graph_file_loaders/geojson_graph_file_loader.cpp``. Numbers of the metadata that the
plugins read as ``float`` need a decimal point, since the loader keeps the type. ``DistanceScorer`` divides by the key
``speed_limit`` (percent, 1 where it is missing), so either every edge has it or none.
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from fieldhand.errors import InputError
from fieldhand.exchange.nav2.frame import MapFrame
from fieldhand.exchange.nav2.ground import lone_trees
from fieldhand.forecast.slow_ground import SlowGround
from fieldhand.language import message
from fieldhand.language.words import say_number
from fieldhand.site.drives import XY, Drives
from fieldhand.site.driving.network import aisle_name
from fieldhand.site.driving.roadmap import roadmap_of
from fieldhand.site.model import Place
from fieldhand.site.point_index import PointIndex
from fieldhand.site.rows.labels import linked

Points = NDArray[np.float64]
Ways = NDArray[np.int64]

#: Largest number of nodes and edges of a graph: messages of Nav2 have their ids as ``uint16``.
MOST_FEATURES = 65_536

#: Nodes closer than this, in metres, are one.
_SAME_M = 1e-3

#: Number of nearest places to which a marker or a gate is joined if it sees them.
_SEEN = 100

#: An edge is left out if two others replace it that are at most this fraction longer.
_LONGER = 5e-3


@dataclass(frozen=True, kw_only=True)
class RouteNode:
    """A node of the graph, in metres of the site.

    Attributes:
        places: Names of the trees, markers and gates at which a robot stands there; empty for a corner.
    """

    xy: XY
    places: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class RouteEdge:
    """A straight way between two nodes, driven in both directions.

    Attributes:
        one, two: Indices of its nodes.
        speed_m_s: Speed limit.
        aisle: Name of the aisle in which it lies; empty on open ground.
    """

    one: int
    two: int
    speed_m_s: float
    aisle: str = ""


@dataclass(frozen=True, kw_only=True)
class RouteGraph:
    """The drives of a robot on a site as a graph of straight ways."""

    nodes: tuple[RouteNode, ...]
    edges: tuple[RouteEdge, ...]


def route_graph(drives: Drives, slow: SlowGround, speed_m_s: float, *, at_trees: bool = True) -> RouteGraph:
    """Return the graph of the drives on a site.

    Args:
        drives: Drives of the robot on the site.
        slow: Slow ground of the mission.
        speed_m_s: Speed of the robot elsewhere.
        at_trees: Include the places from which the robot works on trees.

    Raises:
        InputError: The site has too many places, or fewer than two that a robot can reach.
    """
    at, ways = _merged(*_ways(drives, tuple(_places(drives, at_trees=at_trees))))
    ways = _clear_of_lone_trees(drives, at, ways)
    at, ways = _connected(drives, at, _without_replaceable(at, ways))
    used = np.unique(ways)
    at, ways = at[used], np.searchsorted(used, ways)
    if not len(ways):
        raise InputError(
            message("the site has fewer than two places that the robot can reach: there is no route"),
            advice=message("add a start and an end to the site"),
        )
    if len(at) + 2 * len(ways) > MOST_FEATURES:
        raise InputError(
            message(
                "a route graph of {features} nodes and edges is too large: at most {most}",
                features=say_number(len(at) + 2 * len(ways)),
                most=say_number(MOST_FEATURES),
            ),
            where="--corners-only",
            advice=message("give it, for a graph without a node beside each tree"),
        )
    names = _names(drives, at, at_trees=at_trees)
    nodes = [RouteNode(xy=(x, y), places=names.get(k, ())) for k, (x, y) in enumerate(at.tolist())]
    edges = [RouteEdge(one=a, two=b, speed_m_s=speed_m_s) for a, b in ways.tolist()]
    return _in_aisles(drives, _slowed(RouteGraph(nodes=tuple(nodes), edges=tuple(edges)), slow))


def write_route_graph(graph: RouteGraph, frame: MapFrame, *, name: str, speed_m_s: float) -> bytes:
    """Return the graph as GeoJSON of Nav2's route server, with an edge for each direction.

    Args:
        graph: The graph.
        frame: The map frame.
        name: Name of the site.
        speed_m_s: Speed of the robot, of which ``speed_limit`` is a percentage.
    """
    at = [[round(x, 3), round(y, 3)] for x, y in frame.points(np.array([node.xy for node in graph.nodes])).tolist()]
    ids = itertools.count()
    features: list[dict[str, Any]] = []
    for node, position in zip(graph.nodes, at, strict=True):
        metadata = {"places": list(node.places)} if node.places else {}
        properties = {"id": next(ids), "frame": frame.name} | ({"metadata": metadata} if metadata else {})
        features.append(_feature(properties, {"type": "Point", "coordinates": position}))
    for edge in graph.edges:
        limits: dict[str, Any] = {
            "speed_limit": round(100.0 * min(1.0, edge.speed_m_s / speed_m_s), 1),
            "abs_speed_limit": float(edge.speed_m_s),
        }
        metadata = limits | ({"aisle": edge.aisle} if edge.aisle else {})
        for start, end in ((edge.one, edge.two), (edge.two, edge.one)):
            properties = {"id": next(ids), "startid": start, "endid": end, "metadata": metadata}
            features.append(_feature(properties, {"type": "MultiLineString", "coordinates": [[at[start], at[end]]]}))
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in features)
    return f'{{"type": "FeatureCollection", "name": {json.dumps(name)}, "features": [\n{lines}\n]}}\n'.encode()


def _feature(properties: dict[str, Any], geometry: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def _places(drives: Drives, *, at_trees: bool) -> Iterator[Place]:
    """Yield the places that a robot can reach, each with a stand: trees from either side, markers and gates."""
    site = drives.site
    others = [*site.markers.values(), *(gate.place for gate in site.gates)]
    reached = [place for place, problem in zip(others, drives.problems(others), strict=True) if not problem]
    yield from drives.stands(reached)
    trees = [tree.place for tree in site.trees] if at_trees else []
    for tree, candidates in zip(trees, drives.sides(trees), strict=True):
        usable = [c.xy for c in candidates if not c.why_not]
        clear = drives.layout.is_clear(np.array(usable).reshape(-1, 2)).tolist()
        yield from (replace(tree, stand=xy) for xy, is_clear in zip(usable, clear, strict=True) if is_clear)


def _names(drives: Drives, at: Points, *, at_trees: bool) -> dict[int, tuple[str, ...]]:
    """Return the names of the places at each node, in the order of the site."""
    found: dict[int, dict[str, None]] = {}
    places = list(_places(drives, at_trees=at_trees))
    metres, nearest = PointIndex(at).nearest_few(np.array([p.stand or p.xy for p in places]).reshape(-1, 2), 1)
    for place, (away,), (node,) in zip(places, metres.tolist(), nearest.tolist(), strict=True):
        if away <= _SAME_M:
            found.setdefault(int(node), {})[place.id] = None
    return {node: tuple(names) for node, names in found.items()}


def _ways(drives: Drives, places: tuple[Place, ...]) -> tuple[Points, Ways]:
    """Return the nodes and the straight ways of the road map of places; stands off the ground have no way.

    Markers and gates, from which routes begin, are joined to all places nearby that they see, too.
    """
    if not places:
        return np.empty((0, 2)), np.empty((0, 2), dtype=np.int64)
    roadmap = roadmap_of(drives.layout, places, always_edges=True)
    at = np.array([place.stand or place.xy for place in places])
    marked = np.array([k for k, place in enumerate(places) if place.kind != "tree"], dtype=np.intp)
    near = PointIndex(at).nearest_few(at[marked], _SEEN + 1)[1]
    one, two = np.repeat(marked, near.shape[1]), near.ravel()
    seen = drives.layout.visibility.area.sees(at[one], at[two])
    return roadmap.at, np.vstack([roadmap.ways, np.column_stack([one[seen], two[seen]])])


def _merged(at: Points, ways: Ways) -> tuple[Points, Ways]:
    """Return the graph with nodes at the same position merged, and each way once, in order."""
    if not len(at):
        return at, ways
    _, first, node = np.unique(np.round(at / _SAME_M), axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")  # in the order of the road map
    number = np.empty_like(order)
    number[order] = np.arange(len(order))
    ways = np.sort(number[node.reshape(-1)][ways], axis=1).astype(np.int64)
    return at[first[order]], np.unique(ways[ways[:, 0] != ways[:, 1]], axis=0)


def _clear_of_lone_trees(drives: Drives, at: Points, ways: Ways) -> Ways:
    """Return the ways that keep half the robot's width from trees in no row, over which the drives of a site lead."""
    lone = [shapely.Point(xy) for xy in lone_trees(drives)]
    lines = shapely.linestrings(at[ways])
    near, _ = shapely.STRtree(lone).query(lines, predicate="dwithin", distance=drives.clearance_m)
    return np.delete(ways, near, axis=0)


def _without_replaceable(at: Points, ways: Ways) -> Ways:
    """Return the ways without those that two others replace, which are hardly longer: along an aisle, all but the next
    node."""
    metres = np.hypot(*(at[ways[:, 0]] - at[ways[:, 1]]).T).tolist()
    beside: list[dict[int, float]] = [{} for _ in range(len(at))]
    for (a, b), length in zip(ways.tolist(), metres, strict=True):
        beside[a][b] = beside[b][a] = length
    for k in sorted(range(len(ways)), key=lambda k: (-metres[k], k)):
        a, b = ways[k].tolist()
        few, many = sorted((beside[a], beside[b]), key=len)
        most = metres[k] * (1.0 + _LONGER)
        if any(c in many and length + many[c] <= most for c, length in few.items()):
            del beside[a][b], beside[b][a]
    kept = [(a, b) for a, others in enumerate(beside) for b in sorted(others) if a < b]
    return np.array(kept, dtype=np.int64).reshape(-1, 2)


def _connected(drives: Drives, at: Points, ways: Ways) -> tuple[Points, Ways]:
    """Return the graph with further ways between its parts that lie on the same connected ground."""
    layout = drives.layout
    part = linked(len(at), ways[:, 0], ways[:, 1])
    spots = layout.spots([(x, y) for x, y in at.tolist()])
    grounds: dict[int, dict[int, list[int]]] = {}
    for node, (spot, number) in enumerate(zip(spots, part.tolist(), strict=True)):
        if spot.foot is not None:
            grounds.setdefault(spot.part, {}).setdefault(number, []).append(node)
    more_at, more_ways = at.tolist(), ways.tolist()
    for parts in grounds.values():
        first, *others = parts.values()
        for nodes in others:
            metres, nearest = PointIndex(at[first]).nearest_few(at[nodes], 1)
            k = int(np.argmin(metres[:, 0]))
            one, two = nodes[k], first[int(nearest[k, 0])]
            way = layout.way(spots[one], spots[two])
            if way is None:  # pragma: no cover  not seen on connected ground; the parts then stay apart
                continue
            chain = [one, *range(len(more_at), len(more_at) + len(way) - 2), two]
            more_at += [list(corner) for corner in way[1:-1]]
            more_ways += [list(pair) for pair in itertools.pairwise(chain)]
    return np.array(more_at).reshape(-1, 2), np.array(more_ways, dtype=np.int64).reshape(-1, 2)


def _slowed(graph: RouteGraph, slow: SlowGround) -> RouteGraph:
    """Return the graph with each edge cut where its speed limit changes."""
    if not slow:
        return graph
    nodes, edges = list(graph.nodes), []
    for edge in graph.edges:
        a, b = nodes[edge.one].xy, nodes[edge.two].xy
        pieces = slow.pieces((a, b), length := math.dist(a, b), edge.speed_m_s) if math.dist(a, b) > _SAME_M else ()
        at = edge.one
        for piece in pieces[:-1]:
            share = piece.to_m / length
            nodes.append(RouteNode(xy=(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))))
            edges.append(replace(edge, one=at, two=len(nodes) - 1, speed_m_s=piece.speed_m_s))
            at = len(nodes) - 1
        edges.append(replace(edge, one=at, speed_m_s=pieces[-1].speed_m_s if pieces else edge.speed_m_s))
    return RouteGraph(nodes=tuple(nodes), edges=tuple(edges))


def _in_aisles(drives: Drives, graph: RouteGraph) -> RouteGraph:
    """Return the graph with the name of the aisle in which each edge lies."""
    at = np.array([node.xy for node in graph.nodes])
    middles = np.array([(at[edge.one] + at[edge.two]) / 2.0 for edge in graph.edges])
    aisles = drives.layout.aisles.at(middles)
    names = {id(aisle): aisle_name(drives.site, aisle) for aisle in drives.layout.aisles.all}
    return replace(
        graph,
        edges=tuple(
            edge if aisle is None else replace(edge, aisle=names[id(aisle)])
            for edge, aisle in zip(graph.edges, aisles, strict=True)
        ),
    )
