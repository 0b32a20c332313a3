"""A binary heap of (key, item) pairs in two arrays, least key first: what Dijkstra's algorithm takes nodes from."""

from __future__ import annotations

from fieldhand.orienteering.kernels.compiled import inner
from fieldhand.orienteering.kernels.legs import Floats, Ints


@inner
def push(keys: Floats, items: Ints, count: int, key: float, item: int) -> None:
    """Add a pair to a heap of ``count``."""
    at = count
    while at > 0:
        above = (at - 1) >> 1
        if keys[above] <= key:
            break
        keys[at] = keys[above]
        items[at] = items[above]
        at = above
    keys[at] = key
    items[at] = item


@inner
def drop(keys: Floats, items: Ints, count: int) -> None:
    """Take the least pair, which stands first, out of a heap of ``count``."""
    last = count - 1
    key, item = keys[last], items[last]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= last:
            break
        if below + 1 < last and keys[below + 1] < keys[below]:
            below += 1
        if keys[below] >= key:
            break
        keys[at] = keys[below]
        items[at] = items[below]
        at = below
    keys[at] = key
    items[at] = item
