"""Ground that a mission keeps the robot away from: beside rows, around places, in zones, at gates."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from fieldhand.site.driving.aisles import Aisle, RowGroup
from fieldhand.site.driving.layout import Layout
from fieldhand.site.model import Gate, Site

#: Distance in metres between closed ground and the ends of its rows, and the rows beside it.
_BEFORE_M = 0.05

#: Distance in metres by which closed ground extends beyond a stand on the outer side of an outer row.
_BEYOND_STAND_M = 0.1

#: Chords per quarter turn of the outline at a distance, outside the true arc.
_CHORDS = 8

Points = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False, kw_only=True)
class ClosedGround:
    """Ground that the robot must not drive on.

    Attributes:
        rule: What the robot does in words that follow "must" ("keep out of row 10", "keep 5 m from the pond").
        inside: Where a place on it is, in words that follow "tree 17 is" ("in row 10", "within 5 m of the pond").
        shape: Its outline in metres east and north.
        trees: Indices of the trees beside which it lies, which are on it for people even if their trunks are not.
    """

    rule: str
    inside: str
    shape: BaseGeometry
    trees: frozenset[int] = frozenset()


def at_distance(shape: BaseGeometry, metres: float) -> BaseGeometry:
    """Return the ground at most so far from a shape, nowhere narrower; the shape itself for 0."""
    if metres <= 0.0:
        return shape
    return shape.buffer(metres / math.cos(math.pi / (4 * _CHORDS)), quad_segs=_CHORDS)


def opening_of(gate: Gate) -> BaseGeometry:
    """Return the opening of a gate."""
    return Point(gate.place.xy).buffer(gate.width_m / 2.0 + _BEFORE_M)


def along_trees(site: Site, trees: Sequence[int]) -> BaseGeometry:
    """Return the lines through trees that follow each other in a row, and the other trees as points."""
    runs = [site.xy[list(run)] for run in _runs(site, trees)]
    return shapely.union_all([LineString(xy) if len(xy) > 1 else Point(xy[0]) for xy in runs])


def beside_trees(site: Site, layout: Layout, trees: Sequence[int], standoff_m: float) -> BaseGeometry:
    """Return the ground from which a robot works on trees: the aisles on both sides, along those trees.

    On the outer side of an outer row, it is a strip as wide as the robot's distance from a tree; around a tree in no
    row, a disc.

    Args:
        site: The site.
        layout: Drivable layout of the site.
        trees: Indices of the trees.
        standoff_m: Distance in metres from a tree to the robot working on it.
    """
    reach = max(standoff_m, layout.free.clearance_m) + _BEYOND_STAND_M
    lines = {
        row: (group, k) for group in layout.aisles.groups for k, line in enumerate(group.lines) for row in line.rows
    }
    numbers = {id(group): number for number, group in enumerate(layout.aisles.groups)}
    shapes: list[BaseGeometry] = []
    for run in _runs(site, trees):
        xy = site.xy[list(run)]
        row = int(site.planting.row_of[run[0]])
        if row < 0:
            shapes.append(Point(xy[0]).buffer(max(reach, site.spacing_m / 2.0)))
            continue
        group, k = lines[row]
        first, last = _extent(site, group, run)
        for side, position in ((-1, k - 1), (1, k)):
            if 0 <= position < len(group.lines) - 1:
                shapes.append(_strip(layout.aisles.of(numbers[id(group)], position), first, last))
            else:
                shapes.append(_outer_strip(group, xy, first, last, side * reach))
    return shapely.union_all([shape for shape in shapes if not shape.is_empty])


def between_rows(site: Site, layout: Layout, trees: Sequence[int]) -> BaseGeometry:
    """Return the aisles between rows all of whose trees are given."""
    whole = {row for row in range(len(site.planting.rows)) if set(site.planting.rows[row].trees.tolist()) <= set(trees)}
    strips = [
        _strip(aisle, max(aisle.below.u[0], aisle.above.u[0]), min(aisle.below.u[-1], aisle.above.u[-1]))
        for aisle in layout.aisles.all
        if whole.issuperset(aisle.below.rows) and whole.issuperset(aisle.above.rows)
    ]
    return shapely.union_all(strips)


def _runs(site: Site, trees: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Yield trees that follow each other in a row; a tree in no row by itself."""
    planting = site.planting
    order = sorted(dict.fromkeys(trees), key=lambda tree: (int(planting.row_of[tree]), int(planting.rank[tree])))
    run: list[int] = []
    for tree in order:
        row, rank = planting.row_of[tree], planting.rank[tree]
        follows = run and 0 <= row == planting.row_of[run[-1]] and rank == planting.rank[run[-1]] + 1
        if run and not follows:
            yield tuple(run)
            run = []
        run.append(tree)
    if run:
        yield tuple(run)


def _extent(site: Site, group: RowGroup, run: Sequence[int]) -> tuple[float, float]:
    """Return the first and the last u of trees of a row, and half the way to the trees before and after them."""
    planting = site.planting
    row = planting.rows[int(planting.row_of[run[0]])].trees
    ends: list[float] = []
    for tree, step in ((run[0], -1), (run[-1], 1)):
        rank = int(planting.rank[tree])
        beyond = int(row[rank + step]) if 0 <= rank + step < len(row) else tree
        (u, _), (v, _) = group.frame.local(site.xy[[tree, beyond]]).tolist()
        ends.append((u + v) / 2.0)
    return min(ends), max(ends)


def _strip(aisle: Aisle, first: float, last: float) -> BaseGeometry:
    """Return an aisle from one u to another, without its ends."""
    first, last = first + _BEFORE_M, last - _BEFORE_M
    if last - first < 2.0 * _BEFORE_M:
        first, last = (first + last) / 2.0 - _BEFORE_M, (first + last) / 2.0 + _BEFORE_M
    u = np.unique(np.concatenate([[first], aisle.below.u, aisle.above.u, [last]]))
    u = u[(u >= first) & (u <= last)]
    low, high = np.interp(u, aisle.below.u, aisle.below.high), np.interp(u, aisle.above.u, aisle.above.low)
    ring = np.vstack([np.column_stack([u, low]), np.column_stack([u, np.maximum(low, high)])[::-1]])
    strip = Polygon(aisle.frame.world(ring))
    strip = strip if strip.is_valid else strip.buffer(0.0)
    return strip.buffer(-_BEFORE_M, join_style="mitre")


def _outer_strip(group: RowGroup, xy: Points, first: float, last: float, away: float) -> BaseGeometry:
    """Return the ground beside trees of an outer row, on the side of ``away``'s sign."""
    u, v = group.frame.local(xy).T
    order = np.argsort(u, kind="stable")
    first, last = first + _BEFORE_M, last - _BEFORE_M
    if last - first < 2.0 * _BEFORE_M:
        first, last = (first + last) / 2.0 - _BEFORE_M, (first + last) / 2.0 + _BEFORE_M
    at = np.unique(np.concatenate([[first], u[(u > first) & (u < last)], [last]]))
    line = LineString(group.frame.world(np.column_stack([at, np.interp(at, u[order], v[order])])))
    # Positive distances are to the left; greater v lies to the right of greater u.
    beside = line.buffer(-away, single_sided=True, join_style="mitre")
    return beside if beside.is_valid else beside.buffer(0.0)
