"""Measure the widths of the aisles between neighbouring rows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry

from fieldhand.site.describe.rows import shortened
from fieldhand.site.model import Site
from fieldhand.site.planting import Block, Row

Points = NDArray[np.float64]

#: Number of following rows examined for neighbours: several may lie in one line, such as those cut by a pond.
_AHEAD = 4


@dataclass(frozen=True, kw_only=True)
class AisleSummary:
    """The aisle between two neighbouring rows.

    Attributes:
        name: Name as in the drivable network.
        block: Name of the block.
        between: Names of the two rows.
        width_m: Median width from tree line to tree line, in metres.
        narrowest_m: Least width from tree line to tree line, in metres.
    """

    name: str
    block: str
    between: tuple[str, str]
    width_m: float
    narrowest_m: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Lane:
    """Two neighbouring rows side by side, with no other row between them."""

    block: Block
    one: Row
    two: Row


def aisle_table(site: Site) -> tuple[AisleSummary, ...]:
    """Return every aisle, block after block."""
    return tuple(aisle_summary(site, lane) for lane in lanes(site))


def lanes(site: Site) -> Iterator[Lane]:
    """Yield the pairs of neighbouring rows, block after block, in the order of the rows."""
    for block in site.planting.blocks:
        turn = math.radians(block.bearing_deg)
        along = np.array([math.sin(turn), math.cos(turn)])
        at = [site.xy[row.trees] @ along for row in block.rows]
        low, high = np.array([a.min() for a in at]), np.array([a.max() for a in at])
        for k in range(len(block.rows)):
            beside: list[int] = []
            for j in range(k + 1, min(k + 1 + _AHEAD, len(block.rows))):
                reach = np.minimum(high[[k, *beside]], high[j]) - np.maximum(low[[k, *beside]], low[j])
                abreast = reach > -0.5 * block.tree_spacing_m
                if abreast[0] and not abreast[1:].any():
                    yield Lane(block=block, one=block.rows[k], two=block.rows[j])
                if abreast[0]:
                    beside.append(j)


def lane_name(site: Site, lane: Lane) -> str:
    """Return the name of an aisle as in the drivable network: "aisle between rows 3 and 4"."""
    where = f" of block {lane.block.name}" if len(site.planting.blocks) > 1 else ""
    return f"aisle between rows {lane.one.name} and {lane.two.name}{where}"


def lane_middle(site: Site, lane: Lane) -> Points:
    """Return points halfway between the rows, one for each tree of the shorter row. Shape (n, 2)."""
    short, long = sorted((lane.one, lane.two), key=lambda row: len(row.trees))
    ways = shapely.shortest_line(shapely.points(site.xy[short.trees]), _line(site, long))
    middle: Points = shapely.get_coordinates(shapely.line_interpolate_point(ways, 0.5, normalized=True))
    return middle


def aisle_summary(site: Site, lane: Lane) -> AisleSummary:
    """Return the names and widths of an aisle."""
    a, b = _line(site, lane.one), _line(site, lane.two)
    short, other = (lane.one, b) if len(lane.one.trees) <= len(lane.two.trees) else (lane.two, a)
    return AisleSummary(
        name=lane_name(site, lane),
        block=shortened(lane.block.name),
        between=(shortened(lane.one.name), shortened(lane.two.name)),
        width_m=float(np.median(shapely.distance(shapely.points(site.xy[short.trees]), other))),
        narrowest_m=float(shapely.distance(a, b)),
    )


def _line(site: Site, row: Row) -> BaseGeometry:
    points = site.xy[row.trees]
    return LineString(points) if len(points) > 1 else Point(points[0])
