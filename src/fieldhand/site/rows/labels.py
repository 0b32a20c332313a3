"""Labels of connected things: computed from pairs, and converted to groups."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]


def linked(count: int, one: Indices, two: Indices) -> Indices:
    """Return the label, from 0, of the connected component of each of ``count`` things, given connected pairs.

    Components are numbered in the order of their first things.
    """
    first = np.arange(count, dtype=np.intp)
    while True:
        # Of two connected groups, the first thing of the one becomes the first of the other.
        lower = np.minimum(first[one], first[two])
        spread = first.copy()
        np.minimum.at(spread, first[one], lower)
        np.minimum.at(spread, first[two], lower)
        spread = spread[spread]
        if (spread == first).all():
            return np.asarray(np.unique(first, return_inverse=True)[1], dtype=np.intp)
        first = spread


def groups(labels: Indices, count: int) -> list[Indices]:
    """Return the indices of each label from 0 in ascending order; negative labels are left out."""
    order = np.argsort(labels, kind="stable")
    ends = np.searchsorted(labels[order], np.arange(count + 1))
    return [order[ends[k] : ends[k + 1]] for k in range(count)]
