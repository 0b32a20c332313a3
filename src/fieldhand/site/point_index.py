"""Nearest points, and points close to each other, in the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Pairs of points compared directly by one index before it builds a k-d tree. The import of scipy.spatial takes half a
#: second, as long as 30 million comparisons; but once it is imported, a tree is faster from a hundred points on.
_FEW_PAIRS = 250_000

#: Least limit in metres whose square is not 0.
_LEAST_M = 1e-150


class PointIndex:
    """Points in the plane, to be searched for the nearest ones and for pairs close to each other.

    A few points are compared directly, many by means of a k-d tree. Both return the same distances; which of several
    equally distant points they return may differ.

    Attributes:
        points: The points in metres, shape (n, 2).
    """

    def __init__(self, points: Floats) -> None:
        self.points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        self._compared = 0
        self._tree: cKDTree | None = None

    def nearest(self, to: Floats, *, within: float = np.inf) -> tuple[Floats, Indices]:
        """Return for each point of ``to`` the distance to the nearest point and its index, both of shape (m,).

        Args:
            to: Points in metres, shape (m, 2).
            within: If the nearest point is not closer than this, the distance returned is infinite and the index n.
        """
        if (tree := self._tree_for(len(to))) is not None:
            # The tree compares squares, which are 0 for the smallest limits.
            away, which = tree.query(to, distance_upper_bound=max(within, _LEAST_M) if within > 0 else within)
            return np.asarray(away), np.asarray(which)
        if not len(self.points):
            return np.full(len(to), np.inf), np.zeros(len(to), dtype=np.intp)
        squares = self._squares(to)
        which = np.argmin(squares, axis=1)
        closest = np.sqrt(squares[np.arange(len(to)), which])
        far = closest >= within
        return np.where(far, np.inf, closest), np.where(far, len(self.points), which)

    def nearest_few(self, to: Floats, count: int) -> tuple[Floats, Indices]:
        """Return for each point of ``to`` the distances to the nearest points, ascending, and their indices.

        Args:
            to: Points in metres, shape (m, 2).
            count: Number of points wanted, at least 1; all points if there are fewer.

        Returns:
            Two arrays of shape (m, min(count, n)).
        """
        count = min(count, len(self.points))
        if (tree := self._tree_for(len(to))) is not None:
            away, which = tree.query(to, k=range(1, count + 1))
            return np.asarray(away), np.asarray(which)
        squares = self._squares(to)
        which = np.argpartition(squares, count - 1, axis=1)[:, :count]
        nearest = np.take_along_axis(squares, which, axis=1)
        order = np.lexsort((which, nearest), axis=1)
        return np.sqrt(np.take_along_axis(nearest, order, axis=1)), np.take_along_axis(which, order, axis=1)

    def pairs(self, within: float, *, each_axis: bool = False) -> Indices:
        """Return the pairs of points at most ``within`` apart, shape (p, 2), the lower index first.

        Args:
            within: Greatest distance in metres.
            each_axis: The larger of the distances along the two axes is at most ``within``, instead of the distance.
        """
        if (tree := self._tree_for(len(self.points))) is not None:
            return tree.query_pairs(within, p=np.inf if each_axis else 2.0, output_type="ndarray")
        return np.argwhere(np.triu(self._are_close(self.points, within, each_axis=each_axis), k=1))

    def close_to(self, to: Floats, within: float, *, each_axis: bool = False) -> Indices:
        """Return the pairs of a point of ``to`` and a point at most ``within`` apart, shape (p, 2), in order of ``to``.

        Args:
            to: Points in metres, shape (m, 2).
            within, each_axis: As for :meth:`pairs`.
        """
        if (tree := self._tree_for(len(to))) is not None:
            found: list[list[int]] = list(tree.query_ball_point(to, within, p=np.inf if each_axis else 2.0))  # type: ignore[arg-type]
            first = np.repeat(np.arange(len(to)), [len(some) for some in found])
            return np.column_stack([first, np.array([k for some in found for k in some], dtype=np.intp)])
        return np.argwhere(self._are_close(to, within, each_axis=each_axis))

    def _are_close(self, to: Floats, within: float, *, each_axis: bool) -> NDArray[np.bool_]:
        """Return which points are at most ``within`` from each point of ``to``, shape (m, n)."""
        if each_axis:
            return np.asarray((np.abs(to[:, None] - self.points) <= within).all(axis=2))
        return np.asarray(np.sqrt(self._squares(to)) <= within)

    def _squares(self, to: Floats) -> Floats:
        """Return the squared distance from each point of ``to`` to each point, shape (m, n)."""
        east, north = (np.subtract.outer(to[:, k], self.points[:, k]) for k in (0, 1))
        east *= east
        north *= north
        east += north
        return np.asarray(east)

    def _tree_for(self, count: int) -> cKDTree | None:
        """Return the k-d tree once it is worth building for ``count`` further points; None before."""
        self._compared += len(self.points) * count
        if self._tree is None and self._compared > _FEW_PAIRS:
            from scipy.spatial import cKDTree

            # Sliding midpoints are quicker to build than medians, and to search as long as points are spread evenly.
            self._tree = cKDTree(self.points, balanced_tree=False, compact_nodes=False)
        return self._tree
