"""Shortest ways over a sparse graph, from any number of places that are not in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

Points = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Two corners may coincide; an edge of no length would be none.
_SHORTEST_M = 1e-9

#: Rows and columns of a table that are worked on together.
_BLOCK = 1024

#: Numbers that are worked on together: few enough for the processor's cache.
_CACHED = 200_000


@dataclass(frozen=True, eq=False)
class Links:
    """Which nodes a place reaches by itself, and the metres to each."""

    nodes: Indices
    metres: Points

    @staticmethod
    def none() -> Links:
        """Of a place that reaches nothing."""
        return Links(np.zeros(0, dtype=np.intp), np.zeros(0))


@dataclass(frozen=True, eq=False)
class ShortestWays:
    """Metres from each of some places to every node, shape (p, n), and the node before on that way (-1: the place)."""

    metres: Points
    before: NDArray[np.int32]


class Graph:
    """Nodes that are joined both ways.

    Args:
        count: Of nodes.
        one, two: Nodes that each edge joins.
        metres: Of each edge; of two edges between the same nodes the shorter counts.
    """

    def __init__(self, count: int, one: Indices, two: Indices, metres: Points) -> None:
        self.count = count
        ends = np.concatenate([one, two]) * max(count, 1) + np.concatenate([two, one])
        length = np.maximum(np.concatenate([metres, metres]), _SHORTEST_M)
        order = np.lexsort((length, ends))
        ends, first = np.unique(ends[order], return_index=True)
        self._head, self._tail = np.divmod(ends, max(count, 1))
        self._length = length[order][first]

    def ways(self, first: int) -> tuple[Indices, Indices, Points]:
        """Each pair of nodes that an edge joins, once, and its metres; nodes counted on from ``first``."""
        once = self._head < self._tail
        return self._head[once] + first, self._tail[once] + first, self._length[once]

    @cached_property
    def _matrix(self) -> csr_matrix:
        return csr_matrix((self._length, (self._head, self._tail)), shape=(self.count, self.count))

    def lengths(self, rows: Sequence[Links], columns: Sequence[Links] | None = None) -> Points:
        """Metres of the shortest ways by nodes from each of these places to each of those (the same if none are given),
        shape (p, q); inf where there is none."""
        if self.count == 0 or not rows:
            return np.full((len(rows), len(rows if columns is None else columns)), np.inf)
        nodes = np.unique(np.concatenate([a.nodes for a in rows]))
        if len(nodes) < len(rows):  # then rather from the nodes than from the places
            row_of = np.full(self.count, -1)
            row_of[nodes] = np.arange(len(nodes))
            links = [Links(row_of[a.nodes], a.metres) for a in rows]
            metres = between(np.asarray(dijkstra(self._matrix, indices=nodes)).T, links).T
        else:
            metres = self.rows(rows).metres
        found = between(np.ascontiguousarray(metres), rows if columns is None else columns)
        if columns is None:
            _make_symmetric(found)
        return found

    def rows(self, places: Sequence[Links]) -> ShortestWays:
        """Shortest ways from places outside the graph; inf where there is none."""
        n, p = self.count, len(places)
        if n == 0 or p == 0:
            return ShortestWays(np.zeros((p, n)), np.zeros((p, n), dtype=np.int32))
        own = np.cumsum([len(a.nodes) for a in places])
        starts = np.concatenate([self._matrix.indptr, self._matrix.indptr[-1] + own]).astype(np.int32)
        tails = np.concatenate([self._matrix.indices, *(a.nodes.astype(np.int32) for a in places)])
        lengths = np.concatenate([self._matrix.data, *(np.maximum(a.metres, _SHORTEST_M) for a in places)])
        matrix = csr_matrix((lengths, tails, starts), shape=(n + p, n + p))
        metres, before = dijkstra(matrix, directed=True, indices=np.arange(n, n + p), return_predecessors=True)
        before = np.where(before >= n, -1, before)
        return ShortestWays(np.ascontiguousarray(metres[:, :n]), np.ascontiguousarray(before[:, :n], dtype=np.int32))


def between(rows: Points, links: Sequence[Links]) -> Points:
    """Metres from each place of the rows to each place of the links by way of nodes, shape (p, q); inf: no way."""
    found = np.full((len(rows), len(links)), np.inf)
    widths = np.array([len(a.nodes) for a in links], dtype=np.intp)
    most_first = np.argsort(-widths, kind="stable")
    # The k-th links of all places that have as many, one k after the other.
    ranked = [most_first[: int((widths > k).sum())].tolist() for k in range(int(widths.max(initial=0)))]
    nodes = [np.array([links[j].nodes[k] for j in which]) for k, which in enumerate(ranked)]
    walked = [np.array([links[j].metres[k] for j in which]) for k, which in enumerate(ranked)]
    step = max(_CACHED // max(len(links), 1), 1)
    for first in range(0, len(rows), step):
        some = rows[first : first + step]
        best = np.full((len(some), len(links)), np.inf)
        for at, metres in zip(nodes, walked, strict=True):
            part = best[:, : len(at)]
            np.minimum(part, np.take(some, at, axis=1) + metres, out=part)
        found[first : first + step, most_first] = best
    return found


def _make_symmetric(metres: Points) -> None:
    """Of either direction the shorter, block by block to keep the memory small."""
    for first in range(0, len(metres), _BLOCK):
        for second in range(0, first + 1, _BLOCK):
            one = metres[first : first + _BLOCK, second : second + _BLOCK]
            two = metres[second : second + _BLOCK, first : first + _BLOCK]
            np.minimum(one, two.T.copy(), out=one)
            two[:] = one.T


def chain(rows: ShortestWays, place: int, node: int) -> list[int]:
    """The nodes on the way from a place of the rows to this node, which is the last of them."""
    nodes = [node]
    while (node := int(rows.before[place, node])) >= 0:
        nodes.append(node)
    return nodes[::-1]
