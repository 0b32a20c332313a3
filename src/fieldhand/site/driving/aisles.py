"""Aisles: the strips between neighbouring rows of a block, and the headlands at the ends of these rows."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.bearings import bearing_of
from fieldhand.site.driving.free_space import FreeSpace
from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.row_obstacles import RowObstacle, row_obstacles
from fieldhand.site.driving.rowlines import Frame, Line, RowLine, row_line
from fieldhand.site.model import Site
from fieldhand.site.planting import Block

#: Rows of a block that are more than this many row spacings apart have open ground between them, not an aisle.
_APART = 2.5

#: Greatest offset between rows end to end in one line, as a fraction of the row spacing.
_SAME_LINE = 0.35

#: Tolerance of the middle line between bent rows, as a fraction of the aisle's width.
_MIDDLE = 0.05


@dataclass(frozen=True, eq=False)
class RowGroup:
    """Adjacent rows with an aisle between every two neighbours.

    Attributes:
        block: Index of their block in the planting.
        frame: Axes of the block.
        lines: Lines of the rows in the order of v, at least one.
        obstacles: Obstacle of each line.
    """

    block: int
    frame: Frame
    lines: tuple[RowLine, ...]
    obstacles: tuple[RowObstacle, ...]

    @cached_property
    def start_headland(self) -> Line:
        """Return (v, u) along the ends of the rows of least u, in the order of v."""
        return self._headland(0)

    @cached_property
    def end_headland(self) -> Line:
        """Return (v, u) along the ends of the rows of greatest u, in the order of v."""
        return self._headland(1)

    def _headland(self, end: int) -> Line:
        uv = self.frame.local(np.concatenate([body.ends[end] for body in self.obstacles]))
        uv = uv[np.argsort(uv[:, 1], kind="stable")]
        return uv[:, 1], uv[:, 0]


@dataclass(frozen=True, eq=False)
class Aisle:
    """The strip between two neighbouring rows.

    Attributes:
        number: Number of the aisle on the site, from 0.
        group_number: Index of its group.
        group: Group that it belongs to.
        position: Index of the aisle in its group, equal to that of the row below it.
    """

    number: int
    group_number: int
    group: RowGroup
    position: int

    @property
    def frame(self) -> Frame:
        """Return the axes of its rows."""
        return self.group.frame

    @property
    def below(self) -> RowLine:
        """Return the row of lesser v."""
        return self.group.lines[self.position]

    @property
    def above(self) -> RowLine:
        """Return the row of greater v."""
        return self.group.lines[self.position + 1]

    @property
    def is_straight(self) -> bool:
        """Return True if a robot can drive along the whole aisle in a straight line."""
        return self.below.top <= self.above.bottom

    def bounds(self, u: Points) -> tuple[Points, Points]:
        """Return the least and greatest v at which the robot is clear of the rows at each u."""
        return np.interp(u, *self.below.upper), np.interp(u, *self.above.lower)

    def width(self, u: Points | float) -> Points:
        """Return the width from row to row in metres at each u."""
        return np.asarray(np.interp(u, self.above.u, self.above.low) - np.interp(u, self.below.u, self.below.high))

    def middle(self, u: Points | float) -> Points:
        """Return v halfway between the rows at each u."""
        low, high = np.interp(u, self.below.u, self.below.high), np.interp(u, self.above.u, self.above.low)
        return np.asarray((low + high) / 2.0)

    @cached_property
    def middle_line(self) -> Points:
        """Return the simplified line (u, v) halfway between the rows, from headland to headland; shape (n, 2)."""
        ends = self.middle(np.array([-np.inf, np.inf]))
        start = float(np.interp(ends[0], *self.group.start_headland))
        end = float(np.interp(ends[1], *self.group.end_headland))
        u = np.unique(np.concatenate([self.below.u, self.above.u]))
        u = np.concatenate([[start], u[(u > start) & (u < end)], [end]])
        tolerance = _MIDDLE * abs(float(self.width(u[len(u) // 2])))
        line = shapely.linestrings(np.column_stack([u, self.middle(u)]))
        return shapely.get_coordinates(shapely.simplify(line, tolerance))

    def axis_deg(self, xy: tuple[float, float]) -> float:
        """Return its bearing at a point: that of its block, or where rows are bent of its middle line."""
        along = self.frame.along
        if not self.is_straight:
            line = self.middle_line
            k = int(np.searchsorted(line[:, 0], float(self.frame.local(np.array([xy]))[0, 0]))) - 1
            k = min(max(k, 0), len(line) - 2)
            along = np.diff(self.frame.world(line[k : k + 2]), axis=0)[0]
        return bearing_of((0.0, 0.0), (float(along[0]), float(along[1])))

    @property
    def entries(self) -> Points:
        """Return its openings onto the headlands, in metres east and north, shape (2, 2)."""
        return self.frame.world(self.middle_line[[0, -1]])

    @cached_property
    def polygon(self) -> BaseGeometry:
        """Return the strip from row to row, as long as the longer of them, in metres east and north."""
        below, above = self.below, self.above
        ends = [self.group.obstacles[k].ends for k in (self.position, self.position + 1)]
        first = min(float(self.frame.local(start)[:, 0].min()) for start, _ in ends)
        last = max(float(self.frame.local(end)[:, 0].max()) for _, end in ends)
        u = np.unique(np.concatenate([[first], below.u, above.u, [last]]))
        u = u[(u >= first) & (u <= last)]
        low, high = np.interp(u, below.u, below.high), np.interp(u, above.u, above.low)
        ring = np.vstack([np.column_stack([u, low]), np.column_stack([u, np.maximum(low, high)])[::-1]])
        strip = Polygon(self.frame.world(ring))
        return strip if strip.is_valid else strip.buffer(0.0)


class Aisles:
    """The row groups of a site, their obstacles, and the aisles between them.

    Args:
        site: Site with its rows.
        free: Ground outside keep-outs.
        standoff_m: Distance in metres beyond the last trees at which a robot turns, if there is room.
    """

    def __init__(self, site: Site, free: FreeSpace, standoff_m: float) -> None:
        self.row_lines = tree_lines(site)
        found = [
            (number, frame, lines)
            for number, block in enumerate(site.planting.blocks)
            for frame, together in _groups(site, number, block, free.clearance_m)
            for lines in _in_order(frame, together, self.row_lines)
        ]
        obstacles = iter(
            row_obstacles(
                [_trees_of(site, line) for _, _, lines in found for line in lines],
                [(frame, site.planting.blocks[number]) for number, frame, lines in found for _ in lines],
                free,
                standoff_m,
            )
        )
        self.groups = tuple(
            RowGroup(number, frame, tuple(lines), tuple(next(obstacles) for _ in lines))
            for number, frame, lines in found
        )
        self.obstacles = tuple(body for group in self.groups for body in group.obstacles)
        self._first = [0, *itertools.accumulate(len(group.lines) - 1 for group in self.groups)]
        self.all = tuple(
            Aisle(self._first[k] + position, k, group, position)
            for k, group in enumerate(self.groups)
            for position in range(len(group.lines) - 1)
        )

    def of(self, group: int, position: int) -> Aisle:
        """Return the aisle above a line of a group."""
        return self.all[self._first[group] + position]

    def at(self, xy: Points) -> list[Aisle | None]:
        """Return the aisle in which each point lies; None on open ground."""
        number = np.full(len(xy), len(self.all))
        points, aisles = self._polygons.query(shapely.points(xy), predicate="intersects")
        np.minimum.at(number, points, aisles)
        return [self.all[k] if k < len(self.all) else None for k in number.tolist()]

    @cached_property
    def _polygons(self) -> shapely.STRtree:
        return shapely.STRtree([aisle.polygon for aisle in self.all])


def tree_lines(site: Site) -> shapely.STRtree:
    """Return the lines through the trees of all rows, in planting order; a point for a row of a single tree."""
    xy = [site.xy[row.trees] for row in site.planting.rows]
    return shapely.STRtree([LineString(p) if len(p) > 1 else Point(p[0]) for p in xy])


def _trees_of(site: Site, line: RowLine) -> Points:
    """Return the trees along a line in metres, shape (n, 2)."""
    return np.concatenate([site.xy[site.planting.rows[row].trees] for row in line.rows])


def _groups(site: Site, number: int, block: Block, clearance_m: float) -> Iterator[tuple[Frame, list[RowLine]]]:
    """Yield the groups of adjacent rows of a block, with the rows in order across them."""
    first = sum(len(b.rows) for b in site.planting.blocks[:number])
    frame = _frame(site, block)
    lines = [row_line((first + k,), frame.local(site.xy[row.trees]), clearance_m) for k, row in enumerate(block.rows)]
    for beside in _overlapping(lines):
        lines = sorted(beside, key=lambda line: float(line.low.mean() + line.high.mean()))
        middles = np.array([float(line.low.mean() + line.high.mean()) / 2.0 for line in lines])
        spacing = float(np.median(np.diff(middles))) if len(lines) > 1 else 0.0
        group: list[RowLine] = []
        for line, gap in zip(lines, [0.0, *np.diff(middles).tolist()], strict=True):
            if group and gap < _SAME_LINE * spacing and _end_to_end(group[-1], line):
                group[-1] = _joined(group[-1], line)
            elif group and gap > _APART * spacing:
                yield frame, group
                group = [line]
            else:
                group.append(line)
        yield frame, group


def _frame(site: Site, block: Block) -> Frame:
    """Return the axes of a block, fitted to the trees of its rows."""
    frame = Frame.of_bearing(block.bearing_deg)
    together, along = 0.0, 0.0
    for row in block.rows:
        uv = frame.local(site.xy[row.trees])
        u, v = (uv - uv.mean(axis=0)).T
        together, along = together + float(u @ v), along + float(u @ u)
    slope = together / along if along > 0.0 else 0.0
    return frame.turned(slope) if abs(slope) < 0.5 else frame


def _overlapping(lines: Sequence[RowLine]) -> list[list[RowLine]]:
    """Return the rows in groups that are separated by roads across the rows."""
    groups: list[list[RowLine]] = []
    end = -np.inf
    for line in sorted(lines, key=lambda line: float(line.u[0])):
        if not groups or line.u[0] > end:
            groups.append([])
        groups[-1].append(line)
        end = max(end, float(line.u[-1]))
    return groups


def _end_to_end(one: RowLine, two: RowLine) -> bool:
    return bool(one.u[-1] < two.u[0] or two.u[-1] < one.u[0])


def _joined(one: RowLine, two: RowLine) -> RowLine:
    if two.u[0] < one.u[0]:
        one, two = two, one
    u, low, high = (np.concatenate([getattr(one, k), getattr(two, k)]) for k in ("u", "low", "high"))
    return RowLine((*one.rows, *two.rows), u, low, high, one.clearance_m)


def _in_order(frame: Frame, lines: Sequence[RowLine], trees: shapely.STRtree) -> list[Sequence[RowLine]]:
    """Return the lines as one group, or each separately if another row lies between two neighbours."""
    if len(lines) == 1:
        return [lines]
    strips = []
    for below, above in itertools.pairwise(lines):
        sides = [np.column_stack([below.u, below.high]), np.column_stack([above.u, above.low])[::-1]]
        ring = np.vstack(sides)
        if len(ring) > 2:
            strips.append((Polygon(frame.world(ring)), {*below.rows, *above.rows}))
    if not strips:  # single trees: nothing can lie between two points
        return [lines]
    if not all(strip.is_valid for strip, _ in strips):
        return [[line] for line in lines]
    which, rows = trees.query([strip for strip, _ in strips], predicate="intersects")
    between: dict[int, list[int]] = {}
    for k, row in zip(which.tolist(), rows.tolist(), strict=True):
        if row not in strips[k][1]:
            between.setdefault(k, []).append(row)
    # Rows may touch the strip.
    if any(strips[k][0].buffer(-1e-3).intersects(trees.geometries[others]).any() for k, others in between.items()):
        return [[line] for line in lines]
    return [lines]
