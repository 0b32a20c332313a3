"""Labels of things that belong together: made from pairs of them, and taken apart again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]


def linked(count: int, one: Indices, two: Indices) -> Indices:
    """Return a label from 0 for each of so many things: the same for those that a chain of these pairs joins."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(one), dtype=np.int8), (one, two)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.intp)


def groups(labels: Indices, count: int) -> list[Indices]:
    """Return for each label from 0 the positions that carry it, rising; negative labels are left out."""
    order = np.argsort(labels, kind="stable")
    ends = np.searchsorted(labels[order], np.arange(count + 1))
    return [order[ends[k] : ends[k + 1]] for k in range(count)]
