"""Shortest ways over a sparse graph, from any number of places that are not in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

Points = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Two doors may coincide; an edge of no length would be none.
_SHORTEST_M = 1e-9


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
class Rows:
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

    @cached_property
    def parts(self) -> Indices:
        """For each node which part of the graph it is in, counted from 0: there is no way from one part to another."""
        matrix = csr_matrix((self._length, (self._head, self._tail)), shape=(self.count, self.count))
        return np.asarray(connected_components(matrix, directed=False)[1], dtype=np.intp)

    def rows(self, places: Sequence[Links]) -> Rows:
        """Shortest ways from places outside the graph; inf where there is none."""
        n, p = self.count, len(places)
        if n == 0 or p == 0:
            return Rows(np.zeros((p, n)), np.zeros((p, n), dtype=np.int32))
        counts = np.concatenate([np.bincount(self._head, minlength=n), [len(a.nodes) for a in places]])
        tails = np.concatenate([self._tail, *(a.nodes for a in places)])
        lengths = np.concatenate([self._length, *(np.maximum(a.metres, _SHORTEST_M) for a in places)])
        starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
        matrix = csr_matrix((lengths, tails.astype(np.int32), starts), shape=(n + p, n + p))
        metres, before = dijkstra(matrix, directed=True, indices=np.arange(n, n + p), return_predecessors=True)
        before = np.where(before >= n, -1, before)
        return Rows(np.ascontiguousarray(metres[:, :n]), np.ascontiguousarray(before[:, :n], dtype=np.int32))


def between(rows: Points, links: Sequence[Links]) -> Points:
    """Metres from each place of the rows to each place of the links by way of nodes, shape (p, q); inf: no way."""
    found = np.full((len(rows), len(links)), np.inf)
    for width in {len(b.nodes) for b in links} - {0}:
        which = [j for j, b in enumerate(links) if len(b.nodes) == width]
        nodes = np.array([links[j].nodes for j in which])
        metres = np.array([links[j].metres for j in which])
        if width <= 4:  # all of them at once
            found[:, which] = (rows[:, nodes] + metres).min(axis=2)
        else:
            for j, at, walked in zip(which, nodes, metres, strict=True):
                found[:, j] = (rows[:, at] + walked).min(axis=1)
    return found


def chain(rows: Rows, place: int, node: int) -> list[int]:
    """The nodes on the way from a place of the rows to this node, which is the last of them."""
    nodes = [node]
    while (node := int(rows.before[place, node])) >= 0:
        nodes.append(node)
    return nodes[::-1]
