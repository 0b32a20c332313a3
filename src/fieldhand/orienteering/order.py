"""The shortest way to visit every vertex: exact for a few, 2-opt and or-opt for hundreds.

Sources: Held and Karp 1962 (dynamic programme over subsets); Croes 1958 (2-opt); Or 1976 (moving short segments).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.errors import ProblemError

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

#: Up to so many vertices between the ends the order is exact.
EXACT = 10
_GAIN = 1e-9
_MAX_PASSES = 60


def shortest_order(distances: Floats, start: int, end: int | None = None) -> tuple[int, ...]:
    """An order of all vertices that begins at ``start`` and drives little; the least possible for up to 12 vertices.

    Args:
        distances: Symmetric, shape (n, n), none of them negative or infinite.
        start: The first vertex.
        end: The last vertex; None leaves it open.

    Returns:
        Each vertex once, ``start`` first and ``end`` last. The same for the same arguments.

    Raises:
        ProblemError: Distances that are no finite square matrix, or a vertex that does not exist.
    """
    n = len(distances)
    if distances.shape != (n, n) or not np.isfinite(distances).all() or (distances < 0).any():
        raise ProblemError("distances must be a square matrix of finite numbers, none below 0")
    if not 0 <= start < n or (end is not None and not 0 <= end < n):
        raise ProblemError(f"start {start} and end {end} must be vertices from 0 to {n - 1}")
    if end == start:
        end = None
    open_end = end is None
    if open_end:
        # An open path is a path to a vertex that is 0 away from everything.
        padded = np.zeros((n + 1, n + 1))
        padded[:n, :n] = distances
        distances, end = padded, n
    inner = [v for v in range(n) if v not in (start, end)]
    path = _exact(distances, start, int(end or 0), inner) if len(inner) <= EXACT else None
    if path is None:
        path = improve(_nearest_neighbours(distances, start, int(end or 0), inner), distances)
    order = tuple(int(v) for v in path)
    return order[:-1] if open_end else order


def improve(path: Ints, distances: Floats) -> Ints:
    """The path after 2-opt and or-opt until neither shortens it; its ends stay where they are."""
    path = path.copy()
    for _ in range(_MAX_PASSES):
        changed = False
        for i in _promising_reversals(path, distances):
            changed |= _reverse_from(path, int(i), distances)
        for size in (1, 2, 3):
            for i in _promising_moves(path, size, distances):
                path, moved = _move_segment(path, int(i), size, distances)
                changed |= moved
        if not changed:
            break
    return path


def _exact(d: Floats, start: int, end: int, inner: list[int]) -> Ints:
    k = len(inner)
    if k == 0:
        return np.array([start, end], dtype=np.intp)
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
    return np.array([start, *reversed(backwards), end], dtype=np.intp)


def _nearest_neighbours(d: Floats, start: int, end: int, inner: list[int]) -> Ints:
    path, rest = [start], np.array(inner, dtype=np.intp)
    while len(rest):
        nearest = int(d[path[-1], rest].argmin())
        path.append(int(rest[nearest]))
        rest = np.delete(rest, nearest)
    return np.array([*path, end], dtype=np.intp)


def _promising_reversals(path: Ints, d: Floats) -> Ints:
    """Positions of first edges with which some 2-opt move gains."""
    if len(path) < 4:
        return np.empty(0, dtype=np.intp)
    along = d[np.ix_(path, path)]
    step = along.diagonal(1)
    gain = step[:, None] + step - along[:-1, :-1] - along[1:, 1:]
    np.fill_diagonal(gain, 0.0)
    return np.flatnonzero(np.triu(gain).max(axis=1) > _GAIN)


def _reverse_from(path: Ints, i: int, d: Floats) -> bool:
    """The best 2-opt move that replaces edge (i, i+1), in place."""
    ends, after = path[i + 2 : -1], path[i + 3 :]
    if not len(ends):
        return False
    # Reversing path[i+1 .. j] replaces edges (i, i+1) and (j, j+1).
    gain = d[path[i], path[i + 1]] + d[ends, after] - d[path[i], ends] - d[path[i + 1], after]
    best = int(gain.argmax())
    if gain[best] <= _GAIN:
        return False
    path[i + 1 : i + 3 + best] = path[i + 1 : i + 3 + best][::-1].copy()
    return True


def _promising_moves(path: Ints, size: int, d: Floats) -> Ints:
    """Positions of segments of ``size`` vertices that some other place suits better."""
    count = len(path) - 1 - size
    if count < 1:
        return np.empty(0, dtype=np.intp)
    along = d[np.ix_(path, path)]
    step = along.diagonal(1)
    first = np.arange(1, 1 + count)
    last = first + size - 1
    saved = step[first - 1] + step[last] - along[first - 1, last + 1]
    forth = along[first, :-1] + along[last, 1:]
    back = along[last, :-1] + along[first, 1:]
    added = np.minimum(forth, back) - step
    edges = np.arange(len(step))
    own = (edges >= first[:, None] - 1) & (edges <= last[:, None])
    added[own] = np.inf
    return np.asarray(first[saved - added.min(axis=1) > _GAIN], dtype=np.intp)


def _move_segment(path: Ints, i: int, size: int, d: Floats) -> tuple[Ints, bool]:
    """The segment path[i .. i+size-1] at its best place, either way round."""
    segment = path[i : i + size]
    rest = np.concatenate([path[:i], path[i + size :]])
    first, last = segment[0], segment[-1]
    saved = d[path[i - 1], first] + d[last, path[i + size]] - d[path[i - 1], path[i + size]]
    left, right = rest[:-1], rest[1:]
    forth = d[left, first] + d[last, right]
    back = d[left, last] + d[first, right]
    added = np.minimum(forth, back) - d[left, right]
    best = int(added.argmin())
    if saved - added[best] <= _GAIN:
        return path, False
    turned = segment if forth[best] <= back[best] else segment[::-1]
    return np.concatenate([rest[: best + 1], turned, rest[best + 1 :]]), True
