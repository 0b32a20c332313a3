"""Labels of connected things: computed from pairs, and converted to groups."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.intp]


def linked(count: int, one: Indices, two: Indices) -> Indices:
    """Return the label, from 0, of the connected component of each of ``count`` things, given connected pairs."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(one), dtype=np.int8), (one, two)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.intp)


def groups(labels: Indices, count: int) -> list[Indices]:
    """Return the indices of each label from 0 in ascending order; negative labels are left out."""
    order = np.argsort(labels, kind="stable")
    ends = np.searchsorted(labels[order], np.arange(count + 1))
    return [order[ends[k] : ends[k + 1]] for k in range(count)]
