"""A sparse graph of drivable ways. The vertices of an orienteering problem are a subset of its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import CostModel
from fieldhand.orienteering.problem import Limit, Problem
from fieldhand.orienteering.table import Table, table_of

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Floats = NDArray[np.float64]

#: Maximum number of vertices with distances in double precision.
DOUBLE = 1_000


@dataclass(frozen=True, kw_only=True, eq=False)
class Network:
    """An undirected graph of ways.

    Attributes:
        nodes: Number of nodes, numbered from 0.
        edges: Pairs of nodes, shape (m, 2).
        lengths: Lengths of the edges, shape (m,).

    Raises:
        ProblemError: A node does not exist, or a length is negative or not a number.
    """

    nodes: int
    edges: NDArray[np.int64]
    lengths: Floats

    def __post_init__(self) -> None:
        if self.nodes < 2:
            raise ProblemError(f"{self.nodes} nodes are not a network", advice="give a start and an end at least")
        if self.edges.ndim != 2 or self.edges.shape[1] != 2 or self.lengths.shape != (len(self.edges),):
            raise ProblemError(f"edges of shape {self.edges.shape} and {self.lengths.shape[0]} lengths do not fit")
        wrong = ~((self.edges >= 0) & (self.edges < self.nodes)).all(axis=1)
        if wrong.any():
            way = int(wrong.argmax())
            raise ProblemError(f"it joins nodes {self.edges[way].tolist()}, not both there", where=f"way {way}")
        wrong = ~(np.isfinite(self.lengths) & (self.lengths >= 0.0))
        if wrong.any():
            way = int(wrong.argmax())
            raise ProblemError(f"its length is {self.lengths[way]:g}", where=f"way {way}")

    def distances(self, nodes: Sequence[int]) -> Floats:
        """Return the shortest distances between some nodes, shape (k, k); ``inf`` where there is no way."""
        from scipy.sparse.csgraph import dijkstra

        chosen = np.array(nodes, dtype=np.int64)
        found = np.empty((len(chosen), len(chosen)))
        for first in range(0, len(chosen), 256):
            part = chosen[first : first + 256]
            found[first : first + 256] = dijkstra(self._graph, indices=part)[:, chosen]
        return np.minimum(found, found.T)

    def table(self, nodes: Sequence[int]) -> Table:
        """Return the shortest distances between distinct nodes in single precision.

        Raises:
            ProblemError: The nodes are too many.
        """
        return table_of(self._graph, np.array(nodes, dtype=np.int64))

    @cached_property
    def _graph(self) -> csr_array:
        """Return the edge lengths in both directions as a sparse array."""
        from scipy.sparse import csr_array

        tails, heads = (np.concatenate([self.edges[:, i], self.edges[:, 1 - i]]) for i in range(2))
        lengths = np.concatenate([self.lengths, self.lengths])
        order = np.lexsort((lengths, heads, tails))
        order = order[tails[order] != heads[order]]
        tails, heads = tails[order], heads[order]
        # Of parallel edges the shortest counts.
        other = np.ones(len(order), dtype=bool)
        other[1:] = (np.diff(tails) != 0) | (np.diff(heads) != 0)
        starts = np.zeros(self.nodes + 1, dtype=np.int64)
        np.cumsum(np.bincount(tails[other], minlength=self.nodes), out=starts[1:])
        # A sparse array treats 0 as no edge.
        kept = np.maximum(lengths[order][other].astype(np.float64), 1e-300)
        return csr_array((kept, heads[other].astype(np.int32), starts), shape=(self.nodes, self.nodes))

    def problem(
        self,
        rewards: Floats,
        start: int,
        end: int,
        limits: tuple[Limit, ...],
        costs: CostModel | None = None,
        precision: Literal["double", "single"] | None = None,
    ) -> tuple[Problem, tuple[int, ...]]:
        """Return the problem over the nodes that are worth a visit, with the node of each of its vertices.

        Args:
            rewards: Reward of every node; 0 for a plain junction.
            start, end: Nodes at which routes start and end.
            limits: Limits; service, if any, has one entry per node.
            costs: Cost model of the legs.
            precision: Precision of the distances; None for double up to ``DOUBLE`` vertices, single beyond.

        Raises:
            ProblemError: As :class:`Problem`.
        """
        if rewards.shape != (self.nodes,):
            raise ProblemError(f"rewards of shape {rewards.shape} do not fit {self.nodes} nodes")
        for name, node in (("start", start), ("end", end)):
            if not 0 <= node < self.nodes:
                raise ProblemError(f"the {name} is node {node}, which is not in 0 to {self.nodes - 1}")
        wanted = ~(rewards == 0.0)
        wanted[[start, end]] = True
        kept = np.flatnonzero(wanted)
        double = len(kept) <= DOUBLE if precision is None else precision == "double"
        at = {int(node): vertex for vertex, node in enumerate(kept)}
        services = [None if x.service is None else x.service[kept] for x in limits]
        made = Problem(
            distances=self.distances(kept.tolist()) if double else np.zeros((0, 0)),
            table=None if double else self.table(kept.tolist()),
            rewards=rewards[kept],
            start=at[start],
            end=at[end],
            limits=tuple(
                Limit(budget=x.budget, failure_probability=x.failure_probability, service=service)
                for x, service in zip(limits, services, strict=True)
            ),
            costs=costs,
        )
        return made, tuple(int(node) for node in kept)
