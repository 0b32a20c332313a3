"""Which nodes of a network lie on most shortest paths: these make the best hubs.

Shortest path trees from random nodes are sampled. The node with most descendants in them comes first; what lies behind
it is cut off the trees, for its paths are covered, and the next is chosen by what is left. When little is left, new
trees are sampled, of paths not covered yet. Source: Delling, Goldberg, Pajor, Werneck, Robust distance queries on
massive networks, 2014.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fieldhand.orienteering.kernels.compiled import compiled, inner
from fieldhand.orienteering.kernels.heap import drop, push
from fieldhand.orienteering.kernels.legs import Floats, Ints, Numbers, Seeds, sort_by, uniform

#: Entries that sampled trees may have together, by node; what part of them is to be left before new ones are sampled;
#: and how many nodes a tree must have on average to tell more than the number of a node's ways does.
_TREES = 32
_LEFT = 0.25
_TELLING = 8.0
#: Paths whose lengths differ by less than this part are equally short: sums are rounded.
EQUAL = 1.0 + 1e-12


@inner
def _grow(
    root: int, starts: Ints, heads: Numbers, lengths: Floats, ranked: NDArray[np.bool_], away: Floats, came: Numbers,
    state: NDArray[np.int8], keys: Floats, items: Ints, seen: Numbers, settled: Numbers,
) -> tuple[int, int]:  # fmt: skip
    """The tree of shortest paths from ``root`` on which no node is ranked.

    ``state`` of a node: 0 not seen, 1 waiting, 2 waiting with a ranked node on the way, 3 done.

    Returns:
        How many nodes ``settled`` tells, in the order of their distance; how many ``seen`` tells.
    """
    count, heap, touched, open_ = 0, 1, 1, 1
    away[root] = 0.0
    came[root] = -1
    state[root] = 1
    seen[0] = root
    push(keys, items, 0, 0.0, root)
    while heap > 0 and open_ > 0:
        key, u = keys[0], items[0]
        drop(keys, items, heap)
        heap -= 1
        if state[u] == 3 or key > away[u]:
            continue
        behind = state[u] == 2
        state[u] = 3
        if not behind:
            open_ -= 1
            settled[count] = u
            count += 1
        for i in range(starts[u], starts[u + 1]):
            v = heads[i]
            if state[v] == 3:
                continue
            there = key + lengths[i]
            now = 2 if behind or ranked[v] else 1
            if state[v] == 0:
                seen[touched] = v
                touched += 1
            elif there >= away[v]:
                if now == 2 and state[v] == 1 and there <= away[v] * EQUAL:
                    state[v] = 2
                    open_ -= 1
                continue
            open_ += (1 if now == 1 else 0) - (1 if state[v] == 1 else 0)
            state[v] = now
            away[v] = there
            came[v] = u
            push(keys, items, heap, there, v)
            heap += 1
    return count, touched


@compiled
def rank(starts: Ints, heads: Numbers, lengths: Floats, seeds: Seeds) -> Numbers:
    """The nodes in their order as hubs.

    Args:
        starts, heads, lengths: The ways of node u are entries ``starts[u]`` to ``starts[u + 1]``.
        seeds: Of the random numbers.
    """
    n = len(starts) - 1
    ranked, count = np.zeros(n, np.bool_), np.zeros(n, np.int64)
    away, came, state = np.empty(n), np.empty(n, np.int32), np.zeros(n, np.int8)
    keys, items = np.empty(len(heads) + n + 1), np.empty(len(heads) + n + 1, np.int64)
    seen, settled, at = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int32)
    free = np.empty(n, np.int32)
    # Entries of the trees, each tree in preorder: what hangs below entry e is e to e + span[e].
    room = (_TREES + 1) * n
    node, parent, span = np.empty(room, np.int32), np.empty(room, np.int32), np.empty(room, np.int32)
    size, following, first = np.empty(room, np.int32), np.empty(room, np.int32), np.empty(n, np.int32)
    order, done = np.empty(n, np.int32), 0
    while done < n:
        entries, trees = 0, 0
        for u in range(n):
            count[u] = 0
            first[u] = -1
        while entries < _TREES * n and trees < _TREES * n:
            root = int(uniform(seeds) * n)
            trees += 1
            if ranked[root]:
                continue
            found, touched = _grow(root, starts, heads, lengths, ranked, away, came, state, keys, items, seen, settled)
            for i in range(touched):
                state[seen[i]] = 0
            for i in range(found):
                at[settled[i]] = 1
            for i in range(found - 1, 0, -1):
                at[came[settled[i]]] += at[settled[i]]
            for i in range(found):
                u = settled[i]
                total = at[u]
                if i == 0:
                    e = entries
                    parent[e] = -1
                else:
                    p = came[u]
                    e = free[p]
                    free[p] += total
                    parent[e] = at[p]
                at[u] = e
                free[u] = e + 1
                node[e] = u
                span[e] = total
                size[e] = total
                following[e] = first[u]
                first[u] = e
                count[u] += total
            entries += found
        if entries < _TELLING * trees:
            break
        heap = 0
        for u in range(n):
            if count[u] > 0:
                push(keys, items, heap, -float(count[u]), u)
                heap += 1
        alive = entries
        while heap > 0 and alive > _LEFT * entries:
            key, u = keys[0], items[0]
            drop(keys, items, heap)
            heap -= 1
            if count[u] == 0:
                continue
            if -key > count[u]:
                push(keys, items, heap, -float(count[u]), u)
                heap += 1
                continue
            ranked[u] = True
            order[done] = u
            done += 1
            e = first[u]
            while e >= 0:
                if size[e] > 0:
                    alive -= size[e]
                    above = parent[e]
                    while above >= 0:
                        size[above] -= size[e]
                        count[node[above]] -= size[e]
                        above = parent[above]
                    e_end = e + span[e]
                    f = e
                    while f < e_end:
                        if size[f] > 0:
                            count[node[f]] -= size[f]
                            size[f] = 0
                            f += 1
                        else:
                            f += span[f]
                e = following[e]
    rest, key_of = np.empty(n, np.int64), np.empty(n)
    left = 0
    for u in range(n):
        if not ranked[u]:
            rest[left] = u
            key_of[left] = -float(count[u]) * 64.0 - (starts[u + 1] - starts[u])
            left += 1
    sort_by(key_of, rest, left)
    for i in range(left):
        order[done + i] = rest[i]
    return order
