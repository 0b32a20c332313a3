"""A problem as arrays for the compiled loops. The end is a separate node after the vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.costs import slices
from fieldhand.orienteering.kernels.legs import LegLengths
from fieldhand.orienteering.overrun import quantile_table
from fieldhand.orienteering.problem import Problem
from fieldhand.orienteering.table import NEAREST

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_ALL = 400

NO_LENGTHS = LegLengths(
    matrix=np.zeros((0, 0)),
    xy=np.zeros((0, 2)),
    table=np.zeros((0, 0), dtype=np.float32),
    end=0,
)


@dataclass(frozen=True, kw_only=True, eq=False)
class PreparedProblem:
    """Arrays of a problem that do not change during a mission.

    Attributes:
        lengths: Lengths of the legs between nodes: the vertices and the end.
        near: Nearest vertices of each node, nearest first, shape (n + 1, k).
        rewards: Rewards of vertices and end, shape (n + 1,); 0 for the end.
        service: Service cost of each node in each limit, shape (limits, n + 1).
        afterwards: Sums of the lengths, squares and cubes of the legs after the end.
        cumulants: Second and third cumulant of the cost of a leg of length 1.
        points, weights: Distribution of that cost, as :func:`fieldhand.orienteering.kernels.order_value.drive` reads
            it.
        tables: For each limit the standardised quantiles at its failure probability (:func:`quantile_table`).
    """

    problem: Problem
    lengths: LegLengths
    near: Ints
    rewards: Floats
    service: Floats
    afterwards: Floats
    cumulants: Floats
    points: Floats
    weights: Floats
    tables: Floats

    @property
    def size(self) -> int:
        """Return the number of vertices, which is also the number of the end's node."""
        return len(self.rewards) - 1

    def row(self, u: int) -> Floats:
        """Return the lengths from a node to every vertex."""
        lengths = self.lengths
        if len(lengths.matrix):
            return np.asarray(lengths.matrix[u, :-1])
        if len(lengths.xy):
            return np.asarray(np.hypot(*(lengths.xy[:-1] - lengths.xy[u]).T))
        return np.asarray(lengths.table[lengths.end if u == self.size else u], dtype=np.float64)


def prepare_problem(problem: Problem) -> PreparedProblem:
    """Return the arrays of a problem."""
    n, end = problem.size, problem.end
    lengths = _lengths(problem)
    service = np.zeros((len(problem.limits), n + 1))
    for row, limit in zip(service, problem.limits, strict=True):
        if limit.service is not None:
            row[:n] = limit.service
            row[n] = limit.service[end] if end != problem.start else 0.0
    after = np.array(problem.legs_after, dtype=np.float64)
    points, weights = slices(problem.model)
    rewards = np.append(problem.rewards, 0.0).astype(np.float64)
    return PreparedProblem(
        problem=problem,
        lengths=lengths,
        near=_nearest(lengths, problem),
        rewards=rewards,
        service=service,
        afterwards=np.array([after.sum(), (after**2).sum(), (after**3).sum()]),
        cumulants=np.array(problem.model.cumulants()),
        points=points,
        weights=weights,
        tables=np.array([quantile_table(limit.failure_probability) for limit in problem.limits]),
    )


def _lengths(problem: Problem) -> LegLengths:
    nodes = np.append(np.arange(problem.size), problem.end)
    if problem.table is not None:
        return NO_LENGTHS._replace(table=problem.table.distances, end=problem.end)
    if problem.coordinates is not None:
        return NO_LENGTHS._replace(xy=np.ascontiguousarray(problem.coordinates[nodes], dtype=np.float64))
    return NO_LENGTHS._replace(matrix=np.ascontiguousarray(problem.distances[np.ix_(nodes, nodes)], dtype=np.float64))


def _nearest(lengths: LegLengths, problem: Problem) -> Ints:
    """Return the nearest vertices of each node, without the node itself and without the end's node."""
    if problem.table is not None:
        near = problem.table.near
        return np.vstack([near, near[problem.end]])
    matrix, xy = lengths.matrix, lengths.xy
    size = max(len(matrix), len(xy))
    count = min(NEAREST, size - 2)
    if count < 1:
        return np.zeros((size, 0), dtype=np.int64)
    if len(xy) > _ALL:
        from scipy.spatial import cKDTree

        found = np.asarray(cKDTree(xy[:-1]).query(xy, k=count + 1)[1])
        own = found == np.arange(size)[:, None]
        # A vertex that shares its place with others may be missing among its own nearest.
        own[~own.any(axis=1), -1] = True
        return np.ascontiguousarray(found[~own].reshape(size, count), dtype=np.int64)
    if len(xy):
        matrix = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
    away = matrix[:, :-1].copy()
    away[np.arange(size - 1), np.arange(size - 1)] = np.inf
    return np.ascontiguousarray(np.argsort(away, axis=1, kind="stable")[:, :count], dtype=np.int64)
