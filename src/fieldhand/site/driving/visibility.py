"""Shortest ways over ground with obstacles: its corners, and which points of it see each other.

The shortest way in the plane turns only at corners of what is in the way, so it is found in the graph of corners that
see each other (a visibility graph: Lozano-Pérez and Wesley 1979).
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

from fieldhand.site.driving.free import Area
from fieldhand.site.driving.graph import Graph, Indices, Links, Points

#: Of a point so many of the nearest rows are looked at before the ground's whole edge is.
_NEAREST = 8

#: So many points beside one row are first looked at as one.
_TOGETHER = 6

#: Of either end of a line through an obstacle this much is left out.
_ENDS_M = 1e-3

#: Pairs of points that are worked on together: bounds the memory.
_BATCH = 200_000


class Visibility:
    """The corners of a ground, the graph of those that see each other, and what other points see.

    Args:
        ground: On which ways keep to.
        axes: Lines through obstacles, from end to end, shape (m, 2, 2): no way crosses one. Among rows most pairs of
            points are parted by one of the nearest, which is many times cheaper to see than whether a line lies on
            the ground.
    """

    def __init__(self, ground: BaseGeometry, axes: Points) -> None:
        self.area = Area(ground)
        along = axes[:, 1] - axes[:, 0]
        length = np.hypot(*along.T)
        self._along = along / length[:, None]
        # Ways along the end of an obstacle only touch the end of its line.
        self._start = axes[:, 0] + _ENDS_M * self._along
        self._length = length - 2.0 * _ENDS_M
        self.corners, self._before, self._after = _corners(ground)
        one, two = self._edges()
        self.graph = Graph(len(self.corners), one, two, np.hypot(*(self.corners[one] - self.corners[two]).T))

    def links(self, at: Points) -> list[Links]:
        """Return the corners at which a way from each of these points can turn first, with the metres to there."""
        none: Indices = np.zeros(0, dtype=np.intp)
        found = [(none, none)]
        for i, j in self.pairs(at, self.corners):
            i, j = _where(self._touched(j, at[i] - self.corners[j]), i, j)
            found.append(_where(self.area.sees(at[i], self.corners[j]), i, j))
        i, j = (np.concatenate(part) for part in zip(*found, strict=True))
        order = np.lexsort((j, i))
        i, j = i[order], j[order]
        metres = np.hypot(*(at[i] - self.corners[j]).T)
        ends = np.searchsorted(i, np.arange(len(at) + 1)).tolist()
        return [Links(j[a:b], metres[a:b]) for a, b in itertools.pairwise(ends)]

    def pairs(self, one: Points, two: Points | None = None) -> Iterator[tuple[Indices, Indices]]:
        """Yield, in batches, the positions of all pairs of a point of ``one`` and one of ``two`` that may see each
        other: none of the rows nearest to the first parts them. Without ``two`` pairs within ``one``, each once.
        """
        to = one if two is None else two
        for which, axes in self._groups(one):
            there = np.arange(len(to))
            if len(which) >= _TOGETHER and len(axes):
                there = there[~self._parted(_box(one[which], self._along[axes[0]]), to, axes).any(axis=0)]
            step = max(_BATCH // max(len(there), 1), 1)
            for first in range(0, len(which), step):
                some = which[first : first + step]
                clear = np.ones((len(some), len(there)), dtype=bool)
                for parted in self._each_parted(one[some], to[there], axes):
                    clear &= ~parted
                i, j = np.nonzero(clear)
                i, j = some[i], there[j]
                yield (i, j) if two is not None else _where(i < j, i, j)

    def _groups(self, at: Points) -> Iterator[tuple[Indices, Indices]]:
        """Yield points that are nearest to the same row on the same side, and the rows nearest to the first of them."""
        if not len(self._length) or not len(at):
            if len(at):
                yield np.arange(len(at)), np.zeros(0, dtype=np.intp)
            return
        count = min(_NEAREST, len(self._length))
        nearest = np.empty((len(at), count), dtype=np.intp)
        side = np.empty(len(at), dtype=bool)
        step = max(_BATCH // len(self._length), 1)
        for first in range(0, len(at), step):
            some = slice(first, first + step)
            off, along = self._seen_from(at[some], slice(None))
            away = np.hypot(off, along - np.clip(along, 0.0, self._length[:, None])).T
            near = np.argpartition(away, count - 1, axis=1)[:, :count]
            order = np.argsort(np.take_along_axis(away, near, axis=1), axis=1, kind="stable")
            nearest[some] = np.take_along_axis(near, order, axis=1)
            side[some] = off[nearest[some, 0], np.arange(len(near))] > 0.0
        order = np.argsort(2 * nearest[:, 0] + side, kind="stable")
        keys = (2 * nearest[:, 0] + side)[order]
        for which in np.split(order, np.flatnonzero(np.diff(keys)) + 1):
            yield which, nearest[which[len(which) // 2]]

    def _parted(self, box: Points, two: Points, axes: Indices) -> NDArray[np.bool_]:
        """Return which rows part each point of ``two`` from all of a box, given by its corners; shape (k, n)."""
        return np.array([parted.all(axis=0) for parted in self._each_parted(box, two, axes)]).reshape(-1, len(two))

    def _each_parted(self, one: Points, two: Points, axes: Indices) -> Iterator[NDArray[np.bool_]]:
        """Yield for each row which pairs it parts, shape (n, m)."""
        off_one, along_one = self._seen_from(one, axes)
        off_two, along_two = self._seen_from(two, axes)
        for a, u, b, v, length in zip(off_one, along_one, off_two, along_two, self._length[axes].tolist(), strict=True):
            far_a, far_b = np.abs(a)[:, None], np.abs(b)
            # Where the line between the two crosses that of the row, times the sum of their distances from it.
            crossing = u[:, None] * far_b + v * far_a
            yield ((a > 0.0)[:, None] != (b > 0.0)) & (crossing > 0.0) & (crossing < length * (far_a + far_b))

    def _seen_from(self, at: Points, axes: Indices | slice) -> tuple[Points, Points]:
        """Return the metres of each point to the left of each row, and along it from its start; shape (rows, n)."""
        x, y = (at[None, :, k] - self._start[axes][:, None, k] for k in (0, 1))
        ex, ey = self._along[axes][:, 0, None], self._along[axes][:, 1, None]
        return ex * y - ey * x, ex * x + ey * y

    def _edges(self) -> tuple[Indices, Indices]:
        """Return the pairs of corners that see each other and at both of which a way can turn."""
        at, n = self.corners, max(len(self.corners), 1)
        keys: list[Indices] = [np.zeros(0, dtype=np.intp)]
        for i, j in self.pairs(at, at):
            i, j = _where(self._touched(i, at[j] - at[i]), i, j)
            i, j = _where(self._touched(j, at[i] - at[j]), i, j)
            keys.append(np.minimum(i, j) * n + np.maximum(i, j))
        found, times = np.unique(np.concatenate(keys), return_counts=True)
        one, two = np.divmod(found[times == 2], n)  # parted by no row near to either
        one, two = _where(self.area.sees(at[one], at[two]), one, two)
        return one, two

    def _touched(self, which: Indices, towards: Points) -> NDArray[np.bool_]:
        """Return where a line from a corner in this direction only touches the obstacle there: a shortest way has no
        other lines at its turns."""
        before, after = -self._before[which], self._after[which]
        return np.asarray(_cross(towards, before) * _cross(towards, after) >= -1e-9)


def _where(kept: NDArray[np.bool_], one: Indices, two: Indices) -> tuple[Indices, Indices]:
    return one[kept], two[kept]


def _box(at: Points, along: Points) -> Points:
    """Return the corners of a rectangle with a side of this direction, that holds all the points; shape (4, 2)."""
    across = np.array([-along[1], along[0]])
    u, v = at @ along, at @ across
    return np.array([p * along + q * across for p in (u.min(), u.max()) for q in (v.min(), v.max())])


def _corners(ground: BaseGeometry) -> tuple[Points, Points, Points]:
    """Return the vertices at which a way can turn, and the edges that meet there: the ground takes more than half a
    turn there. Shape (n, 2) each."""
    found = [np.empty((3, 0, 2))]
    for ring in _rings(ground):
        at = shapely.get_coordinates(ring)[:-1]
        before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
        found.append(np.stack([at, before, after])[:, _cross(before, after) < 0.0])
    at, before, after = np.concatenate(found, axis=1)
    return at, before, after


def _rings(ground: BaseGeometry) -> Iterator[BaseGeometry]:
    """Yield the rings of all areas, the ground on their left."""
    for part in getattr(ground, "geoms", [ground]):
        if isinstance(part, Polygon) and not part.is_empty:
            turned = orient(part)
            yield turned.exterior
            yield from turned.interiors


def _cross(one: Points, two: Points) -> Points:
    return np.asarray(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
