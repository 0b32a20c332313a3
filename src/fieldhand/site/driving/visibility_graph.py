"""Visibility graph of ground with obstacles: its corners, and which of its points see each other.

A shortest path in the plane turns only at corners of obstacles, so it is found in the graph of the corners that see
each other (Lozano-Pérez and Wesley 1979).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

from fieldhand.site.driving.free_space import Area
from fieldhand.site.driving.graph import Graph, Indices, Links, Points
from fieldhand.site.driving.row_axes import RowAxes


class VisibilityGraph:
    """The corners of the ground, the graph of those that see each other, and queries for other points.

    Args:
        ground: Ground that paths stay on.
        axes: Lines through obstacles, from end to end, shape (m, 2, 2), which no path crosses.
        barriers: Lines off the ground, as in :class:`Area`.
    """

    def __init__(self, ground: BaseGeometry, axes: Points, barriers: BaseGeometry | None = None) -> None:
        self.area = Area(ground, barriers)
        self._axes = RowAxes(axes)
        self.corners, self._before, self._after = _corners(ground)
        self._located = self._axes.locate(self.corners)
        one, two = self._edges()
        self.graph = Graph(len(self.corners), one, two, np.hypot(*(self.corners[one] - self.corners[two]).T))

    def links(self, at: Points) -> list[Links]:
        """Return the corners at which a path from each of these points can turn first, with the metres to them."""

        def turns(i: Indices, j: Indices) -> NDArray[np.bool_]:
            return self._touched(j, *np.moveaxis(self.corners[j] - at[i], -1, 0))

        i, j = self._seen(at, self.corners, self._axes.unseparated_pairs(self._axes.locate(at), self._located, turns))
        metres = np.hypot(*(at[i] - self.corners[j]).T)
        ends = np.searchsorted(i, np.arange(len(at) + 1)).tolist()
        return [Links(j[a:b], metres[a:b]) for a, b in itertools.pairwise(ends)]

    def pairs(self, one: Points, two: Points | None = None) -> Iterator[tuple[Indices, Indices]]:
        """Yield the indices of all pairs of points that may see each other, in batches: no row nearest to either
        separates them.

        Pairs consist of a point of ``one`` and a point of ``two``; without ``two`` of two points of ``one``, each once.
        """
        return self._axes.unseparated_pairs(self._axes.locate(one), None if two is None else self._axes.locate(two))

    def _edges(self) -> tuple[Indices, Indices]:
        """Return the pairs of corners that see each other and at both of which a path can turn."""
        at = self.corners
        x, y = at.T.copy()

        def turns(i: Indices, j: Indices) -> NDArray[np.bool_]:
            east, north = x[j] - x[i], y[j] - y[i]
            return self._touched(i, east, north) & self._touched(j, east, north)

        return self._seen(at, at, self._axes.unseparated_pairs(self._located, among=turns))

    def _seen(self, one: Points, two: Points, pairs: Iterator[tuple[Indices, Indices]]) -> tuple[Indices, Indices]:
        """Return those of the pairs whose points see each other."""
        none: Indices = np.zeros(0, dtype=np.intp)
        found = [(none, none)]
        for i, j in pairs:
            clear = self.area.clear(one[i], two[j])
            found.append((i[clear], j[clear]))
        i, j = (np.concatenate(part) for part in zip(*found, strict=True))
        return i, j

    def _touched(self, which: Indices, east: Points, north: Points) -> NDArray[np.bool_]:
        """Return a mask of the directions whose line through a corner only touches the obstacle there; shortest paths
        turn only on such lines."""
        # Contiguous coordinates: this is computed for all pairs of corners.
        (b_east, b_north), (a_east, a_north) = self._before[:, which], self._after[:, which]
        before, after = east * b_north - north * b_east, east * a_north - north * a_east
        return np.asarray(before * after <= 1e-9)


def _corners(ground: BaseGeometry) -> tuple[Points, Points, Points]:
    """Return the vertices at which a path can turn, shape (n, 2), and the edges before and after them, shape (2, n).

    A path can turn where the ground takes up more than half a turn.
    """
    found = [np.empty((3, 0, 2))]
    for ring in _rings(ground):
        at = shapely.get_coordinates(ring)[:-1]
        before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
        found.append(np.stack([at, before, after])[:, _cross(before, after) < 0.0])
    at, before, after = np.concatenate(found, axis=1)
    return at, before.T.copy(), after.T.copy()


def _rings(ground: BaseGeometry) -> Iterator[BaseGeometry]:
    """Yield the rings of all areas, with the ground on their left."""
    for part in getattr(ground, "geoms", [ground]):
        if isinstance(part, Polygon) and not part.is_empty:
            turned = orient(part)
            yield turned.exterior
            yield from turned.interiors


def _cross(one: Points, two: Points) -> Points:
    return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
