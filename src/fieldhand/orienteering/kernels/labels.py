"""Exact distances on a network without a table: hub labels, by pruned Dijkstra searches from the most central nodes.

Every node keeps the distances to some hubs, so chosen that any two nodes have one in common on a shortest path between
them. Source: Akiba, Iwata, Yoshida, Fast exact shortest-path distance queries on large networks by pruned landmark
labeling, 2013, here with lengths.
"""

from __future__ import annotations

import numpy as np

from fieldhand.orienteering.kernels.compiled import compiled
from fieldhand.orienteering.kernels.heap import drop, push
from fieldhand.orienteering.kernels.legs import Floats, Ints, Numbers, over_hubs, sort_by
from fieldhand.orienteering.kernels.rank import EQUAL

#: Entries of a label that stand together while labels grow.
_BLOCK = 16


@compiled
def label(order: Numbers, starts: Ints, heads: Numbers, lengths: Floats, wanted: Ints) -> tuple[Ints, Numbers, Floats]:
    """Labels of some nodes.

    Args:
        order: The nodes, best hub first.
        starts, heads, lengths: The ways of node u are entries ``starts[u]`` to ``starts[u + 1]``.
        wanted: The nodes whose labels are asked for.

    Returns:
        Entries of the label of ``wanted[i]`` begin at ``starts[i]`` and end before ``starts[i + 1]``; each has a hub,
        ascending, and the distance to it.
    """
    n = len(order)
    place, to_hub = np.empty(n, np.int32), np.full(n, np.inf)
    for r in range(n):
        place[order[r]] = r
    count, first, last = np.zeros(n, np.int64), np.empty(n, np.int64), np.empty(n, np.int64)
    hubs, gaps = np.empty(8 * n * _BLOCK, np.int32), np.empty(8 * n * _BLOCK)
    then, blocks = np.empty(8 * n, np.int64), 0
    away, done = np.full(n, np.inf), np.zeros(n, np.bool_)
    keys, items = np.empty(len(heads) + n + 1), np.empty(len(heads) + n + 1, np.int64)
    seen = np.empty(n, np.int32)
    for r in range(n):
        root = order[r]
        block = first[root]
        for i in range(count[root]):
            if i > 0 and i % _BLOCK == 0:
                block = then[block]
            at = block * _BLOCK + i % _BLOCK
            to_hub[hubs[at]] = gaps[at]
        away[root] = 0.0
        seen[0] = root
        heap, touched = 1, 1
        push(keys, items, 0, 0.0, root)
        while heap > 0:
            key, u = keys[0], items[0]
            drop(keys, items, heap)
            heap -= 1
            if done[u]:
                continue
            done[u] = True
            bound, block, covered = key * EQUAL, first[u], False
            for i in range(count[u]):
                if i > 0 and i % _BLOCK == 0:
                    block = then[block]
                at = block * _BLOCK + i % _BLOCK
                if to_hub[hubs[at]] + gaps[at] <= bound:
                    covered = True
                    break
            if covered:
                continue
            if count[u] % _BLOCK == 0:
                if blocks == len(then):
                    hubs = np.append(hubs, np.empty(len(hubs), np.int32))
                    gaps = np.append(gaps, np.empty(len(gaps)))
                    then = np.append(then, np.empty(len(then), np.int64))
                if count[u] == 0:
                    first[u] = blocks
                else:
                    then[last[u]] = blocks
                last[u] = blocks
                blocks += 1
            at = last[u] * _BLOCK + count[u] % _BLOCK
            hubs[at], gaps[at] = r, key
            count[u] += 1
            for i in range(starts[u], starts[u + 1]):
                v = heads[i]
                there = key + lengths[i]
                if place[v] > r and there < away[v]:
                    if away[v] == np.inf:
                        seen[touched] = v
                        touched += 1
                    away[v] = there
                    push(keys, items, heap, there, v)
                    heap += 1
        for i in range(touched):
            away[seen[i]] = np.inf
            done[seen[i]] = False
        block = first[root]
        for i in range(count[root]):
            if i > 0 and i % _BLOCK == 0:
                block = then[block]
            to_hub[hubs[block * _BLOCK + i % _BLOCK]] = np.inf
    ends = np.zeros(len(wanted) + 1, np.int64)
    for k in range(len(wanted)):
        ends[k + 1] = ends[k] + count[wanted[k]]
    kept_hubs, kept_gaps = np.empty(ends[-1], np.int32), np.empty(ends[-1])
    for k in range(len(wanted)):
        block = first[wanted[k]]
        for i in range(count[wanted[k]]):
            if i > 0 and i % _BLOCK == 0:
                block = then[block]
            at = block * _BLOCK + i % _BLOCK
            kept_hubs[ends[k] + i], kept_gaps[ends[k] + i] = hubs[at], gaps[at]
    return ends, kept_hubs, kept_gaps


@compiled
def distances_from(u: int, spans: Ints, hubs: Numbers, gaps: Floats, out: Floats) -> None:
    """From node u to the first ``len(out)`` nodes, in one pass over their labels; ``inf`` where there is no way."""
    to_hub = np.full(hubs[spans[u, 1] - 1] + 1, np.inf)
    for i in range(spans[u, 0], spans[u, 1]):
        to_hub[hubs[i]] = gaps[i]
    for v in range(len(out)):
        best = np.inf
        for i in range(spans[v, 0], spans[v, 1]):
            if hubs[i] >= len(to_hub):
                break
            best = min(best, to_hub[hubs[i]] + gaps[i])
        out[v] = best


@compiled
def nearest(starts: Ints, heads: Numbers, lengths: Floats, wanted: Ints, near: Ints) -> None:
    """For each wanted node the nearest others of them, by their number in ``wanted``; itself where there are no more.

    Args:
        starts, heads, lengths: The ways of node u are entries ``starts[u]`` to ``starts[u + 1]``.
        wanted: Nodes.
        near: Overwritten, shape (wanted, k): nearest first.
    """
    n, count = len(starts) - 1, near.shape[1]
    number = np.full(n, -1, np.int64)
    for i in range(len(wanted)):
        number[wanted[i]] = i
    away, done = np.full(n, np.inf), np.zeros(n, np.bool_)
    keys, items = np.empty(len(heads) + n + 1), np.empty(len(heads) + n + 1, np.int64)
    seen = np.empty(n, np.int32)
    for i in range(len(wanted)):
        root = wanted[i]
        found, heap, touched = 0, 1, 1
        away[root] = 0.0
        seen[0] = root
        push(keys, items, 0, 0.0, root)
        while heap > 0 and found < count:
            key, u = keys[0], items[0]
            drop(keys, items, heap)
            heap -= 1
            if done[u]:
                continue
            done[u] = True
            if u != root and number[u] >= 0:
                near[i, found] = number[u]
                found += 1
            for k in range(starts[u], starts[u + 1]):
                v = heads[k]
                there = key + lengths[k]
                if there < away[v]:
                    if away[v] == np.inf:
                        seen[touched] = v
                        touched += 1
                    away[v] = there
                    push(keys, items, heap, there, v)
                    heap += 1
        for k in range(found, count):
            near[i, k] = i
        for k in range(touched):
            away[seen[k]] = np.inf
            done[seen[k]] = False


@compiled
def measured(near: Ints, spans: Ints, hubs: Numbers, gaps: Floats, close: Numbers, close_gaps: Floats) -> None:
    """Put the nodes near each one in ascending order, with the distances to them."""
    key, row = np.empty(near.shape[1]), np.empty(near.shape[1], np.int64)
    for u in range(len(near)):
        for i in range(len(row)):
            row[i] = near[u, i]
            key[i] = float(near[u, i])
        sort_by(key, row, len(row))
        for i in range(len(row)):
            close[u, i] = row[i]
            close_gaps[u, i] = over_hubs(spans, hubs, gaps, u, row[i])
