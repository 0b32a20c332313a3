"""A sparse drivable graph: junctions and the ways between them; vertices worth a visit are some of its nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.costs import CostModel
from fieldhand.orienteering.problem import Limit, Problem

Floats = NDArray[np.float64]

#: Vertices whose distances to each other are kept: their table is 200 MB then.
MOST = 5_000


@dataclass(frozen=True, kw_only=True, eq=False)
class Network:
    """Ways that can be driven in both directions.

    Attributes:
        nodes: How many there are; numbered from 0.
        ways: Pairs of nodes, shape (m, 2).
        lengths: Of the ways, shape (m,).

    Raises:
        ProblemError: A node that does not exist; a length that is negative or not a number.
    """

    nodes: int
    ways: NDArray[np.int64]
    lengths: Floats

    def __post_init__(self) -> None:
        if self.nodes < 2:
            raise ProblemError(f"{self.nodes} nodes are no network", advice="give a start and an end at least")
        if self.ways.ndim != 2 or self.ways.shape[1] != 2 or self.lengths.shape != (len(self.ways),):
            raise ProblemError(f"ways of shape {self.ways.shape} and {self.lengths.shape[0]} lengths do not fit")
        wrong = ~((self.ways >= 0) & (self.ways < self.nodes)).all(axis=1)
        if wrong.any():
            way = int(wrong.argmax())
            raise ProblemError(f"it joins nodes {self.ways[way].tolist()}, not both there", where=f"way {way}")
        wrong = ~(np.isfinite(self.lengths) & (self.lengths >= 0.0))
        if wrong.any():
            way = int(wrong.argmax())
            raise ProblemError(f"its length is {self.lengths[way]:g}", where=f"way {way}")

    def distances(self, nodes: Sequence[int]) -> Floats:
        """Shortest distances between some nodes, shape (k, k); ``inf`` where there is no way."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import dijkstra

        a, b = self.ways.T
        # Of several ways between two nodes the shortest counts; entries of 0 would mean no way.
        order = np.argsort(-self.lengths, kind="stable")
        shortest = {(int(min(a[i], b[i])), int(max(a[i], b[i]))): float(self.lengths[i]) for i in order}
        pairs = np.array(list(shortest), dtype=np.int64).reshape(-1, 2)
        values = np.maximum(np.array(list(shortest.values())), 1e-12)
        graph = coo_array((values, (pairs[:, 0], pairs[:, 1])), shape=(self.nodes, self.nodes)).tocsr()
        chosen = np.array(nodes, dtype=np.int64)
        found = np.empty((len(chosen), len(chosen)))
        for first in range(0, len(chosen), 256):
            part = chosen[first : first + 256]
            found[first : first + 256] = dijkstra(graph, directed=False, indices=part)[:, chosen]
        return np.minimum(found, found.T)

    def problem(
        self,
        rewards: Floats,
        start: int,
        end: int,
        limits: tuple[Limit, ...],
        costs: CostModel | None = None,
    ) -> tuple[Problem, tuple[int, ...]]:
        """The problem over the nodes that are worth a visit, with the node of each of its vertices.

        Args:
            rewards: Of every node, 0 for a mere junction.
            start, end: Nodes.
            limits: With service for every node, where there is any.
            costs: How legs cost.

        Raises:
            ProblemError: As :class:`Problem`; or more than ``MOST`` nodes are worth a visit.
        """
        if rewards.shape != (self.nodes,):
            raise ProblemError(f"rewards of shape {rewards.shape} do not fit {self.nodes} nodes")
        for name, node in (("start", start), ("end", end)):
            if not 0 <= node < self.nodes:
                raise ProblemError(f"the {name} is node {node}, which is none of 0 to {self.nodes - 1}")
        wanted = ~(rewards == 0.0)
        wanted[[start, end]] = True
        kept = np.flatnonzero(wanted)
        if len(kept) > MOST:
            raise ProblemError(
                f"{len(kept)} nodes are worth a visit, {MOST} can be at most", advice="give coordinates instead"
            )
        at = {int(node): vertex for vertex, node in enumerate(kept)}
        services = [None if x.service is None else x.service[kept] for x in limits]
        made = Problem(
            distances=self.distances(kept.tolist()),
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
