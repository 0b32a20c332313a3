"""Shortest paths over a sparse graph, from any number of places outside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from heapq import heappop, heappush
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

Points = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Searches times edges for which a graph is searched in Python, at about 0.4 µs each. After that it is searched with
#: scipy, which is faster but whose import takes 0.4 s.
_FEW_EDGES = 50_000

#: Least length of an edge in metres: corners may coincide, and a sparse matrix drops zeros.
_SHORTEST_M = 1e-9

#: Rows and columns of a matrix processed together.
_BLOCK = 1024

#: Numbers processed together: few enough for the processor's cache.
_CACHED = 200_000


@dataclass(frozen=True, eq=False)
class Links:
    """The nodes that a place reaches directly, and the metres to each."""

    nodes: Indices
    metres: Points

    @staticmethod
    def none() -> Links:
        """Return the links of a place that reaches nothing."""
        return Links(np.zeros(0, dtype=np.intp), np.zeros(0))


@dataclass(frozen=True, eq=False)
class ShortestWays:
    """Metres from each place to every node, shape (p, n), and the preceding node on that path (-1: the place)."""

    metres: Points
    before: NDArray[np.int32]


class Graph:
    """An undirected graph.

    Args:
        count: Number of nodes.
        one, two: End nodes of each edge.
        metres: Length of each edge; of parallel edges the shorter counts.
    """

    def __init__(self, count: int, one: Indices, two: Indices, metres: Points) -> None:
        self.count = count
        ends = np.concatenate([one, two]) * max(count, 1) + np.concatenate([two, one])
        length = np.maximum(np.concatenate([metres, metres]), _SHORTEST_M)
        order = np.lexsort((length, ends))
        ends, first = np.unique(ends[order], return_index=True)
        self._head, self._tail = np.divmod(ends, max(count, 1))
        self._length = length[order][first]
        self._searched = 0

    def ways(self, first: int) -> tuple[Indices, Indices, Points]:
        """Return the end nodes and the length of each edge, once per edge; nodes are numbered from ``first``."""
        once = self._head < self._tail
        return self._head[once] + first, self._tail[once] + first, self._length[once]

    @cached_property
    def _matrix(self) -> csr_matrix:
        from scipy.sparse import csr_matrix

        return csr_matrix((self._length, (self._head, self._tail)), shape=(self.count, self.count))

    def lengths(self, rows: Sequence[Links], columns: Sequence[Links] | None = None) -> Points:
        """Return the lengths in metres of the shortest paths over nodes between two sets of places, shape (p, q); inf
        if there is no path. Without ``columns``, both sets are ``rows``."""
        if self.count == 0 or not rows:
            return np.full((len(rows), len(rows if columns is None else columns)), np.inf)
        nodes = np.unique(np.concatenate([a.nodes for a in rows]))
        if len(nodes) < len(rows):  # searching from the nodes is then faster than from the places
            row_of = np.full(self.count, -1)
            row_of[nodes] = np.arange(len(nodes))
            links = [Links(row_of[a.nodes], a.metres) for a in rows]
            metres = between(self._from_nodes(nodes).T, links).T
        else:
            metres = self.rows(rows).metres
        found = between(np.ascontiguousarray(metres), rows if columns is None else columns)
        if columns is None:
            _make_symmetric(found)
        return found

    def rows(self, places: Sequence[Links]) -> ShortestWays:
        """Return the shortest paths from places outside the graph; inf if there is none."""
        n, p = self.count, len(places)
        if n == 0 or p == 0:
            return ShortestWays(np.zeros((p, n)), np.zeros((p, n), dtype=np.int32))
        if self._searches_few(p):
            found = [self._search(Links(a.nodes, np.maximum(a.metres, _SHORTEST_M))) for a in places]
            steps = np.array([before for _, before in found], dtype=np.int32)
            return ShortestWays(np.array([metres for metres, _ in found]), steps)
        from scipy.sparse import csr_matrix
        from scipy.sparse.csgraph import dijkstra

        own = np.cumsum([len(a.nodes) for a in places])
        first = np.concatenate([self._matrix.indptr, self._matrix.indptr[-1] + own]).astype(np.int32)
        tails = np.concatenate([self._matrix.indices, *(a.nodes.astype(np.int32) for a in places)])
        lengths = np.concatenate([self._matrix.data, *(np.maximum(a.metres, _SHORTEST_M) for a in places)])
        matrix = csr_matrix((lengths, tails, first), shape=(n + p, n + p))
        metres, before = dijkstra(matrix, directed=True, indices=np.arange(n, n + p), return_predecessors=True)
        before = np.where(before >= n, -1, before)
        return ShortestWays(np.ascontiguousarray(metres[:, :n]), np.ascontiguousarray(before[:, :n], dtype=np.int32))

    def _from_nodes(self, nodes: Indices) -> Points:
        """Return the lengths of the shortest paths from some nodes to all, shape (k, n)."""
        if self._searches_few(len(nodes)):
            return np.array([self._search(Links(nodes[k : k + 1], np.zeros(1)))[0] for k in range(len(nodes))])
        from scipy.sparse.csgraph import dijkstra

        return np.asarray(dijkstra(self._matrix, indices=nodes))

    def _searches_few(self, searches: int) -> bool:
        """Return True if the graph is small enough, and was searched seldom enough, to search it in Python."""
        self._searched += searches * len(self._length)
        return self._searched <= _FEW_EDGES

    def _search(self, place: Links) -> tuple[list[float], list[int]]:
        """Return the metres from a place to every node, and the node before it, by Dijkstra's algorithm."""
        metres, before = [math.inf] * self.count, [-1] * self.count
        queue: list[tuple[float, int]] = []
        for node, away in zip(place.nodes.tolist(), place.metres.tolist(), strict=True):
            metres[node] = min(away, metres[node])
            heappush(queue, (away, node))
        while queue:
            reached, node = heappop(queue)
            if reached > metres[node]:
                continue
            for other, length in self._edges_from[node]:
                if (further := reached + length) < metres[other]:
                    metres[other], before[other] = further, node
                    heappush(queue, (further, other))
        return metres, before

    @cached_property
    def _edges_from(self) -> list[list[tuple[int, float]]]:
        """Return the ends and lengths of the edges from each node."""
        found: list[list[tuple[int, float]]] = [[] for _ in range(self.count)]
        for head, tail, length in zip(self._head.tolist(), self._tail.tolist(), self._length.tolist(), strict=True):
            found[head].append((tail, length))
        return found


def between(rows: Points, links: Sequence[Links]) -> Points:
    """Return the lengths in metres from each place of the rows to each place of the links over nodes, shape (p, q); inf
    if there is no path."""
    found = np.full((len(rows), len(links)), np.inf)
    widths = np.array([len(a.nodes) for a in links], dtype=np.intp)
    most_first = np.argsort(-widths, kind="stable")
    # For each k, the k-th link of every place that has one.
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
    """Set both directions to the shorter one, block by block to bound the memory."""
    for first in range(0, len(metres), _BLOCK):
        for second in range(0, first + 1, _BLOCK):
            one = metres[first : first + _BLOCK, second : second + _BLOCK]
            two = metres[second : second + _BLOCK, first : first + _BLOCK]
            np.minimum(one, two.T.copy(), out=one)
            two[:] = one.T


def chain(rows: ShortestWays, place: int, node: int) -> list[int]:
    """Return the nodes on the path from a place of the rows to a node, ending with that node."""
    nodes = [node]
    while (node := int(rows.before[place, node])) >= 0:
        nodes.append(node)
    return nodes[::-1]
