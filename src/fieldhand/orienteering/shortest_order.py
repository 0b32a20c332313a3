"""The shortest order that visits every vertex: exact for few vertices, iterated local search for more.

Sources: Held and Karp 1962 (dynamic programme over subsets); for the local search see :mod:`kernels.local_search`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError
from fieldhand.orienteering.kernels import local_search

if TYPE_CHECKING:
    from fieldhand.orienteering.kernels.legs import LegLengths

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Lengths: TypeAlias = "Floats | LegLengths"

#: Maximum number of vertices between the ends for which the order is exact.
EXACT = 10
#: Number of vertices from which loading the compiled code (half a second per process) pays off.
COMPILED_FROM = 250
#: Parameters of the local search, tuned on 15 to 3,000 vertices: number of neighbours, and maximum kicks per vertex.
_NEAREST = 9
_KICKS = 20
#: Consecutive kicks without gain after which the search ends, per vertex (plus 30), and the longest segment that a kick
#: swaps.
_EFFORT = (0.5, 50)
_EFFORT_COMPILED = (5.0, 100)
#: Capacity of the undo log of one kick, in flips; 15 are typical.
_FLIPS = 200
_GAIN = 1e-9


def shortest_order(distances: Lengths, start: int, end: int | None = None) -> tuple[int, ...]:
    """Return a short order of all vertices from ``start``; the shortest for up to 12 vertices.

    Args:
        distances: Symmetric distances in any unit, shape (n, n), finite and non-negative; or :class:`LegLengths` for
            the compiled loops.
        start: The first vertex.
        end: The last vertex; None leaves it open.

    Returns:
        Each vertex once, ``start`` first and ``end`` last. Equal arguments give equal orders.

    Raises:
        ProblemError: The distances are not a finite square matrix, or a vertex does not exist.
    """
    n = _vertices(distances)
    if not 0 <= start < n or (end is not None and not 0 <= end < n):
        raise ProblemError(f"start {start} and end {end} must be vertices from 0 to {n - 1}")
    last = local_search.ANYWHERE if end is None or end == start else end
    inner = [v for v in range(n) if v not in (start, last)]
    if len(inner) <= EXACT:
        path = _exact(_table(distances, n), start, last, inner)
    elif n < COMPILED_FROM:
        path = _searched(_table(distances, n), n, [start, *inner, last])
    else:
        path = _searched_compiled(distances, n, [start, *inner, last])
    return tuple(path if last >= 0 else path[:-1])


def _vertices(distances: Lengths) -> int:
    """Return the number of vertices, after checking the distances."""
    if not isinstance(distances, np.ndarray):
        return max(len(distances.matrix), len(distances.xy))
    n = len(distances)
    # The sum reveals any entry that is not finite, without a temporary array of that size.
    if distances.shape != (n, n) or not np.isfinite(distances.sum()) or distances.min(initial=0.0) < 0:
        raise ProblemError("distances must be a square matrix of finite numbers, none below 0")
    return n


def _table(distances: Lengths, n: int) -> Floats:
    """Return all distances with an added row and column for an open end."""
    table = np.zeros((n + 1, n + 1))
    if isinstance(distances, np.ndarray):
        table[:n, :n] = distances
        return table
    from fieldhand.orienteering.kernels.legs import length

    table[:n, :n] = [[length(distances, u, v) for v in range(n)] for u in range(n)]
    return table


def _searched(table: Floats, n: int, path: list[int]) -> list[int]:
    """Return the path after local search in plain Python."""
    size = min(_NEAREST, n - 1)
    held = local_search.SearchState(
        path=path,
        place=[0] * (n + 1),
        near=[0] * (n * size),
        away=[0.0] * (n * size),
        size=size,
        queue=[0] * (n + 1),
        waiting=[0] * (n + 1),
        flips=[0] * (2 * _FLIPS),
        count=[0] * 3,
    )
    ways, (patience, reach) = table.tolist(), _EFFORT
    local_search.neighbours(ways, held, n)
    local_search.begin(ways, held)
    local_search.shorten(ways, held, _KICKS * n, 30 + int(patience * n), reach)
    return path


def _searched_compiled(distances: Lengths, n: int, path: list[int]) -> list[int]:
    """Return the path after local search in compiled code."""
    from fieldhand.orienteering.prepared_problem import NO_LENGTHS

    ways = distances
    if isinstance(ways, np.ndarray):
        ways = NO_LENGTHS._replace(matrix=np.ascontiguousarray(ways, dtype=np.float64))
    size = min(_NEAREST, n - 1)
    held = local_search.SearchState(
        path=np.array(path, np.int64),
        place=np.zeros(n + 1, np.int64),
        near=np.zeros(n * size, np.int64),
        away=np.zeros(n * size),
        size=size,
        queue=np.zeros(n + 1, np.int64),
        waiting=np.zeros(n + 1, np.int64),
        flips=np.zeros(2 * _FLIPS, np.int64),
        count=np.zeros(3, np.int64),
    )
    neighbours, begin, shorten = local_search.for_long_paths()
    patience, reach = _EFFORT_COMPILED
    neighbours(ways, held, n)
    begin(ways, held)
    shorten(ways, held, _KICKS * n, 30 + int(patience * n), reach)
    return [int(v) for v in held.path]


def _exact(d: Floats, start: int, end: int, inner: list[int]) -> list[int]:
    k = len(inner)
    if k == 0:
        return [start, end]
    between = d[np.ix_(inner, inner)]
    cost = np.full((1 << k, k), np.inf)
    before = np.zeros((1 << k, k), dtype=np.intp)
    cost[1 << np.arange(k), np.arange(k)] = d[start, inner]
    for mask in range(1, 1 << k):
        outside = [j for j in range(k) if not mask >> j & 1]
        if not outside:
            continue
        reach = cost[mask][:, None] + between[:, outside]
        last = reach.argmin(axis=0)
        for column, j in enumerate(outside):
            cost[mask | 1 << j, j] = reach[last[column], column]
            before[mask | 1 << j, j] = last[column]
    mask = (1 << k) - 1
    j = int((cost[mask] + d[inner, end]).argmin())
    backwards = []
    while mask:
        backwards.append(inner[j])
        mask, j = mask & ~(1 << j), int(before[mask, j])
    return [start, *reversed(backwards), end]
