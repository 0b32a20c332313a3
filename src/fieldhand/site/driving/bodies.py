"""The ground that rows take up: their strips, with an outline that ways over open ground go around.

A body is what a robot leaves only by the mouths of its aisles: the rows of a block, the strips between them, and a
little more at either end, so that it turns clear of the last trees. Rows that do not lie side by side in order (named
so by a file, or grown through one another) are a body each, a line with nothing between.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry import LineString, Point, Polygon

from fieldhand.site.driving.free import Free
from fieldhand.site.driving.outline import reach
from fieldhand.site.driving.rowlines import Frame, Line, Points, RowLine, row_line, simplified_above
from fieldhand.site.model import Site
from fieldhand.site.planting import Block

#: Rows of a block that are this many row spacings apart have open ground between them, not an aisle.
_APART = 2.5

#: Rows end to end stand within this part of a row spacing.
_SAME_LINE = 0.35

#: The outline's sides may run this part of the row spacing outside the outer trees' line, so that it has few corners.
_SIDE = 0.04

#: A notch in the row ends less deep than this many row spacings is closed.
_NOTCH = 1.5


@dataclass(frozen=True, eq=False)
class Body:
    """Rows side by side, and the ground between them.

    Attributes:
        block: Position of their block in the planting.
        lines: In the order of v, at least one.
        start_outline, end_outline: (v, u) of the outline's corners at the ends of least and greatest u, in the order
            of v.
        low_side, high_side: (u, v) of the outline along the first and the last line.
    """

    block: int
    frame: Frame
    lines: tuple[RowLine, ...]
    start_outline: Line
    end_outline: Line
    low_side: Line
    high_side: Line

    @cached_property
    def polygon(self) -> Polygon:
        """The outline in metres east and north."""
        v0, u0 = self.start_outline
        v1, u1 = self.end_outline
        low = _within(self.low_side, float(u0[0]), float(u1[0]))
        high = _within(self.high_side, float(u0[-1]), float(u1[-1]))
        ring = np.vstack([low, np.column_stack([u1, v1])[1:], high[::-1][1:], np.column_stack([u0, v0])[::-1][1:-1]])
        return Polygon(self.frame.world(ring))

    def reaches(self, v: float) -> tuple[float, float]:
        """From which u to which the body reaches at this v."""
        (v0, u0), (v1, u1) = self.start_outline, self.end_outline
        return float(np.interp(v, v0, u0)), float(np.interp(v, v1, u1))


def bodies_of(site: Site, free: Free, standoff_m: float) -> tuple[Body, ...]:
    """The bodies of all blocks of a site."""
    trees = tree_lines(site)
    found: list[Body] = []
    first = 0
    for number, block in enumerate(site.planting.blocks):
        for frame, lines in _groups(site, block, first, free.clearance_m):
            found.extend(_bodies(number, frame, lines, free, trees, block, standoff_m))
        first += len(block.rows)
    return tuple(found)


def tree_lines(site: Site) -> shapely.STRtree:
    """The lines through the trees of all rows, in the order of the planting; of a single tree a point."""
    xy = [site.xy[row.trees] for row in site.planting.rows]
    return shapely.STRtree([LineString(p) if len(p) > 1 else Point(p[0]) for p in xy])


def _groups(site: Site, block: Block, first: int, clearance_m: float) -> Iterator[tuple[Frame, list[RowLine]]]:
    """The rows of a block that lie side by side, in order across them."""
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
    """The block's axes, along its rows as they really run."""
    frame = Frame.of_bearing(block.bearing_deg)
    together, along = 0.0, 0.0
    for row in block.rows:
        uv = frame.local(site.xy[row.trees])
        u, v = (uv - uv.mean(axis=0)).T
        together, along = together + float(u @ v), along + float(u @ u)
    slope = together / along if along > 0.0 else 0.0
    return frame.turned(slope) if abs(slope) < 0.5 else frame


def _overlapping(lines: Sequence[RowLine]) -> list[list[RowLine]]:
    """Rows in groups that a road across the rows parts from each other."""
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


def _bodies(
    number: int,
    frame: Frame,
    lines: Sequence[RowLine],
    free: Free,
    trees: shapely.STRtree,
    block: Block,
    standoff_m: float,
) -> Iterator[Body]:
    """One body, or one for each line where they do not lie side by side."""
    if len(lines) > 1:
        body = _body(number, frame, lines, free, trees, block, standoff_m)
        if body.polygon.is_valid and _in_order(body, trees):
            yield body
            return
    for line in lines:
        yield _body(number, frame, [line], free, trees, block, standoff_m)


def _in_order(body: Body, trees: shapely.STRtree) -> bool:
    """Whether no row lies between two others that are neighbours, as a whole or in part."""
    strips = [_strip(body, k) for k in range(len(body.lines) - 1)]
    if not all(s.is_valid for s in strips):
        return False
    inner = [s.buffer(-1e-3) for s in strips]
    return len(trees.query(inner, predicate="intersects")[0]) == 0


def _strip(body: Body, k: int) -> Polygon:
    """What lies between the lines k and k + 1, up to the outline."""
    below, above = body.lines[k], body.lines[k + 1]
    (v0, u0), (v1, u1) = body.start_outline, body.end_outline
    sides = []
    for u, v in ((below.u, below.high), (above.u, above.low)):
        start, end = np.interp(v[0], v0, u0), np.interp(v[-1], v1, u1)
        sides.append(np.column_stack([[start, *u, end], [v[0], *v, v[-1]]]))
    return Polygon(body.frame.world(np.vstack([sides[0], sides[1][::-1]])))


def _body(
    number: int,
    frame: Frame,
    lines: Sequence[RowLine],
    free: Free,
    trees: shapely.STRtree,
    block: Block,
    standoff_m: float,
) -> Body:
    spacing = block.row_spacing_m if len(lines) > 1 and np.isfinite(block.row_spacing_m) else 2.0 * standoff_m
    room = max(min(standoff_m, spacing / 2.0), free.clearance_m)
    tolerance = max(_SIDE * spacing, 0.02)
    own = {row for line in lines for row in line.rows}

    def clear(ends: Points) -> bool:
        """Whether a line, (u, v) of its ends, is free and runs through no row of another body."""
        line = shapely.linestrings(frame.world(ends))
        return bool(free.covers(line, soft=True)[0]) and own.issuperset(trees.query(line, "intersects").tolist())

    notch = max(standoff_m - free.clearance_m, tolerance)
    high = _side(lines[-1].upper, notch, tolerance, clear)
    low = _mirrored(
        _side(_mirrored(lines[0].lower), notch, tolerance, lambda pair: clear(pair * np.array([1.0, -1.0])))
    )
    outlines = []
    for sign in (-1.0, 1.0):
        u = np.array([line.u[-1] if sign > 0 else line.u[0] for line in lines])
        v = np.array([(line.high + line.low)[-1 if sign > 0 else 0] / 2.0 for line in lines])
        out = sign * u + _extension(frame, np.column_stack([u, v]), sign, room, free, trees, own)
        beside = np.column_stack([v - free.clearance_m, v + free.clearance_m]).ravel()
        sides = [float(np.interp(sign * out[0], *low)), float(np.interp(sign * out[-1], *high))]
        at_v = np.concatenate([[min(sides[0], beside[0])], beside, [max(sides[1], beside[-1])]])
        at_u = np.concatenate([out[:1], np.repeat(out, 2), out[-1:]])
        row = np.concatenate([[0], np.repeat(np.arange(len(lines)), 2), [len(lines) - 1]])
        order = np.argsort(at_v, kind="stable")
        ends = np.column_stack([at_v, at_u])[order]
        corner_v, corner_u = reach(
            ends,
            row[order],
            _NOTCH * spacing,
            lambda pair, sign=sign: clear(np.column_stack([sign * pair[:, 1], pair[:, 0]])),  # type: ignore[misc]
        )
        outlines.append((corner_v, sign * corner_u))
    return Body(number, frame, tuple(lines), outlines[0], outlines[1], low, high)


def _side(line: Line, notch_m: float, tolerance_m: float, free: Callable[[Points], bool]) -> Line:
    """The outline along an outer row, given the line that is clear of it: few corners, nowhere below it."""
    u, v = line
    return simplified_above(reach(np.column_stack([u, v]), np.arange(len(u)), notch_m, free), tolerance_m)


def _extension(
    frame: Frame, ends: Points, sign: float, room: float, free: Free, trees: shapely.STRtree, own: set[int]
) -> Points:
    """How far beyond each last tree the robot turns: ``room``, but never past the middle of the way to what is next."""
    extension = np.full(len(ends), room)
    tip = frame.world(ends)
    ahead = sign * frame.along
    if free.bounded:
        for part in (1.0, 0.75, 0.5, 0.25):
            rays = shapely.linestrings(np.stack([tip, tip + 2.0 * room * part * ahead], axis=1))
            blocked = ~free.covers(rays, soft=False)
            extension[blocked] = np.minimum(extension[blocked], room * (part - 0.25))
    rays = shapely.linestrings(np.stack([tip, tip + 2.0 * room * ahead], axis=1))
    for k, row in trees.query(rays, predicate="intersects").T.tolist():
        if row not in own:
            away = shapely.distance(shapely.points(tip[k]), trees.geometries[row])
            extension[k] = min(extension[k], float(away) / 2.0)
    return np.asarray(np.maximum(extension, free.clearance_m))


def _within(line: Line, first: float, last: float) -> Points:
    """The part of a (u, v) line between two u, its ends included, shape (n, 2)."""
    u, v = line
    inner = (u > first) & (u < last)
    at = np.concatenate([[first], u[inner], [last]])
    return np.column_stack([at, np.interp(at, u, v)])


def _mirrored(line: Line) -> Line:
    return line[0], -line[1]
