"""Drivable lines of a site with names, for maps and for export."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import shapely
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from fieldhand.language import message
from fieldhand.site.driving.aisles import Aisle, RowGroup
from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.layout import XY, Layout
from fieldhand.site.model import Gate, Site
from fieldhand.site.rows.labels import linked

LineKind = Literal["aisle", "headland", "gate", "link"]

_COMPASS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")

#: Pieces of a line shorter than this, in metres, are not drawn.
_SHORTEST_M = 0.01

#: Lines within this distance in metres of each other meet.
_MEET_M = 1e-3


@dataclass(frozen=True, kw_only=True)
class NetworkLine:
    """A drivable line.

    Attributes:
        kind: An aisle between two rows; a headland along the ends of the rows of a block; a gate, across its opening;
            or a link between these over open ground.
        name: Name such as "aisle between rows 3 and 4".
        points: Metres east and north, at least two.
        length_m: Length of the line in metres.
    """

    kind: LineKind
    name: str
    points: tuple[XY, ...]
    length_m: float


@dataclass(frozen=True, kw_only=True)
class DrivableNetwork:
    """The drivable lines of a site for a robot: aisles, headlands, gates, links. Empty without rows and gates.

    The lines are for display: drives take shorter paths where there is room.
    """

    lines: tuple[NetworkLine, ...]

    def of(self, kind: LineKind) -> tuple[NetworkLine, ...]:
        """Return the lines of one kind."""
        return tuple(line for line in self.lines if line.kind == kind)


def network_of(site: Site, layout: Layout) -> DrivableNetwork:
    """Return the drivable network of a site."""
    driven = [
        *(line for aisle in layout.aisles.all for line in _aisle(site, layout, aisle)),
        *(line for group in layout.aisles.groups for line in _headlands(site, layout, group)),
    ]
    gates = [_gate(site, gate) for gate in site.gates]
    return DrivableNetwork(lines=(*driven, *gates, *_links(layout, driven)))


def aisle_name(site: Site, aisle: Aisle) -> str:
    """Return the name of an aisle: "aisle between rows 3 and 4", with the block if there are several."""
    rows = [site.planting.rows[line.rows[0]] for line in (aisle.below, aisle.above)]
    names = [row.name for row in sorted(rows, key=lambda row: row.number)]
    rows_said = message("aisle between rows {one} and {two}", context="log", one=names[0], two=names[1])
    blocks = site.planting.blocks
    if len(blocks) <= 1:
        return rows_said
    return message("{known} of block {id}", context="log", known=rows_said, id=blocks[aisle.group.block].name)


def _of_block(site: Site, group: RowGroup) -> str:
    blocks = site.planting.blocks
    return f" of block {blocks[group.block].name}" if len(blocks) > 1 else ""


def _aisle(site: Site, layout: Layout, aisle: Aisle) -> Iterator[NetworkLine]:
    """Yield the middle line of an aisle, without the parts that are blocked or too narrow."""
    line = LineString(aisle.frame.world(aisle.middle_line))
    for part in _pieces(line.intersection(layout.visibility.area.edged)):
        yield _line("aisle", aisle_name(site, aisle), part)


def _headlands(site: Site, layout: Layout, group: RowGroup) -> Iterator[NetworkLine]:
    """Yield the lines along the ends of the rows, as far as there is room for the robot."""
    if len(group.lines) < 2:
        return
    for sign, (v, u) in ((-1.0, group.start_headland), (1.0, group.end_headland)):
        east, north = (sign * group.frame.along).tolist()
        side = _COMPASS[round(np.degrees(np.arctan2(east, north)) / 45.0) % 8]
        name = f"{side} headland{_of_block(site, group)}"
        line = LineString(group.frame.world(np.column_stack([u, v])))
        for part in _pieces(line.intersection(layout.visibility.area.edged)):
            yield _line("headland", name, part)


def _gate(site: Site, gate: Gate) -> NetworkLine:
    """Return the line across the opening of a gate, along the fence."""
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


def _links(layout: Layout, driven: Sequence[NetworkLine]) -> Iterator[NetworkLine]:
    """Yield paths over open ground that connect aisles and headlands which do not meet, nearest first."""
    lines = np.array([LineString(line.points) for line in driven], dtype=object)
    if not len(lines):
        return
    one, two = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=_MEET_M)
    part = linked(len(lines), one, two)
    parts = [shapely.union_all(lines[part == k]) for k in range(part.max() + 1)]
    pairs = sorted((float(parts[i].distance(parts[j])), i, j) for i, j in itertools.combinations(range(len(parts)), 2))
    joined = list(range(len(parts)))
    for _, i, j in pairs:
        if joined[i] == joined[j]:
            continue
        a, b = (layout.spot((p.x, p.y)) for p in nearest_points(parts[i], parts[j]))
        way = layout.way(a, b)
        if way is not None:
            joined = [joined[i] if k == joined[j] else k for k in joined]
            yield _line("link", "way over open ground", np.array(way))


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
