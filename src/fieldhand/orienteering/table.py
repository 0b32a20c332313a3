"""Distances between thousands of vertices of a sparse network, as a table in single precision."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError

if TYPE_CHECKING:
    from scipy.sparse import csr_array

#: Number of neighbours per vertex that a search considers.
NEAREST = 24
#: Maximum number of vertices of a table (1.6 GB).
MOST = 20_000
#: Number of rows computed at once.
_ROWS = 64


@dataclass(frozen=True, kw_only=True, eq=False)
class Table:
    """Shortest distances between vertices, each accurate to one part in 10 million.

    Created by :meth:`fieldhand.orienteering.network.Network.table`.

    Attributes:
        distances: Symmetric, shape (n, n); ``inf`` where there is no way.
        near: The nearest vertices of each vertex, nearest first, shape (n, k); padded with the vertex itself.
    """

    distances: NDArray[np.float32]
    near: NDArray[np.int64]

    @property
    def size(self) -> int:
        """Return the number of vertices."""
        return len(self.distances)


def table_of(graph: csr_array, wanted: NDArray[np.int64]) -> Table:
    """Compute the table of distances between nodes of a graph by Dijkstra's algorithm from each of them.

    Args:
        graph: Lengths of the ways between all nodes.
        wanted: Distinct nodes, which become the vertices.

    Raises:
        ProblemError: The nodes are too many.
    """
    from scipy.sparse.csgraph import dijkstra

    n = len(wanted)
    if n > MOST:
        raise ProblemError(
            f"{n:,} places are more than the {MOST:,} that one choice can be made from",
            advice="name a part of the site: some rows, a block, an area",
        )
    distances, near = np.empty((n, n), dtype=np.float32), np.empty((n, max(0, min(NEAREST, n - 1))), dtype=np.int64)
    for first in range(0, n, _ROWS):
        rows = slice(first, first + _ROWS)
        away = dijkstra(graph, indices=wanted[rows])[:, wanted]
        distances[rows] = away
        near[rows] = _nearest(away, np.arange(n)[rows], near.shape[1])
    # Make the distances exactly symmetric.
    for first in range(0, n, _ROWS):
        rows = slice(first, first + _ROWS)
        lower = np.minimum(distances[rows], distances[:, rows].T)
        distances[rows], distances[:, rows] = lower, lower.T
    return Table(distances=distances, near=near)


def _nearest(away: NDArray[np.float64], own: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Return the nearest vertices of given vertices, nearest first, without the vertex itself.

    Args:
        away: Distances from each vertex to all, shape (m, n).
        own: The vertices, shape (m,).
        count: Number of neighbours to return.
    """
    rows = np.arange(len(away))[:, None]
    away[rows[:, 0], own] = np.inf
    found = np.argpartition(away, count - 1, axis=1)[:, :count] if count else np.empty((len(away), 0), dtype=np.int64)
    found = found[rows, np.argsort(away[rows, found], axis=1, kind="stable")]
    return np.where(np.isfinite(away[rows, found]), found, own[:, None])
