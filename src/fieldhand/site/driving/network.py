"""Where a robot drives, as lines with names: for maps and for export."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import minimum_spanning_tree
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry

from fieldhand.language import message
from fieldhand.site.driving.aisles import Aisle
from fieldhand.site.driving.bodies import Body
from fieldhand.site.driving.graph import Indices, Points
from fieldhand.site.driving.ground import XY
from fieldhand.site.driving.layout import Layout
from fieldhand.site.model import Gate, Site

LineKind = Literal["aisle", "headland", "gate", "link"]

_COMPASS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")

#: Pieces of a line shorter than this are not drawn.
_SHORTEST_M = 0.01

#: What takes no link to drive over weighs almost nothing.
_NOTHING = 1e-6


@dataclass(frozen=True, kw_only=True)
class NetworkLine:
    """A line to drive along.

    Attributes:
        kind: An aisle between two rows; the headland along the ends of the rows of a block; a gate, across its opening;
            a link over open ground between these.
        name: "aisle between rows 3 and 4".
        points: Metres east and north, at least two.
        length_m: Along the points.
    """

    kind: LineKind
    name: str
    points: tuple[XY, ...]
    length_m: float


@dataclass(frozen=True, kw_only=True)
class Network:
    """The lines of one site for one robot: aisles, headlands, gates, links. Empty where there are no rows or gates.

    A drive follows them where it can, and turns in and out of them where that is shorter.
    """

    lines: tuple[NetworkLine, ...]

    def of(self, kind: LineKind) -> tuple[NetworkLine, ...]:
        """The lines of one kind."""
        return tuple(line for line in self.lines if line.kind == kind)


def network_of(site: Site, layout: Layout) -> Network:
    """What a robot can drive along on this site."""
    lines = [
        *(line for aisle in layout.aisles for line in _aisle(site, aisle)),
        *(line for body in layout.bodies for line in _headlands(site, layout, body)),
        *(_gate(site, gate) for gate in site.gates),
        *_links(layout),
    ]
    return Network(lines=tuple(lines))


def aisle_name(site: Site, aisle: Aisle) -> str:
    """ "aisle between rows 3 and 4", with the block where there are several."""
    rows = [site.planting.rows[line.rows[0]] for line in (aisle.below, aisle.above)]
    names = [row.name for row in sorted(rows, key=lambda row: row.number)]
    rows_said = message("aisle between rows {one} and {two}", context="log", one=names[0], two=names[1])
    blocks = site.planting.blocks
    if len(blocks) <= 1:
        return rows_said
    return message("{known} of block {id}", context="log", known=rows_said, id=blocks[aisle.body.block].name)


def _of_block(site: Site, body: Body) -> str:
    blocks = site.planting.blocks
    return f" of block {blocks[body.block].name}" if len(blocks) > 1 else ""


def _aisle(site: Site, aisle: Aisle) -> Iterator[NetworkLine]:
    """Its middle line; without the parts where something stands in it."""
    if aisle.course == "closed":
        return
    line = LineString(aisle.body.frame.world(aisle.middle_line))
    free = line if aisle.course != "obstructed" else line.intersection(aisle.soft)
    for part in _pieces(free):
        yield _line("aisle", aisle_name(site, aisle), part)


def _headlands(site: Site, layout: Layout, body: Body) -> Iterator[NetworkLine]:
    """Along the ends of the rows, as far as there is room for the robot."""
    if len(body.lines) < 2:
        return
    for sign, (v, u) in ((-1.0, body.start_outline), (1.0, body.end_outline)):
        east, north = (sign * body.frame.along).tolist()
        side = _COMPASS[round(np.degrees(np.arctan2(east, north)) / 45.0) % 8]
        name = f"{side} headland{_of_block(site, body)}"
        line = LineString(body.frame.world(np.column_stack([u, v])))
        for part in _pieces(line.intersection(layout.ground.soft.edged)):
            yield _line("headland", name, part)


def _gate(site: Site, gate: Gate) -> NetworkLine:
    """Across its opening, along the fence."""
    middle = np.array(gate.place.xy)
    fences = [z.polygon.exterior for z in site.zones_of("boundary")]
    fences += [z.polygon.exterior for z in site.zones_of("keep_out")]
    along = np.array([1.0, 0.0])
    if fences:
        fence = min(fences, key=lambda f: float(f.distance(shapely.Point(middle))))
        at = fence.project(shapely.Point(middle))
        ahead, behind = (np.array(fence.interpolate(at + step).coords[0]) for step in (0.05, -0.05))
        if np.hypot(*(ahead - behind)) > 0.0:
            along = (ahead - behind) / np.hypot(*(ahead - behind))
    half = gate.width_m / 2.0 * along
    return _line("gate", f"gate {gate.place.id}", np.array([middle - half, middle + half]))


def _links(layout: Layout) -> list[NetworkLine]:
    """The fewest metres over open ground that join aisles and headlands: a minimum spanning tree."""
    ground = layout.ground
    n = len(ground.nodes)
    if not layout.mouths:
        return []
    body_of = _bodies_at(layout)
    one, two, metres = ground.one, ground.two, ground.metres
    weight = np.where((body_of[one] >= 0) & (body_of[one] == body_of[two]), _NOTHING, metres)
    ends = _through(layout)
    tree = minimum_spanning_tree(
        csr_matrix(
            (
                np.concatenate([weight, np.full(len(ends), _NOTHING)]),
                (np.concatenate([one, ends[:, 0]]), np.concatenate([two, ends[:, 1]])),
            ),
            shape=(n, n),
        )
    ).tocoo()
    links = {
        (i, j) for i, j, w in zip(tree.row.tolist(), tree.col.tolist(), tree.data.tolist(), strict=True) if w > 1e-3
    }
    for link in _dead_ends(links, body_of):
        links.discard(link)
    return [_line("link", "way over open ground", ground.nodes[[i, j]]) for i, j in sorted(links)]


def _through(layout: Layout) -> Indices:
    """Pairs of nodes of the ground that an aisle joins, shape (n, 2)."""
    doors: dict[int, list[int]] = {}
    for k, mouth in enumerate(layout.mouths):
        doors.setdefault(mouth.aisle, []).append(layout.ground.first_door + k)
    pairs = [(d[0], other) for d in doors.values() for other in d[1:]]
    return np.array(pairs, dtype=np.intp).reshape(-1, 2)


def _dead_ends(links: set[tuple[int, int]], body_of: Points) -> set[tuple[int, int]]:
    """Links that lead to corners of obstacles and no farther."""
    left = set(links)
    gone: set[tuple[int, int]] = set()
    while True:
        degree: dict[int, int] = {}
        for node in itertools.chain.from_iterable(left):
            degree[node] = degree.get(node, 0) + 1
        dead = {k for k in left if any(degree[node] == 1 and body_of[node] < 0 for node in k)}
        if not dead:
            return gone
        left -= dead
        gone |= dead


def _bodies_at(layout: Layout) -> Points:
    """For each node of the ground the body on whose outline it lies; -1 for none. Shape (n,)."""
    found = np.full(len(layout.ground.nodes), -1)
    if len(layout.bodies) and len(found):
        points = shapely.points(layout.ground.nodes)
        for node, body in layout.spots.outlines.query(points, predicate="dwithin", distance=1e-5).T.tolist():
            found[node] = max(body, found[node])
    return found


def _pieces(shape: BaseGeometry) -> Iterator[Points]:
    for part in getattr(shape, "geoms", [shape]):
        if isinstance(part, LineString) and part.length > _SHORTEST_M:
            yield shapely.get_coordinates(part)


def _line(kind: LineKind, name: str, points: Points) -> NetworkLine:
    steps = np.diff(points, axis=0)
    return NetworkLine(
        kind=kind,
        name=name,
        points=tuple((float(x), float(y)) for x, y in points),
        length_m=float(np.hypot(steps[:, 0], steps[:, 1]).sum()),
    )
