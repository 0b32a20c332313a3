"""Parallel swaths over a part of an area, and estimates of their number and length."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from fieldhand.site.driving.graph import Points
from fieldhand.site.driving.rowlines import Frame

#: Parts of a strip with less area than this, in square metres, are rounding errors.
_NOTHING_M2 = 1e-9


@dataclass(frozen=True, eq=False)
class LocalSwath:
    """A swath in the frame of its cell, and the run that it belongs to.

    Attributes:
        v: Metres across the swaths.
        first, last: Metres along them, at its ends.
        run: Number of its run: neighbouring swaths, one beside the other.
    """

    v: float
    first: float
    last: float
    run: int


def swath_frame(bearing_deg: float) -> Frame:
    """Return the axes of swaths: u metres along them, v metres across."""
    return Frame.of_bearing(bearing_deg)


def in_frame(polygon: BaseGeometry, frame: Frame) -> BaseGeometry:
    """Return a polygon in the frame of its swaths; rounding may make rings cross that touch, which is mended."""
    local = shapely.transform(polygon, frame.local)
    return local if local.is_valid else local.buffer(0.0)


def centres(low: float, high: float, width_m: float, most_apart_m: float) -> Points:
    """Return the positions of evenly spaced passes that cover an interval; the middle if it is narrower than one.

    Args:
        low, high: The interval across the passes.
        width_m: Width of a pass.
        most_apart_m: Greatest distance from pass to pass, at most the width.
    """
    if high - low <= width_m:
        return np.array([(low + high) / 2.0])
    count = 1 + math.ceil((high - low - width_m) / most_apart_m - 1e-9)
    return np.linspace(low + width_m / 2.0, high - width_m / 2.0, count)


def strips(local: BaseGeometry, width_m: float, most_apart_m: float) -> list[LocalSwath]:
    """Return the swaths that cover a cell.

    The ground between the middle lines of neighbouring passes belongs to one pass. Its swaths are as long as the parts
    of the cell there, so that the full width covers slanted ends.

    Args:
        local: The cell, in the frame of its swaths.
        width_m: Working width.
        most_apart_m: Greatest distance from pass to pass.
    """
    if local.is_empty:
        return []
    west, south, east, north = local.bounds
    at = centres(south, north, width_m, most_apart_m)
    edges = np.concatenate([[south - 1.0], (at[:-1] + at[1:]) / 2.0, [north + 1.0]])
    boxes = [shapely.box(west - 1.0, low, east + 1.0, high) for low, high in itertools.pairwise(edges.tolist())]
    pieces: list[BaseGeometry] = list(shapely.intersection(local, np.array(boxes)))
    found: list[LocalSwath] = []
    before: list[LocalSwath] = []
    runs = 0
    for v, piece in zip(at.tolist(), pieces, strict=True):
        parts = [part for part in shapely.get_parts(piece) if part.area > _NOTHING_M2]
        ends = sorted((part.bounds[0], part.bounds[2]) for part in parts)
        here = []
        for first, last in ends:
            beside = [s for s in before if s.first < last and first < s.last]
            lone = len(beside) == 1 and sum(a < beside[0].last and beside[0].first < b for a, b in ends) == 1
            here.append(LocalSwath(v, first, last, beside[0].run if lone else runs))
            runs += not lone
        found += here
        before = here
    return found


def strip_cost(local: BaseGeometry, width_m: float, most_apart_m: float, turn_m: float) -> float:
    """Return the metres along the swaths of a cell, plus so many metres for each turn."""
    found = strips(local, width_m, most_apart_m)
    return sum(s.last - s.first + turn_m for s in found)


def estimated_cost(ring_edges: Points, bearings_deg: Points, width_m: float, turn_m: float) -> Points:
    """Return the metres, beyond area by width, that swaths of each bearing are expected to need, shape (k,).

    An edge of length L at an angle phi to the swaths is the end of L |sin phi| / width of them, and cuts each of these
    off at a slant, which adds half its width times the cotangent of phi.

    Args:
        ring_edges: Vectors along the edges of the cell, shape (n, 2).
        bearings_deg: Bearings of the swaths, shape (k,).
        width_m: Distance from swath to swath.
        turn_m: Metres that a turn counts for.
    """
    bearing = np.radians(bearings_deg)[:, None]
    along = np.abs(np.sin(bearing) * ring_edges[:, 0] + np.cos(bearing) * ring_edges[:, 1])
    across = np.abs(np.cos(bearing) * ring_edges[:, 0] - np.sin(bearing) * ring_edges[:, 1])
    return np.asarray((along / 2.0 + across * turn_m / (2.0 * width_m)).sum(axis=1))
