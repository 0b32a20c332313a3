"""Distances on a network without a table: each vertex keeps those to a few hubs, any two share one on their way.

What lies between is :mod:`fieldhand.orienteering.kernels.labels`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Neighbours of each vertex that a search looks at.
NEAREST = 24
#: Vertices near each one to which the distance is kept beside the labels: what a search asks for is mostly among them.
CLOSE = 64


@dataclass(frozen=True, kw_only=True, eq=False)
class Labels:
    """Exact shortest distances between vertices, in memory that grows with the hubs that a vertex has.

    :meth:`fieldhand.orienteering.network.Network.labels` makes them.

    Attributes:
        starts: Where each vertex's entries begin, shape (n + 1,), the last entry being their number.
        hubs: Of each entry, ascending within a vertex.
        gaps: Distance from the vertex to that hub.
        near: The nearest vertices of each, nearest first, shape (n, k); the vertex itself where there are no more.
        close, close_gaps: More of them, in the order of their numbers, and the distances to them.
    """

    starts: Ints
    hubs: NDArray[np.int32]
    gaps: Floats
    near: Ints
    close: NDArray[np.int32]
    close_gaps: Floats

    @property
    def size(self) -> int:
        """Number of vertices."""
        return len(self.starts) - 1

    @property
    def nbytes(self) -> int:
        """Memory that they take."""
        parts = (self.starts, self.hubs, self.gaps, self.near, self.close, self.close_gaps)
        return sum(part.nbytes for part in parts)

    def length(self, u: int, v: int) -> float:
        """Distance between two vertices; ``inf`` where there is no way."""
        at, to = (slice(self.starts[x], self.starts[x + 1]) for x in (u, v))
        _, i, j = np.intersect1d(self.hubs[at], self.hubs[to], assume_unique=True, return_indices=True)
        return float(np.min(self.gaps[at][i] + self.gaps[to][j], initial=np.inf))


def labels_of(starts: Ints, heads: NDArray[np.int32], lengths: Floats, wanted: Ints) -> Labels:
    """Labels of some nodes of a network.

    Args:
        starts, heads, lengths: The ways of node u lead to ``heads[starts[u]:starts[u + 1]]``.
        wanted: Nodes, each once; they are the vertices.
    """
    from fieldhand.orienteering.kernels.labels import label, measured, nearest
    from fieldhand.orienteering.kernels.rank import rank

    order = rank(starts, heads, lengths, np.ones(1, dtype=np.uint64))
    ends, hubs, gaps = label(order, starts, heads, lengths, wanted)
    near = np.empty((len(wanted), max(0, min(CLOSE, len(wanted) - 1))), dtype=np.int64)
    nearest(starts, heads, lengths, wanted, near)
    close, close_gaps = np.empty(near.shape, dtype=np.int32), np.empty(near.shape)
    measured(near, np.stack([ends[:-1], ends[1:]], axis=1), hubs, gaps, close, close_gaps)
    near = np.ascontiguousarray(near[:, :NEAREST])
    return Labels(starts=ends, hubs=hubs, gaps=gaps, near=near, close=close, close_gaps=close_gaps)
