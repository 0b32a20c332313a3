"""How far the rows of a block reach, as a line with few corners."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.intp]


def reach(
    ends: Points, rows: Indices, depth_m: float, free: Callable[[Points], bool], most: int = 24
) -> tuple[Points, Points]:
    """A line over the ends of the rows: nowhere below one, with few corners.

    It is the upper convex hull of the ends. Where that leaves a notch of several rows deeper than ``depth_m``, or would
    run over ground that is not free, it dips in to the deepest end and is the hull on either side again.

    Args:
        ends: (v, u) of each, in the order of v, shape (n, 2).
        rows: Which row each belongs to; a single row is never a notch of its own.
        depth_m: Of a notch that is closed; doubled until the line has at most ``most`` corners for its depth alone.
        free: Whether a straight line, given as (v, u) of its ends, shape (2, 2), runs over free ground.
        most: Corners.

    Returns:
        v and u of the corners, in the order of v.
    """
    known: dict[tuple[int, int], bool] = {}

    def is_free(one: int, two: int) -> bool:
        if (one, two) not in known:
            known[one, two] = free(ends[[one, two]])
        return known[one, two]

    while True:
        corners = _corners(ends, rows, depth_m, is_free)
        if len(corners) <= most or depth_m > np.ptp(ends[:, 1]):
            return ends[corners, 0], ends[corners, 1]
        depth_m *= 2.0


def _corners(ends: Points, rows: Indices, depth_m: float, free: Callable[[int, int], bool]) -> list[int]:
    """Positions of the ends that are corners."""
    open_ = [(a, b) for a, b in itertools.pairwise(_upper_hull(ends, 0, len(ends) - 1))][::-1]
    corners = [0]
    while open_:
        one, two = open_.pop()
        inner = np.arange(one + 1, two)
        if len(inner):
            depth = np.interp(ends[inner, 0], ends[[one, two], 0], ends[[one, two], 1]) - ends[inner, 1]
            deepest = int(inner[np.argmax(depth)])
            wide = len(set(rows[inner].tolist()) - {int(rows[one]), int(rows[two])}) > 1
            if (wide and depth.max() > depth_m) or not free(one, two):
                right = list(itertools.pairwise(_upper_hull(ends, deepest, two)))
                left = list(itertools.pairwise(_upper_hull(ends, one, deepest)))
                open_ += [*right[::-1], *left[::-1]]
                continue
        corners.append(two)
    return corners


def _upper_hull(ends: Points, first: int, last: int) -> list[int]:
    """Positions of the upper convex hull's corners, from the first end to the last."""
    hull: list[int] = []
    for k in range(first, last + 1):
        while len(hull) > 1:
            (x0, y0), (x1, y1), (x2, y2) = ends[hull[-2]], ends[hull[-1]], ends[k]
            if (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0) < 0.0:
                break
            hull.pop()
        hull.append(k)
    return hull
